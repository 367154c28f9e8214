"""What the recorder reads of a message, and how it shares its memory."""

import pytest
from inhand_recorder.service import queue_shares
from inhand_recorder.stamps import entry_of
from inhand_runtime.inbox import Received
from inhand_schemas.errors import KeyFormatError, MessageError, UnknownVersionError
from inhand_schemas.keys import Site
from inhand_schemas.messages import ColourImage, RgbdFrame
from inhand_schemas.topics import RGBD, TOPICS

KEY = RGBD.key(Site(), "front")
FRAME = RgbdFrame(sequence=7, time_ns=5, colour=ColourImage("jpeg", 64, 48, bytes(1000)))


def test_number_and_time_are_the_messages_own_and_the_bytes_stay_the_same_object() -> None:
    payload = RGBD.encode(FRAME)
    entry = entry_of(Received(KEY, payload, RGBD.encoding, received_ns=9))
    assert (entry.sequence, entry.captured_ns, entry.received_ns) == (7, 5, 9)
    assert entry.payload is payload
    assert not entry.kept


@pytest.mark.parametrize("payload", [b"", b"\xc1", b"\x80", b"\x93abc", b"\x91" * 100_000])
def test_what_is_no_message_raises_one_named_error(payload: bytes) -> None:
    with pytest.raises(MessageError, match="no valid RgbdFrame"):
        entry_of(Received(KEY, payload, RGBD.encoding, 0))


def test_another_version_is_told_with_the_mend() -> None:
    payload = RGBD.encode(FRAME)
    with pytest.raises(UnknownVersionError, match="update the older side"):
        entry_of(Received(KEY, payload, "application/msgpack;RgbdFrame.v2", 0))
    with pytest.raises(UnknownVersionError, match="update the older side"):
        entry_of(Received(KEY.replace("@v1", "@v2"), payload, RGBD.encoding, 0))


def test_a_foreign_key_is_refused() -> None:
    with pytest.raises(KeyFormatError):
        entry_of(Received("somebody/else", b"", RGBD.encoding, 0))


@pytest.mark.parametrize("streams", [tuple(TOPICS), ("rgbd",), ("pose", "skeletons")])
def test_all_streams_together_wait_in_no_more_than_the_queue(streams: tuple[str, ...]) -> None:
    shares = queue_shares(streams, 1 << 20)
    assert shares.keys() == set(streams)
    assert sum(shares.values()) <= 1 << 20
    assert min(shares.values()) > 0


def test_h264_is_not_for_the_wire() -> None:
    coded = RgbdFrame(sequence=7, time_ns=5, colour=ColourImage("h264", 64, 48, b"", 3))
    with pytest.raises(MessageError, match="not for the wire"):
        entry_of(Received(KEY, RGBD.encode(coded), RGBD.encoding, 0))
