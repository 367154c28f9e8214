"""Recordings are read from any time of capture on, without what stands before."""

from collections.abc import Sequence
from pathlib import Path

import pytest
from inhand_runtime.recording import RecordingWriter, read_recording
from inhand_runtime.recording.reading import read_outline
from inhand_schemas.keys import Site
from inhand_schemas.messages import Skeletons
from inhand_schemas.topics import SKELETONS
from mcap import reader as mcap_reader

KEY = SKELETONS.key(Site(), "kitchen")
SECOND_NS = 10**9
BEGIN_NS = 1_600_000_000 * SECOND_NS


def written(path: Path, seconds: Sequence[int]) -> Path:
    """A recording of a chunk for each message, captured at these seconds."""
    with RecordingWriter(path) as writer:
        for number, second in enumerate(seconds):
            time_ns = BEGIN_NS + second * SECOND_NS
            payload = SKELETONS.encode(Skeletons(sequence=number, time_ns=time_ns))
            writer.write(
                KEY, payload, received_ns=time_ns + 5, captured_ns=time_ns, sequence=number
            )
            writer.sync()
    return path


def numbers_from(path: Path, second: int) -> list[int]:
    from_ns = BEGIN_NS + second * SECOND_NS
    return [one.sequence for one in read_recording(path, captured_from_ns=from_ns)]


@pytest.mark.parametrize("second", [0, 1, 49, 50, 98, 99])
def test_nothing_from_the_time_on_is_left_out_and_little_before_it_comes(
    tmp_path: Path, second: int
) -> None:
    numbers = numbers_from(written(tmp_path / "walk.mcap", range(100)), second)
    assert numbers[-(100 - second) :] == list(range(second, 100))
    assert len(numbers) <= 100 - second + 2


def test_after_the_end_there_is_nothing(tmp_path: Path) -> None:
    assert numbers_from(written(tmp_path / "walk.mcap", range(10)), 10) == []


def test_what_comes_after_a_clock_that_was_set_back_is_not_left_out(tmp_path: Path) -> None:
    path = written(tmp_path / "set.mcap", [*range(100, 150), *range(50)])
    assert numbers_from(path, 120)[-80:] == list(range(20, 100))
    assert numbers_from(path, 0) == list(range(100))


def test_a_time_that_only_a_later_part_reaches_is_found_there(tmp_path: Path) -> None:
    path = written(tmp_path / "set.mcap", [*range(100, 150), *range(300)])
    numbers = numbers_from(path, 200)
    assert numbers[-100:] == list(range(250, 350))
    assert len(numbers) < 110


def test_few_chunks_are_read_to_find_a_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = written(tmp_path / "long.mcap", range(1000))
    read: list[int] = []
    breakup = mcap_reader.breakup_chunk
    for module in ("mcap.reader", "inhand_runtime.recording.seeking"):
        monkeypatch.setattr(
            f"{module}.breakup_chunk", lambda *a, **b: read.append(1) or breakup(*a, **b)
        )
    assert numbers_from(path, 990)[-10:] == list(range(990, 1000))
    assert len(read) < 40


def test_an_outline_says_what_is_there_without_reading_it(tmp_path: Path) -> None:
    outline = read_outline(written(tmp_path / "walk.mcap", range(10)), ["skeletons"])
    assert outline.counts == {KEY: 10}
    assert outline.received_ns == BEGIN_NS + 5
    assert outline.last_captured_ns == BEGIN_NS + 9 * SECOND_NS
    with RecordingWriter(tmp_path / "empty.mcap"):
        pass
    empty = read_outline(tmp_path / "empty.mcap", ["skeletons"])
    assert (empty.counts, empty.received_ns, empty.last_captured_ns) == ({}, None, None)
