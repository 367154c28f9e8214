"""Skeletons and pixels of one frame find each other, and nobody waits in vain."""

from hypothesis import given
from hypothesis import strategies as st
from inhand_tracker.wire.pairing import Pairing
from inhand_tracker.wire.parameters import DEFAULT_PAIRING

START = 100.0
FLOWING_S = DEFAULT_PAIRING.flowing_s
LONGEST_WAIT_S = DEFAULT_PAIRING.longest_wait_s
FRAMES_KEPT = DEFAULT_PAIRING.frames_kept


def flowing(*sequences: int) -> Pairing[str, str]:
    """A pairing that has just received these frames."""
    pairing: Pairing[str, str] = Pairing()
    for sequence in sequences:
        pairing.add_frame(sequence, f"frame {sequence}", START)
    return pairing


def test_nothing_comes_out_of_nothing() -> None:
    pairing: Pairing[str, str] = Pairing()
    assert pairing.pop(START) is None
    pairing.add_frame(1, "frame 1", START)
    assert pairing.pop(START) is None


def test_a_skeleton_waits_for_the_frame_of_its_sequence() -> None:
    pairing = flowing(6)
    pairing.add_skeleton(7, "skeleton 7", START)
    assert pairing.pop(START) is None
    pairing.add_frame(7, "frame 7", START + 0.01)
    assert pairing.pop(START + 0.01) == ("skeleton 7", "frame 7")
    assert pairing.pop(START + 0.01) is None


def test_a_frame_that_came_first_is_kept_for_its_skeleton() -> None:
    pairing = flowing(7)
    pairing.add_skeleton(7, "skeleton 7", START)
    assert pairing.pop(START) == ("skeleton 7", "frame 7")


def test_without_pixels_a_skeleton_goes_at_once() -> None:
    pairing: Pairing[str, str] = Pairing()
    pairing.add_skeleton(7, "skeleton 7", START)
    assert pairing.pop(START) == ("skeleton 7", None)


def test_pixels_that_ceased_a_second_ago_are_not_waited_for() -> None:
    pairing = flowing(6)
    late = START + FLOWING_S
    pairing.add_skeleton(7, "skeleton 7", late - 0.01)
    assert pairing.pop(late - 0.01) is None
    assert pairing.pop(late) == ("skeleton 7", None)


def test_a_skeleton_does_not_wait_longer_than_fifty_milliseconds() -> None:
    pairing = flowing(6)
    pairing.add_skeleton(7, "skeleton 7", START)
    assert pairing.pop(START + 0.9 * LONGEST_WAIT_S) is None
    assert pairing.pop(START + LONGEST_WAIT_S + 1e-6) == ("skeleton 7", None)


def test_a_later_frame_tells_that_a_frame_will_not_come() -> None:
    pairing = flowing(6)
    pairing.add_skeleton(7, "skeleton 7", START)
    pairing.add_skeleton(8, "skeleton 8", START)
    pairing.add_frame(8, "frame 8", START)
    assert pairing.pop(START) == ("skeleton 7", None)
    assert pairing.pop(START) == ("skeleton 8", "frame 8")


def test_skeletons_come_out_in_the_order_of_their_arrival() -> None:
    pairing = flowing(1, 2, 3)
    for sequence in (1, 2, 3):
        pairing.add_skeleton(sequence, f"skeleton {sequence}", START)
    for sequence in (1, 2, 3):
        assert pairing.pop(START) == (f"skeleton {sequence}", f"frame {sequence}")


def test_only_the_newest_frames_are_kept() -> None:
    pairing = flowing(*range(10))
    for sequence in (9 - FRAMES_KEPT, 10 - FRAMES_KEPT, 9):
        pairing.add_skeleton(sequence, f"skeleton {sequence}", START)
    assert pairing.pop(START) == (f"skeleton {9 - FRAMES_KEPT}", None)
    assert pairing.pop(START) == (f"skeleton {10 - FRAMES_KEPT}", f"frame {10 - FRAMES_KEPT}")
    assert pairing.pop(START) == ("skeleton 9", "frame 9")


def test_a_frame_sent_twice_counts_once_and_the_last_is_taken() -> None:
    pairing = flowing(5, 6)
    pairing.add_frame(6, "frame 6 again", START)
    pairing.add_skeleton(6, "skeleton 6", START)
    assert pairing.pop(START) == ("skeleton 6", "frame 6 again")


