"""Losses are told from sequence numbers alone."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from inhand_recorder.losses import LossCounter, Losses, format_losses, parse_losses

KEY = "inhand/@v1/rig/rgbd/kitchen"


def losses_of(*sequences: int) -> Losses:
    counter = LossCounter()
    for sequence in sequences:
        counter.count(KEY, sequence)
    return counter.losses()[KEY]


def test_consecutive_numbers_lose_nothing() -> None:
    assert losses_of(0, 1, 2, 3) == Losses(received=4)


def test_the_first_number_seen_starts_the_count() -> None:
    assert losses_of(1000, 1001) == Losses(received=2)


def test_a_gap_forward_counts_the_missing_numbers() -> None:
    assert losses_of(1, 2, 5, 7) == Losses(received=4, lost=3)


def test_a_jump_back_is_a_restart_and_no_loss() -> None:
    assert losses_of(8, 9, 0, 1, 2) == Losses(received=5, restarts=1)


def test_a_gap_after_a_restart_is_a_loss() -> None:
    assert losses_of(8, 9, 0, 2) == Losses(received=4, lost=1, restarts=1)


def test_a_duplicate_is_not_counted() -> None:
    assert losses_of(1, 2, 2, 2, 3) == Losses(received=3)


def test_numbers_beyond_32_bits_count_as_the_recording_keeps_them() -> None:
    assert losses_of(2**40 + 1, 2**40 + 2) == Losses(received=2)
    assert losses_of(2**40 + 1) == losses_of(1)


def test_each_key_is_counted_alone() -> None:
    counter = LossCounter()
    for sequence in (0, 1, 2):
        counter.count("a", sequence)
        counter.count("b", 10 * sequence)
    assert counter.losses() == {"a": Losses(received=3), "b": Losses(received=3, lost=18)}


def test_drops_of_the_queue_stand_beside_the_count() -> None:
    counter = LossCounter()
    counter.count("a", 0)
    counter.count("a", 3)
    dropped = counter.losses({"a": 2, "never_received": 1})
    assert dropped["a"] == Losses(received=2, lost=2, dropped=2)
    assert dropped["never_received"] == Losses(dropped=1)


counts = st.integers(0, 2**63)


@given(st.dictionaries(st.text(), st.builds(Losses, counts, counts, counts, counts)))
def test_losses_are_read_as_they_are_written(losses: dict[str, Losses]) -> None:
    assert parse_losses(format_losses(losses)) == losses


@pytest.mark.parametrize("value", ["", "received=1", "received=1 lost=-1 restarts=0 dropped=0"])
def test_losses_that_nobody_wrote_are_refused(value: str) -> None:
    with pytest.raises(ValueError, match="losses of a"):
        parse_losses({"a": value})


@given(
    st.lists(st.integers(1, 5), min_size=1, max_size=50),
    st.integers(0, 1000),
)
def test_received_and_lost_add_up_to_the_numbers_that_were_sent(
    steps: list[int], first: int
) -> None:
    sequences = [first]
    for step in steps:
        sequences.append(sequences[-1] + step)
    losses = losses_of(*sequences)
    assert losses.received + losses.lost == sequences[-1] - first + 1
