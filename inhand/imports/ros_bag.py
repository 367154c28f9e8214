"""Reads messages of ROS in bags of ROS 1 and 2 and in MCAP files, by ``rosbags``.

What ``rosbags`` raises on damaged files may be anything: its own errors, those of SQLite and LZ4,
``UnicodeDecodeError``, ``struct.error``. All become InhandError here.
"""

import struct
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import zstandard
from inhand_runtime.errors import InhandError
from rosbags.highlevel import AnyReader
from rosbags.interfaces import Connection
from rosbags.typesys import Stores, get_typestore

from inhand.imports.foreign import explaining

IMAGE = "sensor_msgs/msg/Image"
MOST_BYTES = 1 << 28
"""Bytes of a message at the most: 256 MiB."""
_ZSTD = b"\x28\xb5\x2f\xfd"
_BEFORE_NAME = struct.Struct("<I8x")
"""A header's number and time; its name follows, in whose place librealsense writes a version."""
_LENGTH, _SIZE, _STEP = struct.Struct("<I"), struct.Struct("<II"), struct.Struct("<BI")
_UNITS = struct.Struct("<f")


@contextmanager
def open_bag(path: Path) -> Iterator[AnyReader]:
    """Open a bag of ROS 1 (a file), of ROS 2 (a folder), or an MCAP file with messages of ROS 2.

    Raises InhandError for what is none.
    """
    with explaining(f"{path} is no bag of ROS that can be read"):
        reader = AnyReader([path], default_typestore=get_typestore(Stores.ROS2_HUMBLE))
        reader.open()
    try:
        yield reader
    finally:
        reader.close()


def messages_on(reader: AnyReader, *topics: str | None) -> Iterator[tuple[Connection, int, bytes]]:
    """Yield the messages of some topics, none of None: connection, nanoseconds in the bag, bytes.

    Raises InhandError where the bag is damaged.
    """
    chosen = [one for one in reader.connections if one.topic in topics]
    yield from messages_of(reader, chosen)


def messages_of(
    reader: AnyReader, connections: Sequence[Connection]
) -> Iterator[tuple[Connection, int, bytes]]:
    """Yield the messages of some connections as ``messages_on`` does."""
    messages = reader.messages(connections) if connections else iter(())
    while True:
        with explaining("the bag is damaged"):
            one = next(messages, None)
        if one is None:
            return
        connection, bag_ns, raw = one
        compressed = reader.is2 and raw.startswith(_ZSTD)
        yield connection, bag_ns, _decompressed(raw) if compressed else raw


def _decompressed(raw: bytes) -> bytes:
    """Return a message that is compressed by itself: ``rosbags`` knows that only of bags with a
    ``metadata.yaml``, and no message begins as Zstandard does."""
    try:
        if zstandard.frame_content_size(raw) > MOST_BYTES:
            raise InhandError("a message is larger than any camera's image")
        message: bytes = zstandard.ZstdDecompressor().decompress(raw, max_output_size=MOST_BYTES)
    except zstandard.ZstdError as error:
        raise InhandError(f"the bag is damaged: {error}") from None
    return message


def read_message(reader: AnyReader, connection: Connection, raw: bytes) -> Any:
    """Return a message, also an Image as RealSense writes it; raises InhandError."""
    if not reader.is2 and connection.msgtype == IMAGE:
        raw, _ = standard_image(raw)
    with explaining(f"{connection.topic} cannot be read"):
        return reader.deserialize(raw, connection.msgtype)


def first_message(reader: AnyReader, topic: str) -> Any:
    """Return the first message of a topic; None without any. Raises InhandError."""
    for connection, _, raw in messages_on(reader, topic):
        return read_message(reader, connection, raw)
    return None


def standard_image(raw: bytes) -> tuple[bytes, float]:
    """Return an Image of ROS 1 as ROS defines it, and the metres of a unit of depth after it.

    librealsense writes these four bytes more than the definition in its bags says, and `rosbags`
    refuses such messages. They are 0 where they are not written, as before 2021, and of what is no
    depth. What is no longer than the definition stays as it is.
    """
    try:
        place = _BEFORE_NAME.size
        place += _LENGTH.size + _LENGTH.unpack_from(raw, place)[0]
        place += _SIZE.size
        place += _LENGTH.size + _LENGTH.unpack_from(raw, place)[0]
        place += _STEP.size
        place += _LENGTH.size + _LENGTH.unpack_from(raw, place)[0]
    except struct.error:
        return raw, 0.0
    if len(raw) != place + _UNITS.size:
        return raw, 0.0
    return raw[:place], float(_UNITS.unpack_from(raw, place)[0])
