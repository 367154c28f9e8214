"""The host's two clocks, read together."""

import itertools

from inhand_capture.sources.oak.clock import epoch_offset

EPOCH_NS = 1_700_000_000_000_000_000


def test_the_offset_leads_from_one_clock_to_the_other_within_its_uncertainty() -> None:
    reads = itertools.count(5_000, 1_000)
    last = 0

    def monotonic() -> int:
        nonlocal last
        last = next(reads)
        return last

    offset, uncertainty = epoch_offset(monotonic, lambda: EPOCH_NS + last)
    assert abs(offset - EPOCH_NS) <= uncertainty == 500


def test_a_reading_that_was_interrupted_is_repeated() -> None:
    reads = iter((0, 50_000_000, 50_000_000, 50_000_400))
    offset, uncertainty = epoch_offset(lambda: next(reads), lambda: EPOCH_NS)
    assert (offset, uncertainty) == (EPOCH_NS - 50_000_200, 200)
