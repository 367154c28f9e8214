"""A checksum a message, so that what is left of a damaged or cut chunk can still be trusted.

A recording's chunks have a checksum each, which one changed byte spoils for all messages in it, and
which says nothing of a chunk that was cut off. So before each chunk stands a metadata record named
``checksums`` with eight bytes of XXH3 of each message in it; those of release
0.1.0 have BLAKE2b, which takes ten times as long. Other readers pass it over.
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
        hashed = _ALGORITHMS[self.algorithm](payload)
        hashed.update(_STAMP.pack(channel, sequence, log_time, publish_time))
        return hashed.digest() in self.digests


def _blake2b(payload: bytes) -> Any:
    return hashlib.blake2b(payload, digest_size=DIGEST_BYTES)


_WRITTEN = "xxh3_64"
_ALGORITHMS: dict[str, Callable[[bytes], Any]] = {
    _WRITTEN: xxhash.xxh3_64,
    "blake2b_64": _blake2b,
}
NO_CHECKSUMS = Checksums(_WRITTEN, frozenset(), 0)


def digest(channel: int, sequence: int, log_time: int, publish_time: int, payload: bytes) -> bytes:
    """The checksum of one message as it is written, its channel and times included."""
    hashed = xxhash.xxh3_64(payload)
    hashed.update(_STAMP.pack(channel, sequence, log_time, publish_time))
    return hashed.digest()


def format_digests(digests: Iterable[bytes]) -> dict[str, str]:
    """The values of the metadata record."""
    return {_WRITTEN: base64.b64encode(b"".join(digests)).decode()}


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
