"""A checksum a message, so that what is left of a damaged or cut chunk can still be trusted.

A recording's chunks have a checksum each, which one changed byte spoils for all messages in it, and
which says nothing of a chunk that was cut off. So before each chunk stands a metadata record named
``checksums`` with eight bytes of XXH3 of each message in it; those of release
0.1.0 have BLAKE2b, which takes ten times as long. It names the channels of these messages too, each
with a checksum, so that no damage lends a message to another key. Other readers pass it over.
"""

import base64
import binascii
import hashlib
import struct
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import xxhash

CHECKSUMS_RECORD = "checksums"
DIGEST_BYTES = 8
_STAMP = struct.Struct("<HIQQ")


@dataclass(frozen=True)
class Checksums:
    """The checksums of some messages, and the hash function that they are of."""

    algorithm: str
    digests: frozenset[bytes]
    count: int

    def __bool__(self) -> bool:
        return self.count > 0

    def holds(
        self, channel: int, sequence: int, log_time: int, publish_time: int, payload: bytes
    ) -> bool:
        """Whether a message as it stands in the file is one of them."""
        stamp = channel, sequence, log_time, publish_time
        return _digest(self.algorithm, stamp, payload) in self.digests


def _blake2b(payload: bytes) -> Any:
    return hashlib.blake2b(payload, digest_size=DIGEST_BYTES)


_WRITTEN = "xxh3_64"
_CHANNEL = "channel "
_ALGORITHMS: dict[str, Callable[[bytes], Any]] = {
    _WRITTEN: xxhash.xxh3_64,
    "blake2b_64": _blake2b,
}
NO_CHECKSUMS = Checksums(_WRITTEN, frozenset(), 0)


def digest(channel: int, sequence: int, log_time: int, publish_time: int, payload: bytes) -> bytes:
    """The checksum of one message as it is written, its channel and times included."""
    return _digest(_WRITTEN, (channel, sequence, log_time, publish_time), payload)


def _digest(algorithm: str, stamp: tuple[int, int, int, int], payload: bytes) -> bytes:
    hashed = _ALGORITHMS[algorithm](payload)
    hashed.update(_STAMP.pack(*stamp))
    digest: bytes = hashed.digest()
    return digest


def format_checksums(
    digests: Iterable[bytes], channels: Mapping[int, tuple[str, str]]
) -> dict[str, str]:
    """The values of the metadata record: the messages' checksums, and key and message encoding of
    each of their channels by its number."""
    values = {_WRITTEN: base64.b64encode(b"".join(digests)).decode()}
    for number, (key, encoding) in channels.items():
        named = f"{encoding} {key}"
        values[f"{_CHANNEL}{number}"] = f"{_proof(number, named)} {named}"
    return values


def _proof(number: int, named: str) -> str:
    return xxhash.xxh3_64_hexdigest(f"{number} {named}".encode())


def parse_channels(values: Mapping[str, str]) -> dict[int, tuple[str, str]]:
    """Return key and message encoding by the channel's number, of those whose checksum holds."""
    channels = {}
    for name, value in values.items():
        number = name.removeprefix(_CHANNEL)
        proof, _, named = value.partition(" ")
        if number.isdecimal() and number.isascii() and proof == _proof(int(number), named):
            encoding, _, key = named.partition(" ")
            channels[int(number)] = key, encoding
    return channels


def parse_checksums(values: Mapping[str, str]) -> Checksums:
    """Return what the record says; nothing where it is damaged or of an unknown algorithm."""
    for algorithm in _ALGORITHMS.keys() & values:
        try:
            joined = base64.b64decode(values[algorithm], validate=True)
        except (binascii.Error, ValueError):
            continue
        starts = range(0, len(joined), DIGEST_BYTES)
        digests = frozenset(joined[start : start + DIGEST_BYTES] for start in starts)
        return Checksums(algorithm, digests, len(starts))
    return NO_CHECKSUMS
