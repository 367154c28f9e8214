"""A tracker that is slower than its camera is on time, loses no account, and does less in a frame.

Steps are as slow as they are said to be: what moves the clock is the tracker itself.
"""

import re
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from inhand_runtime.pixels import encode_colour
from inhand_schemas.messages import CameraInfo, Person, RgbdFrame, Skeletons
from inhand_schemas.topics import INFO, RGBD, SKELETONS
from inhand_tracker.geometry.estimate import LOST, Estimate
from inhand_tracker.geometry.image import Image
from inhand_tracker.live.parameters import DEFAULT_EFFORT, DEFAULT_MOMENTS
from inhand_tracker.people.watching import GivenObjects
from inhand_tracker.service import TrackerService, TrackerSettings
from people import STANDING
from simulated_daemon import Due, SimulatedDaemon

HERE = Estimate("tracked", 1.0, np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]), np.eye(6))
PERIOD_S = 1.0 / 30.0
FIRST_S = 10.0
KNOWN = DEFAULT_MOMENTS.fewest_intervals + 1
"""Number of skeletons after which the camera's period is known."""
SOMEBODY = Person(
    id=4,
    joints=tuple(map(tuple, STANDING.tolist())),
    states=("tracked",) * 20,
    confidences=(1.0,) * 20,
)
INFO_MESSAGE = CameraInfo(
    sequence=0, time_ns=0, width=64, height=48, fx=52.0, fy=52.0, cx=31.5, cy=23.5
)
PICTURE = encode_colour(np.full((48, 64, 3), 90, np.uint8))


class Slow:
    """A tracker whose steps take a fixed time, and more with its effort."""

    effort = 1.0
    trouble = None

    def __init__(self, fixed_s: float, by_effort_s: float) -> None:
        self.costs = fixed_s, by_effort_s
        self.now_s = 0.0
        self.steps: list[tuple[int, bool, float]] = []
        """When, whether with a picture, and with which effort."""
        self.remembered: list[int] = []

    def spend(self, daemon: SimulatedDaemon) -> "Slow":
        self._daemon = daemon
        return self

    @property
    def step_s(self) -> float:
        fixed_s, by_effort_s = self.costs
        return fixed_s + by_effort_s * self.effort

    def restart(self) -> None: ...

    def step(self, joints: object, time_ns: int, image: Image | None) -> Estimate:
        self._daemon.now += self.step_s
        self.steps.append((time_ns, image is not None, self.effort))
        return LOST if joints is None else HERE

    def remember_joints(self, joints: object, time_ns: int) -> None:
        self.remembered.append(time_ns)

    def outline(self, *_: object) -> None:
        return None


@dataclass(frozen=True)
class Camera:
    """Frames at a period; skeletons come some seconds after capture, frames some after those."""

    frames: int = 300
    period_s: float = PERIOD_S
    skeleton_after_s: float = 0.002
    frame_after_s: float = 0.008
    lost: frozenset[int] = frozenset()

    def captured(self, number: int) -> float:
        return FIRST_S + number * self.period_s

    def messages(self) -> list[Due]:
        sent: list[Due] = [(FIRST_S, INFO, INFO_MESSAGE)]
        for number in range(self.frames):
            stamp = {"sequence": number, "time_ns": round(self.captured(number) * 1e9)}
            arrived = self.captured(number) + self.skeleton_after_s
            sent.append((arrived, SKELETONS, Skeletons(**stamp, people=(SOMEBODY,))))
            if number not in self.lost:
                frame = RgbdFrame(**stamp, colour=PICTURE)
                sent.append((arrived + self.frame_after_s, RGBD, frame))
        return sent


def track(camera: Camera, tracker: Slow, **settings: object) -> SimulatedDaemon:
    daemon = SimulatedDaemon(*camera.messages())
    watcher = GivenObjects({"mug": tracker.spend(daemon)})
    chosen = TrackerSettings(method="gd-fallback", **settings)
    TrackerService(daemon, chosen, lambda: watcher, daemon.clock).run()
    return daemon


def ages_s(daemon: SimulatedDaemon) -> np.ndarray:
    captured = np.array([pose.time_ns / 1e9 for pose in daemon.poses["mug"]])
    return np.array(daemon.published) - captured


def skipped_after(camera: Camera, tracker: Slow, number: int) -> int:
    return sum(time_ns > camera.captured(number) * 1e9 for time_ns in tracker.remembered)


@given(
    st.sampled_from([1.0 / 90.0, 1.0 / 30.0, 1.0 / 15.0]),
    st.floats(0.0, 12.0),
    st.floats(0.0, 12.0),
    st.floats(0.0, 0.1),
    st.floats(0.0, 0.8),
    st.frozensets(st.integers(0, 59)),
)
def test_no_pose_is_older_than_two_periods_and_a_step_whatever_a_step_costs(
    period_s: float,
    fixed: float,
    by_effort: float,
    skeleton_after: float,
    frame_after: float,
    lost: frozenset[int],
) -> None:
    camera = Camera(60, period_s, skeleton_after * period_s, frame_after * period_s, lost)
    tracker = Slow(fixed * period_s, by_effort * period_s)
    daemon = track(camera, tracker)
    longest_s = [tracker.costs[0] + tracker.costs[1] * effort for _, _, effort in tracker.steps]
    late = [
        (age, step_s)
        for pose, age, step_s in zip(daemon.poses["mug"], ages_s(daemon), longest_s, strict=True)
        if KNOWN < pose.sequence < 59 and age > 2 * period_s + step_s + 1e-6
    ]
    assert late == []
    times = [time_ns for time_ns, _, _ in tracker.steps]
    assert sorted(times + tracker.remembered) == [
        round(camera.captured(number) * 1e9) for number in range(60)
    ]
    assert daemon.dropped(SKELETONS) == len(tracker.remembered)
    pictures = sum(seen for _, seen, _ in tracker.steps)
    assert pictures + daemon.dropped(RGBD) == 60 - len(lost)