def test_frames_of_before_a_restart_are_not_paired_when_the_frame_is_first() -> None:
    pairing = flowing(0, 1, 2, 1000)
    pairing.add_frame(0, "new frame 0", START)
    pairing.add_skeleton(1, "new skeleton 1", START)
    assert pairing.pop(START) is None
    pairing.add_frame(1, "new frame 1", START)
    assert pairing.pop(START) == ("new skeleton 1", "new frame 1")


def test_frames_of_before_a_restart_are_not_paired_while_a_skeleton_waits() -> None:
    pairing = flowing(2, 3)
    pairing.add_skeleton(4, "old skeleton 4", START)
    pairing.add_skeleton(2, "new skeleton 2", START)
    assert pairing.pop(START + 0.06) == ("old skeleton 4", None)
    assert pairing.pop(START + 0.06) != ("new skeleton 2", "frame 2")


def test_frames_of_before_a_restart_are_not_paired_when_no_skeleton_waits() -> None:
    pairing = flowing(2, 3)
    pairing.add_skeleton(3, "old skeleton 3", START)
    assert pairing.pop(START) == ("old skeleton 3", "frame 3")
    pairing.add_skeleton(2, "new skeleton 2", START)
    assert pairing.pop(START) is None
    pairing.add_frame(2, "new frame 2", START)
    assert pairing.pop(START) == ("new skeleton 2", "new frame 2")


def behind(frames: int) -> Pairing[str, str]:
    """A pairing whose reader was away while so many frames came."""
    pairing: Pairing[str, str] = Pairing()
    for sequence in range(frames):
        pairing.add_skeleton(sequence, f"skeleton {sequence}", START)
        pairing.add_frame(sequence, f"frame {sequence}", START)
    return pairing


def test_who_is_behind_goes_on_with_the_newest_skeleton_whose_frame_is_there() -> None:
    pairing = behind(30)
    assert pairing.pop(START) == ("skeleton 29", "frame 29")
    assert pairing.pop(START) is None
    assert pairing.dropped_skeletons == 29


def test_a_newer_skeleton_whose_frame_is_not_there_yet_waits_for_it() -> None:
    pairing = behind(30)
    pairing.add_skeleton(30, "skeleton 30", START)
    assert pairing.pop(START) == ("skeleton 29", "frame 29")
    assert pairing.pop(START) is None
    pairing.add_frame(30, "frame 30", START)
    assert pairing.pop(START) == ("skeleton 30", "frame 30")


def test_who_is_behind_by_a_hiccup_drops_nothing() -> None:
    pairing = behind(DEFAULT_PAIRING.most_waiting)
    given = [pairing.pop(START) for _ in range(DEFAULT_PAIRING.most_waiting)]
    assert given == [
        (f"skeleton {number}", f"frame {number}") for number in range(DEFAULT_PAIRING.most_waiting)
    ]


def test_without_pixels_no_skeleton_is_dropped() -> None:
    pairing: Pairing[str, str] = Pairing()
    for sequence in range(30):
        pairing.add_skeleton(sequence, f"skeleton {sequence}", START)
    assert [pairing.pop(START) for _ in range(30)] == [
        (f"skeleton {number}", None) for number in range(30)
    ]
    assert pairing.dropped_skeletons == 0


@given(st.lists(st.integers(0, 3), max_size=60))
def test_every_skeleton_and_frame_is_used_or_counted(pops: list[int]) -> None:
    pairing: Pairing[int, int] = Pairing()
    given_out = 0
    with_frame = 0
    for sequence, times in enumerate(pops):
        pairing.add_skeleton(sequence, sequence, START)
        pairing.add_frame(sequence, sequence, START)
        for _ in range(times):
            pair = pairing.pop(START)
            given_out += pair is not None
            with_frame += pair is not None and pair[1] is not None
    while (pair := pairing.pop(START)) is not None:
        given_out += 1
        with_frame += pair[1] is not None
    assert given_out + pairing.dropped_skeletons == len(pops)
    kept = min(len(pops), FRAMES_KEPT)
    assert len(pops) - kept <= with_frame + pairing.unused_frames <= len(pops)
