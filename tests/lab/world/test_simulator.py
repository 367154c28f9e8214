"""The simulator as a camera source."""

import threading
import time
from itertools import islice

import numpy as np
import pytest
from inhand_lab.world.simulation import simulate
from inhand_lab.world.simulator import SimulatorSource
from inhand_runtime.source import SourceError

PERIOD_NS = 1e9 / 30.0


def test_frames_come_at_their_rate_or_slower_where_the_machine_is() -> None:
    source = SimulatorSource({"frames": 400})
    begin = time.monotonic()
    captured = list(islice(source.captures(lambda: True), 16))
    assert time.monotonic() - begin > 0.45
    spacing = np.diff([moment.time_ns for moment in captured])
    assert spacing.min() > PERIOD_NS - 2
    assert abs(captured[-1].time_ns - time.time_ns()) < 1e9


def test_who_is_held_up_goes_on_from_now_and_hurries_after_nothing() -> None:
    moments = SimulatorSource({"frames": 400}).captures(lambda: False)
    next(moments)
    time.sleep(0.2)
    resumed_ns = time.time_ns()
    first, second = islice(moments, 2)
    assert first.time_ns > resumed_ns - PERIOD_NS
    assert second.time_ns - first.time_ns > PERIOD_NS - 2


def test_a_moment_holds_the_skeleton_the_truth_and_the_pixels_of_one_frame() -> None:
    source = SimulatorSource({"interaction": "sweepFloor", "participant": 2, "seed": 4})
    simulation = simulate("sweepFloor", 2, 4)
    *_, moment = islice(source.captures(lambda: False), 5)
    assert moment.people is not None
    assert moment.people[0].joints[3] == tuple(simulation.joints_in_camera[4, 3])
    assert moment.labels[0].object == "broom"
    pose = moment.labels[0].camera_from_object
    assert pose is not None
    assert pose.translation == pytest.approx(simulation.translations[4])
    assert moment.pixels is not None
    depth = moment.pixels().depth
    assert isinstance(depth, np.ndarray)
    assert np.array_equal(depth, simulation.render(4).depth)


def test_nothing_is_rendered_for_nobody(monkeypatch: pytest.MonkeyPatch) -> None:
    source = SimulatorSource({"loop": False})
    monkeypatch.setattr("inhand_lab.world.simulation.sense", pytest.fail)
    assert len(list(islice(source.captures(lambda: False), 3))) == 3


def test_without_loop_it_ends_and_with_it_a_fresh_performance_follows() -> None:
    options = {"frames": 2, "frame_rate": 200.0}
    assert len(list(SimulatorSource(options | {"loop": False}).captures(lambda: False))) == 2
    endless = SimulatorSource(options).captures(lambda: False)
    poses = [moment.labels[0].camera_from_object for moment in islice(endless, 4)]
    assert poses[0] != poses[2]


def test_closing_from_another_thread_ends_the_wait() -> None:
    source = SimulatorSource({"frame_rate": 0.001, "frames": 2})
    moments = source.captures(lambda: False)
    next(moments)
    threading.Timer(0.1, source.close).start()
    assert list(moments) == []


@pytest.mark.parametrize(
    ("options", "word"),
    [
        ({"interaction": "juggle"}, "drinkFromMug"),
        ({"particpant": 1}, "did you mean participant"),
        ({"frames": 0}, "frames"),
    ],
)
def test_wrong_options_are_refused_with_the_mend(options: dict[str, object], word: str) -> None:
    with pytest.raises(SourceError, match=word):
        SimulatorSource(options)
