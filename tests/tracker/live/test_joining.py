"""What several cameras capture is joined in time, and nobody is waited for in vain."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import pairwise

import pytest
from inhand_tracker.live.joining import JoinedMoment, JoinedMoments

PERIOD_S = 1.0 / 30.0
EPOCH_S = 1000.0
"""What the cameras' clocks say where the tracker's says 0."""
NAMES = ("front", "left", "right")
Joined = tuple[float, JoinedMoment[str, str]]


@dataclass(frozen=True)
class Sender:
    """A camera's frames: when it captures the first one, how late skeletons and frames come, by how
    much its clock is wrong, when it dies, and which frames are lost."""

    phase_s: float = 0.0
    period_s: float = PERIOD_S
    late_s: float = 0.005
    frames_late_s: float = 0.003
    clock_s: float = 0.0
    dies_s: float = float("inf")
    lost: Iterable[int] = ()
    frames_lost: Iterable[int] = field(default=())

    def messages(self, name: str, seconds: float) -> list[tuple[float, str, str, int, int]]:
        sent = []
        for number in range(int(seconds / self.period_s)):
            at = self.phase_s + number * self.period_s
            if at >= self.dies_s or number in self.lost:
                continue
            time_ns = round(1e9 * (at + EPOCH_S + self.clock_s))
            arrives = at + self.late_s
            sent.append((arrives, "skeleton", name, number, time_ns))
            if number not in self.frames_lost:
                sent.append((arrives + self.frames_late_s, "frame", name, number, time_ns))
        return sent


def joined(
    *senders: Sender, seconds: float = 2.0, step_s: float = 0.0, every: bool = False
) -> list[Joined]:
    """All moments with when they were given, to somebody who takes a time for each."""
    moments: JoinedMoments[str, str] = JoinedMoments(NAMES[: len(senders)], every=every)
    sent = sorted(
        message
        for name, sender in zip(NAMES, senders, strict=False)
        for message in sender.messages(name, seconds)
    )
    given: list[Joined] = []
    now = 0.0
    while sent or moments.wait_s(now) < 1.0:
        due = now + moments.wait_s(now)
        if sent and sent[0][0] <= max(now, due):
            arrives, kind, name, number, time_ns = sent.pop(0)
            now = max(now, arrives)
            if kind == "skeleton":
                moments.add_skeleton(name, number, time_ns, f"{name} {number}", arrives)
            else:
                moments.add_frame(name, number, f"{name} {number}", arrives)
        else:
            now = due
        if not (sent and sent[0][0] <= now) and (moment := moments.next(now)) is not None:
            given.append((now, moment))
            now += step_s
    return given


def sources(given: list[Joined]) -> list[str]:
    return [moment.captured[0].camera for _, moment in given]


def ages_s(given: list[Joined]) -> list[float]:
    return [now - (moment.captured[0].time_ns / 1e9 - EPOCH_S) for now, moment in given]


@pytest.mark.parametrize("phases_s", [(0.0, 0.0), (0.012, -0.012), (0.016, -0.016)])
def test_cameras_that_nobody_synchronises_are_joined_with_their_frames(
    phases_s: tuple[float, float],
) -> None:
    given = joined(Sender(0.02), *(Sender(0.02 + phase) for phase in phases_s))
    whole = given[3:-2]
    assert sources(whole) == ["front"] * len(whole)
    assert len(given) >= 59
    for _, moment in whole:
        assert [one.camera for one in moment.captured] == list(NAMES)
        first = moment.captured[0].time_ns
        assert all(abs(one.time_ns - first) / 1e9 < 0.51 * PERIOD_S for one in moment.captured)
        assert all(one.frame == one.skeleton for one in moment.captured)
    assert max(ages_s(whole)) < 0.03


def test_no_capture_is_used_twice() -> None:
    given = joined(Sender(0.02), Sender(0.03, period_s=2 * PERIOD_S))
    used = [(one.camera, one.sequence) for _, moment in given for one in moment.captured]
    assert len(used) == len(set(used))
    assert sum(camera == "left" for camera, _ in used) >= 28


def test_when_the_first_camera_dies_the_next_one_takes_over_within_two_periods() -> None:
    given = joined(Sender(0.02, dies_s=1.0), Sender(0.025), Sender(0.01))
    times_s = [moment.captured[0].time_ns / 1e9 - EPOCH_S for _, moment in given]
    assert max(b - a for a, b in pairwise(times_s)) < 2.0 * PERIOD_S
    assert set(sources(given[-20:])) == {"left"}
    late = [age for age, time_s in zip(ages_s(given), times_s, strict=True) if time_s > 1.2]
    assert max(late) < 0.03
    assert max(ages_s(given)) < 0.06


def test_a_frame_that_the_first_camera_loses_is_made_up_for_by_another() -> None:
    given = joined(Sender(0.02, lost=(30,)), Sender(0.025), Sender(0.015))
    times_s = [moment.captured[0].time_ns / 1e9 - EPOCH_S for _, moment in given]
    assert max(b - a for a, b in pairwise(times_s)) < 1.6 * PERIOD_S
    assert sources(given)[1:].count("front") == len(given) - 2
    assert max(ages_s(given)) < 0.06


def test_a_camera_that_is_always_too_late_is_not_waited_for() -> None:
    given = joined(Sender(0.02), Sender(0.02, late_s=0.2))
    assert max(ages_s(given)[20:]) < 0.012
    assert len(given) >= 59


def test_pictures_that_do_not_come_hold_nothing_up_for_long() -> None:
    given = joined(Sender(0.02), Sender(0.02, frames_lost=range(30, 40)))
    assert max(ages_s(given)) < 0.03
    without = [moment for _, moment in given if any(one.frame is None for one in moment.captured)]
    assert len(without) == 10


@pytest.mark.parametrize("odd", [0, 1, 2])
def test_a_clock_that_is_two_seconds_off_is_found_and_its_camera_left_out(odd: int) -> None:
    senders = [Sender(0.02, clock_s=2.0 if number == odd else 0.0) for number in range(3)]
    moments: JoinedMoments[str, str] = JoinedMoments(NAMES, pixels=False)
    for camera, sender in zip(NAMES, senders, strict=True):
        for at, kind, _, number, time_ns in sender.messages(camera, 1.0):
            if kind == "skeleton":
                moments.add_skeleton(camera, number, time_ns, "", at)
    assert dict(moments.odd_clocks()) == {NAMES[odd]: pytest.approx(2.0)}
    given = joined(*senders)
    assert all(NAMES[odd] not in {one.camera for one in moment.captured} for _, moment in given[9:])
    assert max(ages_s(given)[9:]) < 0.06


def test_who_is_too_slow_gets_the_newest_moment_and_the_rest_are_skipped() -> None:
    given = joined(Sender(0.02), Sender(0.02), step_s=2.5 * PERIOD_S)
    skipped = sum(len(moment.skipped) for _, moment in given)
    assert skipped + len(given) >= 55
    assert skipped > len(given)
    assert max(ages_s(given)) < 2.0 * PERIOD_S


def test_where_every_moment_matters_none_is_skipped() -> None:
    given = joined(Sender(0.02), Sender(0.03), step_s=2.5 * PERIOD_S, every=True)
    front = [moment.captured[0].sequence for _, moment in given]
    assert front == list(range(60))
    assert all(not moment.skipped for _, moment in given)
    assert all(len(moment.captured) == 2 for _, moment in given[1:-1])


def test_what_is_not_used_is_counted() -> None:
    moments: JoinedMoments[str, str] = JoinedMoments(("front", "left"))
    moments.add_skeleton("front", 0, round(1e9 * EPOCH_S), "", 0.0)
    moments.add_frame("left", 7, "", 0.0)
    moments.leave()
    assert list(moments.take_unused()) == [("front", 1, 0), ("left", 0, 1)]
    assert list(moments.take_unused()) == [("front", 0, 0), ("left", 0, 0)]
