"""Skeletons and pixels of one frame find each other, and nobody waits in vain or comes late."""

from hypothesis import given
from hypothesis import strategies as st
from inhand_tracker.live.moments import Moment, Moments
from inhand_tracker.live.parameters import DEFAULT_MOMENTS

START = 100.0
PERIOD_S = DEFAULT_MOMENTS.first_period_s
PATIENCE = DEFAULT_MOMENTS.patience
FLOWING_S = DEFAULT_MOMENTS.flowing_s
FRAMES_KEPT = DEFAULT_MOMENTS.frames_kept
A_BIT_S = 1e-3

Texts = Moments[str, str]


def flowing(*sequences: int, every: bool = False) -> Texts:
    """Moments of a camera that has just sent these frames."""
    moments: Texts = Moments(every=every)
    for sequence in sequences:
        moments.add_frame(sequence, f"frame {sequence}", START)
    return moments


def pair(number: int, *skipped: int) -> Moment[str, str]:
    before = tuple(f"skeleton {one}" for one in skipped)
    return Moment(f"skeleton {number}", f"frame {number}", before)


def alone(number: int, *skipped: int) -> Moment[str, str]:
    return Moment(f"skeleton {number}", None, tuple(f"skeleton {one}" for one in skipped))


def add(moments: Texts, *sequences: int, at: float = START) -> None:
    for sequence in sequences:
        moments.add_skeleton(sequence, f"skeleton {sequence}", at)


def test_nothing_comes_out_of_nothing() -> None:
    moments = flowing()
    assert moments.next(START) is None
    moments.add_frame(1, "frame 1", START)
    assert moments.next(START) is None
    assert moments.wait_s(START) == float("inf")


def test_a_skeleton_waits_for_the_frame_of_its_sequence() -> None:
    moments = flowing(6)
    add(moments, 7)
    assert moments.next(START) is None
    moments.add_frame(7, "frame 7", START + 0.01)
    assert moments.next(START + 0.01) == pair(7)
    assert moments.next(START + 0.01) is None


def test_a_frame_that_came_first_is_kept_for_its_skeleton() -> None:
    moments = flowing(7)
    add(moments, 7)
    assert moments.next(START) == pair(7)


def test_where_no_pixels_are_wanted_a_skeleton_goes_at_once() -> None:
    for every in (False, True):
        moments: Texts = Moments(pixels=False, every=every)
        add(moments, 7)
        assert moments.wait_s(START) == 0.0
        assert moments.decided()
        assert moments.next(START) == alone(7)


def test_a_camera_s_first_skeleton_waits_for_the_first_frame() -> None:
    moments = flowing()
    add(moments, 0)
    assert moments.next(START) is None
    moments.add_frame(0, "frame 0", START + A_BIT_S)
    assert moments.next(START + A_BIT_S) == pair(0)


def test_a_camera_without_pixels_is_known_after_a_second_and_its_skeletons_go_at_once() -> None:
    for every in (False, True):
        moments = flowing(every=every)
        add(moments, 0)
        add(moments, 1, at=START + 0.6)
        later = START + FLOWING_S + 0.1
        while moments.next(later) is not None:
            pass
        add(moments, 2, at=later)
        assert moments.next(later) == alone(2)


def test_after_a_pause_pixels_are_expected_again() -> None:
    moments = flowing()
    add(moments, 0)
    moments.next(START + FLOWING_S)
    later = START + 3 * FLOWING_S
    add(moments, 1, at=later)
    assert moments.next(later) is None


def test_pixels_that_ceased_a_second_ago_are_not_waited_for() -> None:
    moments = flowing(6)
    add(moments, 6)
    moments.next(START)
    add(moments, 7, at=START + FLOWING_S - A_BIT_S)
    assert moments.next(START + FLOWING_S - A_BIT_S) is None
    assert moments.next(START + FLOWING_S) == alone(7)


def test_a_skeleton_does_not_wait_longer_than_a_period_of_the_camera() -> None:
    for period_s in (PERIOD_S, 0.01, 0.2):
        moments = flowing()
        for number in range(20):
            moments.add_frame(number, "", START + number * period_s)
            add(moments, number, at=START + number * period_s)
            moments.next(START + number * period_s)
        last = START + 20 * period_s
        add(moments, 20, at=last)
        assert moments.next(last + 0.9 * PATIENCE * period_s) is None
        assert abs(moments.wait_s(last) - PATIENCE * period_s) < 1e-9
        assert moments.next(last + PATIENCE * period_s + 1e-9) == alone(20)


def test_a_lost_frame_costs_its_skeleton_only_the_picture() -> None:
    moments = flowing(6)
    add(moments, 7)
    assert moments.next(START + PERIOD_S) == alone(7)
    add(moments, 8, at=START + PERIOD_S)
    moments.add_frame(8, "frame 8", START + PERIOD_S + A_BIT_S)
    assert moments.next(START + PERIOD_S + A_BIT_S) == pair(8)


