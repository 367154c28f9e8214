"""Recordings: MCAP files with the very messages that the wire carries.

A recording grows as ``NAME.mcap.part`` and gets its final name when it is whole, so the name
says whether a file may be trusted. Its channels are Zenoh keys, its payloads MessagePack.
"""

from inhand_runtime.recording.layout import (
    APART_ENCODING,
    DAMAGE,
    MESSAGE_ENCODING,
    SEQUENCE_MASK,
    RecordedMessage,
    RecordingError,
)
from inhand_runtime.recording.reading import read_metadata, read_recording
from inhand_runtime.recording.writing import RecordingWriter

__all__ = [
    "APART_ENCODING",
    "DAMAGE",
    "MESSAGE_ENCODING",
    "SEQUENCE_MASK",
    "RecordedMessage",
    "RecordingError",
    "RecordingWriter",
    "read_metadata",
    "read_recording",
]