def test_bodies_of_skipped_frames_are_remembered_in_their_order_before_the_next_step() -> None:
    camera, tracker = Camera(), Slow(0.1, 0.0)
    happened: list[int] = []
    step, remember = tracker.step, tracker.remember_joints
    tracker.step = lambda joints, time_ns, image: (
        happened.append(time_ns) or step(joints, time_ns, image)
    )
    tracker.remember_joints = lambda joints, time_ns: (
        happened.append(time_ns) or remember(joints, time_ns)
    )
    track(camera, tracker)
    assert len(tracker.remembered) > 150
    assert happened == [round(camera.captured(number) * 1e9) for number in range(300)]


def test_a_tracker_that_skips_much_is_degraded_and_says_how_much() -> None:
    daemon = track(Camera(), Slow(0.2, 0.0))
    report = daemon.health.report()
    assert report.state == "degraded"
    (trouble,) = report.troubles
    assert re.match(r"7\d of 90 skeletons were skipped: this machine is too slow", trouble)


def test_a_tracker_that_is_behind_has_the_picture_of_every_frame_that_it_tracks() -> None:
    tracker = Slow(0.1, 0.0)
    track(Camera(), tracker)
    assert all(seen for _, seen, _ in tracker.steps)


@pytest.mark.parametrize("pixels", [True, False])
def test_a_tracker_does_less_in_a_frame_before_it_skips_any(pixels: bool) -> None:
    lost = frozenset() if pixels else frozenset(range(600))
    camera, tracker = Camera(600, lost=lost), Slow(0.2 * PERIOD_S, 1.5 * PERIOD_S)
    daemon = track(camera, tracker)
    assert 0 < len(tracker.remembered) < 30
    assert skipped_after(camera, tracker, 60) == 0
    efforts = {effort for time_ns, _, effort in tracker.steps if time_ns / 1e9 > FIRST_S + 4.0}
    assert len(efforts) == 1
    assert DEFAULT_EFFORT.least < max(efforts) < 1.0
    assert daemon.health.report().effort == max(efforts)


def test_a_tracker_that_has_time_skips_nothing_and_does_all() -> None:
    lost = frozenset(range(0, 300, 7))
    tracker = Slow(0.1 * PERIOD_S, 0.6 * PERIOD_S)
    daemon = track(Camera(lost=lost), tracker)
    assert tracker.remembered == []
    assert {effort for _, _, effort in tracker.steps} == {1.0}
    assert [seen for _, seen, _ in tracker.steps] == [number not in lost for number in range(300)]
    assert daemon.dropped(RGBD) == 0


def test_the_whole_effort_comes_back_when_the_load_has_gone() -> None:
    camera, tracker = Camera(900), Slow(0.2 * PERIOD_S, 3.0 * PERIOD_S)
    step = tracker.step

    def lighter(joints: object, time_ns: int, image: Image | None) -> Estimate:
        if time_ns > camera.captured(300) * 1e9:
            tracker.costs = 0.05 * PERIOD_S, 0.3 * PERIOD_S
        return step(joints, time_ns, image)

    tracker.step = lighter
    track(camera, tracker)
    efforts = {time_ns: effort for time_ns, _, effort in tracker.steps}
    assert efforts[round(camera.captured(299) * 1e9)] < 0.5
    assert efforts[round(camera.captured(899) * 1e9)] == 1.0


def test_where_every_frame_matters_each_is_tracked_with_its_picture_and_the_whole_effort() -> None:
    camera, tracker = Camera(), Slow(0.1, 0.1)
    daemon = track(camera, tracker, every_frame=True)
    assert tracker.steps == [
        (round(camera.captured(number) * 1e9), True, 1.0) for number in range(300)
    ]
    assert tracker.remembered == []
    assert daemon.health.drops() == {}


def test_where_every_frame_matters_a_burst_with_losses_costs_only_the_pictures_that_were_lost() -> (
    None
):
    lost = frozenset({3, 4, 5, 9, 40, 80, 81})
    tracker = Slow(0.1, 0.0)
    track(Camera(100, 1e-4, lost=lost), tracker, every_frame=True)
    assert [seen for _, seen, _ in tracker.steps] == [number not in lost for number in range(100)]


@pytest.mark.parametrize("every", [False, True])
def test_what_waits_when_the_daemon_stops_is_counted(every: bool) -> None:
    tracker = Slow(1.0, 0.0)
    step = tracker.step

    def last(joints: object, time_ns: int, image: Image | None) -> Estimate:
        estimate = step(joints, time_ns, image)
        tracker._daemon.stop.set()
        return estimate

    tracker.step = last
    daemon = track(Camera(20), tracker, every_frame=every)
    assert len(tracker.steps) == 1
    assert daemon.dropped(SKELETONS) == daemon.dropped(RGBD) == 19


def test_frames_that_come_late_from_a_slow_network_keep_their_true_time_of_capture() -> None:
    camera, tracker = Camera(skeleton_after_s=0.4), Slow(0.01, 0.0)
    daemon = track(camera, tracker)
    assert [pose.time_ns for pose in daemon.poses["mug"]] == [
        round(camera.captured(number) * 1e9) for number in range(300)
    ]
    assert ages_s(daemon).min() > 0.4
    assert all(seen for _, seen, _ in tracker.steps)