def test_a_frame_that_comes_after_its_skeleton_went_is_unused() -> None:
    moments = flowing(6)
    add(moments, 7)
    moments.next(START + PERIOD_S)
    moments.add_frame(7, "frame 7", START + PERIOD_S)
    add(moments, 8)
    moments.add_frame(8, "frame 8", START + PERIOD_S)
    assert moments.next(START + PERIOD_S) == pair(8)
    assert moments.take_unused_frames() == 2


def test_only_the_newest_frames_are_kept() -> None:
    moments = flowing(*range(10), every=True)
    add(moments, 9 - FRAMES_KEPT, 10 - FRAMES_KEPT, 9)
    assert moments.next(START) == alone(9 - FRAMES_KEPT)
    assert moments.next(START) == pair(10 - FRAMES_KEPT)
    assert moments.next(START) == pair(9)


def test_frames_of_before_a_restart_are_not_paired_when_the_frame_is_first() -> None:
    moments = flowing(0, 1, 2, 1000)
    moments.add_frame(0, "new frame 0", START)
    add(moments, 1)
    assert moments.next(START) is None
    moments.add_frame(1, "frame 1", START)
    assert moments.next(START) == pair(1)


def test_frames_of_before_a_restart_are_not_paired_when_the_skeleton_is_first() -> None:
    moments = flowing(2, 3)
    add(moments, 3)
    assert moments.next(START) == pair(3)
    add(moments, 2)
    assert moments.next(START) is None
    moments.add_frame(2, "frame 2", START)
    assert moments.next(START) == pair(2)


def test_nobody_waits_for_a_frame_of_before_a_restart() -> None:
    for every, moment in ((False, pair(2, 900)), (True, alone(900))):
        moments = flowing(899, every=every)
        add(moments, 900, 2)
        moments.add_frame(2, "frame 2", START)
        assert moments.next(START) == moment


def behind(frames: int, *, every: bool = False) -> Texts:
    """Moments of a tracker that was busy while so many frames came."""
    moments = flowing(every=every)
    for sequence in range(frames):
        add(moments, sequence)
        moments.add_frame(sequence, f"frame {sequence}", START)
    return moments


def test_who_is_behind_goes_on_with_the_newest_moment_and_skips_the_others() -> None:
    moments = behind(30)
    assert moments.next(START) == pair(29, *range(29))
    assert moments.next(START) is None
    assert moments.take_unused_frames() == 29


def test_a_newer_skeleton_whose_frame_is_not_there_yet_waits_for_it() -> None:
    moments = behind(30)
    add(moments, 30)
    assert moments.next(START) == pair(29, *range(29))
    assert moments.next(START) is None
    moments.add_frame(30, "frame 30", START)
    assert moments.next(START) == pair(30)


def test_without_pixels_the_newest_skeleton_is_next_too() -> None:
    moments: Texts = Moments(pixels=False)
    add(moments, *range(30))
    assert moments.next(START) == alone(29, *range(29))


def test_where_every_frame_matters_each_comes_in_its_order_with_its_frame() -> None:
    moments = flowing(every=True)
    for number in range(30):
        add(moments, number)
        assert not moments.decided()
        moments.add_frame(number, f"frame {number}", START)
        assert moments.decided()
        assert moments.next(START + 30.0) == pair(number)


def test_where_every_frame_matters_one_is_waited_for_until_a_later_one_is_there() -> None:
    moments = flowing(6, every=True)
    add(moments, 7, 8)
    assert moments.next(START + 0.9 * FLOWING_S) is None
    moments.add_frame(8, "frame 8", START + 0.9 * FLOWING_S)
    assert moments.next(START + 0.9 * FLOWING_S) == alone(7)
    assert moments.next(START + 0.9 * FLOWING_S) == pair(8)


@given(
    st.lists(st.tuples(st.integers(0, 3), st.booleans(), st.floats(0.0, 0.1)), max_size=60),
    st.booleans(),
)
def test_every_skeleton_and_frame_is_used_or_counted(
    happenings: list[tuple[int, bool, float]], every: bool
) -> None:
    moments: Moments[int, int] = Moments(every=every)
    used, skipped, with_frame, frames, now = [], [], 0, 0, START
    for sequence, (steps, lost, pause_s) in enumerate(happenings):
        moments.add_skeleton(sequence, sequence, now)
        if not lost:
            moments.add_frame(sequence, sequence, now)
            frames += 1
        now += pause_s
        for _ in range(steps):
            moment = moments.next(now)
            if moment is not None:
                used.append(moment.skeleton)
                skipped += moment.skipped
                with_frame += moment.frame is not None
                assert moment.frame in (None, moment.skeleton)
    while (moment := moments.next(now + 2 * FLOWING_S)) is not None:
        used.append(moment.skeleton)
        skipped += moment.skipped
        with_frame += moment.frame is not None
    assert sorted(used + skipped) == list(range(len(happenings)))
    assert used == sorted(used)
    assert not (every and skipped)
    assert moments.leave() == 0
    assert with_frame + moments.take_unused_frames() == frames


def test_what_waits_at_the_end_is_given_up_and_counted() -> None:
    moments = behind(3)
    assert moments.leave() == 3
    assert moments.take_unused_frames() == 3
    assert moments.next(START) is None
