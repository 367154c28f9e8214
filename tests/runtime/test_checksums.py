"""The checksum of each message of a recording."""

import base64
import hashlib
import struct

import pytest
from inhand_runtime.recording.checksums import digest, format_digests, parse_checksums

STAMP = (3, 7, 1_000, 2_000)
PAYLOAD = b"a payload"


def test_messages_of_release_0_1_0_prove_themselves_by_blake2b() -> None:
    stood = PAYLOAD + struct.pack("<HIQQ", *STAMP)
    written = hashlib.blake2b(stood, digest_size=8).digest()
    checksums = parse_checksums({"blake2b_64": base64.b64encode(written).decode()})
    assert checksums.count == 1
    assert checksums.holds(*STAMP, PAYLOAD)
    assert not checksums.holds(*STAMP, b"b payload")


def test_what_is_written_holds_for_each_message_and_for_no_other() -> None:
    checksums = parse_checksums(format_digests([digest(*STAMP, PAYLOAD), digest(*STAMP, b"")]))
    assert checksums.count == 2
    assert checksums.holds(*STAMP, PAYLOAD)
    assert checksums.holds(*STAMP, b"")
    assert not checksums.holds(4, 7, 1_000, 2_000, PAYLOAD)


@pytest.mark.parametrize("values", [{}, {"xxh3_64": "no base64"}, {"md5": "AAAA"}])
def test_a_damaged_or_unknown_record_says_nothing(values: dict[str, str]) -> None:
    assert not parse_checksums(values)
