"""Files are written as mcap's own writer writes them."""

import struct
from pathlib import Path

import pytest
from inhand_runtime.recording.mcap_writer import JOINED_BYTES, LIBRARY, McapWriter
from inhand_runtime.recording.part_file import PartFile
from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer

SIZES = (0, 1, JOINED_BYTES - 1, JOINED_BYTES, 200_000)
"""Bytes of payloads."""


def payload(number: int) -> bytes:
    return bytes([number % 251]) * SIZES[number % len(SIZES)]


def write_ours(path: Path) -> bytes:
    file = PartFile(path)
    writer = McapWriter(file, "profile")
    schema = writer.add_schema("Pose", "jsonschema", b"{}")
    for number in range(40):
        if number % 10 == 0:
            writer.add_channel(f"topic {number}", "msgpack", schema)
        channel, time_ns = 1 + number % (1 + number // 10), 1000 - number
        writer.add_message(channel, number, time_ns, number, payload(number))
        if number % 7 == 6:
            writer.add_metadata("checksums", {"number": str(number)})
            writer.end_chunk()
    writer.add_attachment(7, "mesh.ply", "model/ply", bytes(5000))
    writer.finish()
    file.publish()
    return path.read_bytes()


def write_by_mcap(path: Path) -> bytes:
    with path.open("wb") as file:
        writer = Writer(
            file, chunk_size=1 << 40, compression=CompressionType.NONE, enable_data_crcs=True
        )
        writer.start("profile", LIBRARY)
        schema = writer.register_schema("Pose", "jsonschema", b"{}")
        for number in range(40):
            if number % 10 == 0:
                writer.register_channel(f"topic {number}", "msgpack", schema)
            channel, time_ns = 1 + number % (1 + number // 10), 1000 - number
            writer.add_message(channel, time_ns, payload(number), number, number)
            if number % 7 == 6:
                writer.add_metadata("checksums", {"number": str(number)})
                writer.flush()  # type: ignore[no-untyped-call]
        writer.add_attachment(0, 7, "mesh.ply", "model/ply", bytes(5000))
        writer.finish()  # type: ignore[no-untyped-call]
    return path.read_bytes()


def test_a_file_is_byte_for_byte_that_of_mcap_s_own_writer(tmp_path: Path) -> None:
    assert write_ours(tmp_path / "ours.mcap") == write_by_mcap(tmp_path / "theirs.mcap")


@pytest.mark.parametrize(
    ("channel", "sequence", "time_ns"),
    [(1 << 16, 0, 0), (1, 1 << 32, 0), (1, 0, -1), (1, 0, 1 << 64)],
)
def test_a_number_that_does_not_fit_leaves_nothing_in_the_file(
    channel: int, sequence: int, time_ns: int, tmp_path: Path
) -> None:
    file = PartFile(tmp_path / "walk.mcap")
    writer = McapWriter(file, "profile")
    writer.add_channel("topic", "msgpack", 0)
    with pytest.raises(struct.error):
        writer.add_message(channel, sequence, time_ns, 0, b"refused")
    writer.add_message(1, 1, 1, 1, b"taken")
    writer.finish()
    file.publish()
    with (tmp_path / "walk.mcap").open("rb") as written:
        reader = make_reader(written, validate_crcs=True)
        assert [message.data for _, _, message in reader.iter_messages()] == [b"taken"]
