"""A checksum a message, so that what is left of a damaged or cut chunk can still be trusted.

A recording's chunks have a checksum each, which one changed byte spoils for all messages in it, and
which says nothing of a chunk that was cut off. So before each chunk stands a metadata record named
``checksums`` with eight bytes of BLAKE2b of each message in it. Other readers pass it over.
"""

import base64
import binascii
import hashlib
import struct
from collections.abc import Iterable, Mapping

CHECKSUMS_RECORD = "checksums"
DIGEST_BYTES = 8
_ALGORITHM = "blake2b_64"
_STAMP = struct.Struct("<HIQQ")


def digest(channel: int, sequence: int, log_time: int, publish_time: int, payload: bytes) -> bytes:
    """The checksum of one message as it stands in the file, its channel and times included."""
    hashed = hashlib.blake2b(payload, digest_size=DIGEST_BYTES)
    hashed.update(_STAMP.pack(channel, sequence, log_time, publish_time))
    return hashed.digest()


def format_digests(digests: Iterable[bytes]) -> dict[str, str]:
    """The values of the metadata record."""
    return {_ALGORITHM: base64.b64encode(b"".join(digests)).decode()}


def parse_digests(values: Mapping[str, str]) -> tuple[bytes, ...]:
    """What ``format_digests`` wrote; empty where it is damaged or of another algorithm."""
    try:
        joined = base64.b64decode(values.get(_ALGORITHM, ""), validate=True)
    except (binascii.Error, ValueError):
        return ()
    return tuple(
        joined[start : start + DIGEST_BYTES] for start in range(0, len(joined), DIGEST_BYTES)
    )
