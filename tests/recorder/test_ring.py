"""The last seconds in memory."""

import tracemalloc

from inhand_recorder.recording_file import Entry
from inhand_recorder.ring import ENTRY_BYTES, Ring, RingBounds

KEY = "inhand/@v1/rig/pose/a_mug_with_a_rather_long_name"


def entry(number: int, size: int) -> Entry:
    """An entry that shares nothing with another, as what comes over the wire."""
    return Entry("".join(KEY), bytes(size), 10**18 + number, 10**18 + number, 10**6 + number)


def fill(ring: Ring, count: int, size: int, period_s: float = 0.01) -> None:
    for number in range(count):
        while ring.must_shrink(number * period_s, coming=size):
            ring.drop_oldest()
        ring.add(number * period_s, entry(number, size))


def test_what_is_too_old_goes_and_numbers_stay() -> None:
    ring = Ring(RingBounds(1.0, 1 << 30))
    fill(ring, 500, 100)
    assert ring.end == 500
    assert ring.end - ring.first == 101
    assert ring[ring.first][0] == 3.99
    assert ring[499][1].sequence == 10**6 + 499


def test_a_ring_takes_no_more_memory_than_its_bound_by_small_and_large_messages() -> None:
    for size, bound in ((100, 1 << 20), (150_000, 8 << 20)):
        ring = Ring(RingBounds(3600.0, bound))
        tracemalloc.start()
        before, _ = tracemalloc.get_traced_memory()
        fill(ring, 3 * bound // (size + ENTRY_BYTES), size)
        after, _ = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        assert 0.9 * bound < ring.bytes <= bound
        assert after - before <= ring.bytes


def test_an_empty_ring_holds_one_message_that_is_larger_than_its_bound() -> None:
    ring = Ring(RingBounds(1.0, 1000))
    fill(ring, 3, 5000)
    assert ring.end - ring.first == 1
