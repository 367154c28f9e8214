"""Questions between two sessions."""

from collections.abc import Iterator
from typing import Any

import msgspec
import pytest
from inhand_runtime.errors import InhandError
from inhand_runtime.questions import answer, ask
from inhand_runtime.session import Session, connected, open_session
from inhand_runtime.settings import ZenohSettings
from inhand_schemas.errors import MessageError
from inhand_schemas.keys import Site
from inhand_schemas.procedure import Procedure
from inhand_schemas.procedures import (
    PROCEDURES,
    SHUTTER,
    ShutterReply,
    ShutterRequest,
)
from running_rig import RunningRig, eventually

KEY = SHUTTER.key(Site(), "front")


@pytest.fixture
def two(rig: RunningRig) -> Iterator[tuple[Session, Session]]:
    """Two sessions that are connected."""
    settings = ZenohSettings(meeting=rig.meeting)
    with open_session(settings) as one, open_session(settings) as other:
        eventually("a connection", lambda: connected(one) and connected(other))
        yield one, other


def _replies(session: Session, request: bytes) -> list[bytes]:
    return [reply for _, reply in ask(session, KEY, request, 5.0)]


def test_all_who_answer_are_heard(two: tuple[Session, Session]) -> None:
    one, other = two
    handles = [
        answer(session, KEY, lambda data, who=who: who + data)
        for session, who in ((one, b"one "), (other, b"other "))
    ]
    eventually("both", lambda: sorted(_replies(one, b"?")) == [b"one ?", b"other ?"])
    del handles


def test_whom_it_does_not_concern_says_nothing(two: tuple[Session, Session]) -> None:
    one, other = two
    heard: list[bytes] = []

    def ignore(data: bytes) -> None:
        heard.append(data)

    handle = answer(other, KEY, ignore)
    eventually("the question", lambda: _replies(one, b"?") == [] and heard)
    del handle


def test_one_that_fails_is_told_with_its_reason(two: tuple[Session, Session]) -> None:
    one, other = two

    def fail(_data: bytes) -> bytes:
        raise ValueError("the motor is stuck")

    handle = answer(other, KEY, fail)

    def told() -> str:
        try:
            return "".join(map(str, _replies(one, b"?")))
        except InhandError as error:
            return str(error)

    assert "the motor is stuck" in eventually("the failure", told)
    del handle


def test_requests_and_replies_are_plain_messagepack_maps() -> None:
    request = ShutterRequest(closed=True)
    assert SHUTTER.request(SHUTTER.encode(request)) == request
    reply = ShutterReply(camera="front", closed=True, problem="no disk")
    assert SHUTTER.reply(KEY, SHUTTER.encode(reply)) == reply
    assert KEY == "inhand/@v1/rig/@rpc/capture/shutter/front"
    with pytest.raises(MessageError, match="no valid ShutterRequest"):
        SHUTTER.request(b"\x93\x01\x02\x03")


@pytest.mark.parametrize("procedure", PROCEDURES, ids=lambda one: one.verb)
def test_nobody_replies_in_the_name_of_another(procedure: Procedure[Any, Any]) -> None:
    others = {"closed": True, "objects": (), "camera": "side", "sequence": 1, "time_ns": 1}
    others |= {"recording": {}, "paused": True}
    reply = msgspec.convert({**others, procedure.named: "back"}, procedure.reply_type)
    assert procedure.reply(procedure.key(Site(), "back"), procedure.encode(reply)) == reply
    with pytest.raises(MessageError, match="in the name of 'back'"):
        procedure.reply(procedure.key(Site(), "front"), procedure.encode(reply))
