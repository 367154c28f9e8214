"""The checksum of each message of a recording."""

import base64
import hashlib
import struct

import pytest
from inhand_runtime.recording.checksums import (
    digest,
    format_checksums,
    parse_channels,
    parse_checksums,
)

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
    digests = [digest(*STAMP, PAYLOAD), digest(*STAMP, b"")]
    checksums = parse_checksums(format_checksums(digests, {}))
    assert checksums.count == 2
    assert checksums.holds(*STAMP, PAYLOAD)
    assert checksums.holds(*STAMP, b"")
    assert not checksums.holds(4, 7, 1_000, 2_000, PAYLOAD)


def test_a_channel_is_known_by_its_record_unless_that_was_damaged() -> None:
    channels = {3: ("inhand/@v1/rig/pose/mug", "msgpack"), 4: ("a key", "x-undecodable")}
    values = format_checksums([], channels)
    assert parse_channels(values) == channels
    damaged = {name: value.replace("rig", "ric") for name, value in values.items()}
    assert parse_channels(damaged) == {4: ("a key", "x-undecodable")}


@pytest.mark.parametrize("values", [{}, {"xxh3_64": "no base64"}, {"md5": "AAAA"}])
def test_a_damaged_or_unknown_record_says_nothing(values: dict[str, str]) -> None:
    assert not parse_checksums(values)
