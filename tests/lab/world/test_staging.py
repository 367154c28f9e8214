"""Rigs that several processes show in step."""

import os
import threading
import time
from dataclasses import replace
from itertools import islice

import numpy as np
import pytest
from inhand_lab.world.rigs import RigSimulation, RigView, simulate_rig
from inhand_lab.world.simulator import SimulatorSource
from inhand_lab.world.staging import Staging, staged_frames
from inhand_runtime.source import Captured, SourceError

FRAMES = 360
LENGTH_NS = 12_000_000_000


def some_of(options: dict[str, object], count: int) -> list[Captured]:
    source = SimulatorSource({"cameras": 3, "frames": FRAMES, **options})
    moments = (one for one in source.captures(lambda: False) if one is not None)
    return list(islice(moments, count))


@pytest.fixture(scope="module")
def first_performance() -> RigSimulation:
    return simulate_rig("drinkFromMug", 0, 0, FRAMES, 3)


@pytest.mark.parametrize("view", [0, 2])
def test_who_joins_late_shows_the_performance_that_is_on_where_it_is(
    view: int, first_performance: RigSimulation
) -> None:
    start = time.time() - 3.0
    moments = some_of({"view": view, "start": start}, 5)
    begin_ns = round(1e9 * start)
    performance = (moments[0].time_ns - begin_ns) // LENGTH_NS
    rig = first_performance
    if performance:  # of a machine that took nine seconds to begin
        rig = simulate_rig("drinkFromMug", 0, 0, FRAMES, 3, performance=performance)
    times = begin_ns + performance * LENGTH_NS + np.rint(1e9 * rig.times_s(view))
    for moment in moments:
        frame = int(np.argmin(np.abs(times - moment.time_ns)))
        assert abs(times[frame] - moment.time_ns) < 1000
        assert frame > 80
        assert not rig.dropped[view][frame]
        pose = moment.labels[0].camera_from_object
        assert pose is not None
        assert pose.translation == pytest.approx(rig.cameras[view].translations[frame])


@pytest.mark.parametrize("own_clock", [False, True])
def test_a_single_performance_is_shown_from_its_begin_or_from_now_to_its_end(
    own_clock: bool, first_performance: RigSimulation
) -> None:
    view, now_ns = first_performance.views[1], time.time_ns()
    for begin_ns in (now_ns + LENGTH_NS, now_ns - LENGTH_NS // 2):
        staging = Staging(begin_ns, LENGTH_NS, 0, loop=False, own_clock=own_clock)
        staged = list(staged_frames(staging, lambda _: pytest.fail("a second one"), (0, view)))
        due = begin_ns + np.rint(1e9 * view.times_s()[~view.dropped]).astype(np.int64)
        stamps = begin_ns + view.stamps_ns()[~view.dropped] if own_clock else due
        assert 0 < len(staged) <= len(due)
        assert [one.due_ns for one in staged] == due[-len(staged) :].tolist()
        assert [one.stamp_ns for one in staged] == stamps[-len(staged) :].tolist()
        assert (len(staged) == len(due)) == (begin_ns > now_ns)


def test_lost_frames_are_not_shown_and_one_performance_follows_another(
    first_performance: RigSimulation,
) -> None:
    view = replace(first_performance.views[0], dropped=np.arange(FRAMES) % 2 == 0)
    staging = Staging(time.time_ns() - LENGTH_NS + 300_000_000, LENGTH_NS, LENGTH_NS)
    shown = staged_frames(staging, lambda _: view, (0, view))
    while (one := next(shown)).due_ns < staging.begin_ns(1):
        assert one.frame % 2 == 1
    assert one.frame == 1


def test_what_prepares_the_next_performance_gives_way_to_who_watches(
    first_performance: RigSimulation,
) -> None:
    view, priorities = first_performance.views[0], []

    def perform(_number: int) -> RigView:
        priorities.append(os.getpriority(os.PRIO_PROCESS, threading.get_native_id()))
        return view

    staging = Staging(time.time_ns() - LENGTH_NS + 300_000_000, LENGTH_NS, LENGTH_NS)
    shown = staged_frames(staging, perform, (0, view))
    while next(shown).due_ns < staging.begin_ns(1):
        pass
    assert priorities == [min(os.getpriority(os.PRIO_PROCESS, 0) + 10, 19)]


def test_info_says_where_the_camera_stands() -> None:
    source = SimulatorSource({"cameras": 2, "view": 1, "start": time.time()})
    rig = simulate_rig("drinkFromMug", 0, 0, 2, 2)
    assert source.info.rig_from_camera.translation == pytest.approx(
        rig.rig_from_camera[1].translation
    )


def test_the_clock_says_which_performance_is_on() -> None:
    staging = Staging(start_ns=1_000, length_ns=100, ahead_ns=10)
    assert [staging.performance_at(time_ns) for time_ns in (0, 1_000, 1_099, 1_100, 1_950)] == [
        *(0, 0, 0),
        *(1, 9),
    ]
    assert staging.begin_ns(9) == 1_900


def test_cameras_of_a_rig_prepare_the_next_performance_one_after_another() -> None:
    apart = [Staging(1_000, 100, ahead_ns=40, apart_ns=view * 10) for view in range(3)]
    assert [one.prepared_ns(2, shown_ns=1_200) for one in apart] == [1_260, 1_270, 1_280]
    assert [one.prepared_ns(2, shown_ns=1_290) for one in apart] == [1_290, 1_295, 1_295]


@pytest.mark.parametrize(
    ("options", "line"),
    [
        ({"view": 3}, "view is 0 to 2 of 3 cameras"),
        ({"cameras": 5}, "less than or equal to 4"),
        ({"frames": 1}, "2 frames or more"),
        ({"loop": False}, "need start"),
        ({"roaming": True, "interaction": "pourCream"}, "nobody walks about in 'pourCream'"),
    ],
)
def test_options_that_cannot_be_are_refused(options: dict[str, object], line: str) -> None:
    with pytest.raises(SourceError, match=line):
        SimulatorSource({"cameras": 3, **options})
