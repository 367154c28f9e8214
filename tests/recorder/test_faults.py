"""Each message that is damaged, cut off, unchecked or left out is named."""

import random
from pathlib import Path

import pytest
from inhand_recorder.inspection import inspect_recording
from inhand_recorder.records import HEADER_BYTES, MESSAGE_BYTES
from inhand_recorder.recovery import recover_recording
from inhand_recorder.scanning import scan
from inhand_recorder.verification import examine_recording, verify_recording
from inhand_runtime.recording import RecordingWriter
from recordings import (
    FRAME_NS,
    POSE_KEY,
    RGBD_KEY,
    SKELETONS_KEY,
    START_NS,
    contents,
    damaged_copy,
    frame_messages,
    write_without_checksums,
)

STREAMS = (RGBD_KEY, SKELETONS_KEY, POSE_KEY)
"""The keys of a frame's messages in the order of ``frame_messages``."""


def named(lines: list[str] | tuple[str, ...], key: str, number: int, what: str) -> bool:
    head = f"{key} number {number}, received 2023-"
    return any(line.startswith(head) and what in line for line in lines)


def test_a_flipped_bit_before_a_cut_and_the_message_that_is_cut_are_named(
    whole: Path, tmp_path: Path
) -> None:
    data = bytearray(whole.read_bytes())
    everything = contents(whole)
    data[data.index(everything[75][1]) + 150] ^= 1
    cut = damaged_copy(tmp_path, bytes(data[: data.index(everything[85][1])]))
    report = recover_recording(cut, tmp_path / "saved.mcap")
    for lines in (verify_recording(cut), inspect_recording(cut).faults, report.faults):
        assert named(lines, RGBD_KEY, 25, "damaged, its checksum contradicts it")
        assert named(lines, SKELETONS_KEY, 28, "cut off")
        place = next(line for line in lines if "the file ends within the part" in line)
        assert "6 of its 30 messages lost; 4 of these cannot be named, received after" in place
    assert all(line.endswith(", left out") for line in report.faults if " number " in line)
    notes = examine_recording(report.output).notes
    assert [note.removeprefix("recovered from damaged.mcap: ") for note in notes] == list(
        report.faults
    )


def test_damage_in_every_chunk_is_named_message_by_message(whole: Path, tmp_path: Path) -> None:
    data = bytearray(whole.read_bytes())
    everything = contents(whole)
    for place in (4, 19, 34, 49, 64, 79):
        data[data.index(everything[place][1]) + 3] ^= 0x10
    lines = recover_recording(damaged_copy(tmp_path, bytes(data)), tmp_path / "s.mcap").faults
    assert sum("2 of its 30 messages lost" in line for line in lines) == 3
    (line,) = (line for line in lines if line.startswith(SKELETONS_KEY))
    assert line.startswith(f"{SKELETONS_KEY}: 6 messages, numbers 1, 6, 11, 16, 21, 26, received")


def test_neighbours_that_are_both_damaged_are_both_named(whole: Path, tmp_path: Path) -> None:
    data = bytearray(whole.read_bytes())
    everything = contents(whole)
    for place in (30, 31, 32):
        data[data.index(everything[place][1]) + 1] ^= 0xFF
    lines = verify_recording(damaged_copy(tmp_path, bytes(data)))
    assert all(named(lines, key, 10, "damaged") for key in STREAMS)


def test_a_broken_length_leaves_the_message_its_name(whole: Path, tmp_path: Path) -> None:
    data = bytearray(whole.read_bytes())
    data[data.index(contents(whole)[50][1]) - MESSAGE_BYTES - HEADER_BYTES + 1] ^= 0xFF
    lines = verify_recording(damaged_copy(tmp_path, bytes(data)))
    assert named(lines, POSE_KEY, 16, "damaged")


@pytest.mark.parametrize("seed", range(20))
def test_what_is_named_or_counted_is_all_that_was_lost(
    seed: int, whole: Path, tmp_path: Path
) -> None:
    chance = random.Random(seed)
    data = bytearray(whole.read_bytes())
    parts = [s for s in scan(bytes(data)) if len(s.records) > 1]
    for part in parts:
        for _ in range(4):
            place = part.offset + chance.randrange(60, part.length)
            data[place] ^= 1 << chance.randrange(8)
    damaged = damaged_copy(tmp_path, bytes(data))
    report = recover_recording(damaged, tmp_path / "saved.mcap")
    everything, saved = contents(whole), set(contents(report.output))
    counts = [x.split(": ")[1].split(" of its ")[0] for x in report.faults if " of its " in x]
    assert sum(map(int, counts)) == sum(one not in saved for one in everything)


def test_the_checksums_of_a_lost_chunk_say_how_many_went_with_it(
    whole: Path, tmp_path: Path
) -> None:
    data = bytearray(whole.read_bytes())
    second = [s for s in scan(bytes(data)) if len(s.records) > 1][1]
    for damaged in (
        bytes(data[: second.offset]) + b"\xff" * 60 + bytes(data[second.offset + 60 :]),
        bytes(data[: second.offset]),
    ):
        lines = verify_recording(damaged_copy(tmp_path, damaged))
        assert any("30 of its 30 messages lost; 30 of these cannot be named" in x for x in lines)


def test_one_message_alone_in_its_chunk_is_not_kept_where_its_checksum_contradicts_it(
    tmp_path: Path,
) -> None:
    with RecordingWriter(tmp_path / "walk.mcap") as writer:
        for number in range(3):
            stamp_ns = START_NS + number * FRAME_NS
            stamps = {"received_ns": stamp_ns, "captured_ns": stamp_ns, "sequence": number}
            writer.write(POSE_KEY, frame_messages(number, 1)[2][2], **stamps)
            writer.sync()
    data = bytearray(writer.path.read_bytes())
    data[data.index(frame_messages(1, 1)[2][2]) + 40] ^= 1
    report = recover_recording(damaged_copy(tmp_path, bytes(data)), tmp_path / "saved.mcap")
    assert [one[4] for one in contents(report.output)] == [0, 2]
    assert named(report.faults, POSE_KEY, 1, "left out")


def test_what_no_checksum_covers_is_named_and_stays_so_in_what_was_recovered(
    tmp_path: Path,
) -> None:
    path = tmp_path / "old.mcap"
    write_without_checksums(path, damaged=7)
    report = recover_recording(path, tmp_path / "saved.mcap")
    kept = f"{POSE_KEY}: 19 messages, numbers 0-6, 8-19, received from"
    assert any(x.startswith(kept) and x.endswith("covers it, kept") for x in report.faults)
    assert named(report.faults, POSE_KEY, 7, "undecodable, left out")
    assert any(kept in note for note in examine_recording(report.output).notes)
    assert any("unchecked" in line for line in verify_recording(path))


def test_what_a_file_keeps_apart_is_not_left_out_without_a_word(tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "walk.mcap") as writer:
        stamps = {"received_ns": START_NS, "captured_ns": START_NS, "sequence": 0}
        writer.write(POSE_KEY, frame_messages(0, 1)[2][2], **stamps)
        writer.write_apart(POSE_KEY, b"\xc1", received_ns=START_NS)
    report = recover_recording(writer.path, tmp_path / "saved.mcap")
    (line,) = report.faults
    assert line.endswith("kept apart as undecodable, left out")
