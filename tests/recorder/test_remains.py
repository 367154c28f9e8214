"""Damage costs the messages that it hits, and no others."""

from pathlib import Path

import pytest
from inhand_recorder.losses import (
    LOSSES_RECORD,
    LossCounter,
    Losses,
    parse_losses,
)
from inhand_recorder.records import HEADER_BYTES, MESSAGE_BYTES
from inhand_recorder.recovery import recover_recording
from inhand_runtime.recording import (
    RecordingError,
    RecordingWriter,
    read_metadata,
    read_recording,
)
from recordings import (
    POSE_KEY,
    RGBD_KEY,
    START_NS,
    contents,
    damaged_copy,
    frame_messages,
    write_frame,
    write_without_checksums,
)


def test_a_damaged_middle_is_skipped_and_its_bytes_are_told(whole: Path, tmp_path: Path) -> None:
    data = bytearray(whole.read_bytes())
    position = data.index(frame_messages(15, 200)[0][2])
    data[position + 100] ^= 0x40
    damaged = damaged_copy(tmp_path, bytes(data))
    with pytest.raises(RecordingError, match="is damaged"):
        list(read_recording(damaged))
    report = recover_recording(damaged, tmp_path / "saved.mcap")
    everything = contents(whole)
    assert contents(report.output) == everything[:45] + everything[46:]
    assert 0 < report.skipped_bytes < 600
    assert (report.unchecked, report.undecodable) == (0, 0)
    losses = parse_losses(read_metadata(report.output)[LOSSES_RECORD])
    assert losses[RGBD_KEY] == Losses(received=29, lost=1)


def test_the_first_chunk_may_be_damaged_and_the_index_gone(whole: Path, tmp_path: Path) -> None:
    data = bytearray(whole.read_bytes()[:-500])
    data[data.index(frame_messages(2, 200)[0][2]) + 100] ^= 1
    report = recover_recording(damaged_copy(tmp_path, bytes(data)), tmp_path / "saved.mcap")
    everything = contents(whole)
    assert contents(report.output) == everything[:6] + everything[7:]


def test_a_damaged_channel_lends_no_message_to_another_key(whole: Path, tmp_path: Path) -> None:
    data = whole.read_bytes().replace(b"rig/pose/mug\x07", b"rig/pose/mud\x07")  # also the index's
    assert data != whole.read_bytes()
    report = recover_recording(damaged_copy(tmp_path, data), tmp_path / "saved.mcap")
    assert contents(report.output) == contents(whole)


def test_damage_in_every_chunk_costs_only_the_messages_that_it_hits(
    whole: Path, tmp_path: Path
) -> None:
    data = bytearray(whole.read_bytes())
    everything = contents(whole)
    hit = set(range(4, len(everything), 15))
    for number in hit:
        data[data.index(everything[number][1]) + 3] ^= 0x10
    report = recover_recording(damaged_copy(tmp_path, bytes(data)), tmp_path / "saved.mcap")
    kept = [one for number, one in enumerate(everything) if number not in hit]
    assert contents(report.output) == kept
    assert report.unchecked == 0


def test_a_broken_length_costs_no_message_behind_it(whole: Path, tmp_path: Path) -> None:
    data = bytearray(whole.read_bytes())
    everything = contents(whole)
    start = data.index(everything[50][1]) - MESSAGE_BYTES - HEADER_BYTES
    data[start + 1] ^= 0xFF
    report = recover_recording(damaged_copy(tmp_path, bytes(data)), tmp_path / "saved.mcap")
    assert contents(report.output) == everything[:50] + everything[51:]


def test_a_flipped_bit_before_a_cut_is_left_out(whole: Path, tmp_path: Path) -> None:
    data = bytearray(whole.read_bytes())
    everything = contents(whole)
    data[data.index(everything[75][1]) + 150] ^= 1
    cut = damaged_copy(tmp_path, bytes(data[: data.index(everything[85][1])]))
    report = recover_recording(cut, tmp_path / "saved.mcap")
    assert contents(report.output) == everything[:75] + everything[76:85]
    assert report.unchecked == 0


def test_without_checksums_what_decodes_is_saved_and_told_as_unchecked(tmp_path: Path) -> None:
    path = tmp_path / "old.mcap"
    write_without_checksums(path, damaged=7)
    report = recover_recording(path, tmp_path / "saved.mcap")
    assert (report.messages, report.unchecked, report.undecodable) == (19, 19, 1)


def test_what_does_not_decode_is_left_out_and_counted(tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "walk.mcap") as writer:
        write_frame(writer, LossCounter(), 0, 10)
        stamp = {"received_ns": START_NS, "captured_ns": START_NS, "sequence": 1}
        writer.write(POSE_KEY, b"\x80", **stamp)
    report = recover_recording(writer.path, tmp_path / "saved.mcap")
    assert (report.messages, report.undecodable, report.unchecked) == (3, 1, 0)
