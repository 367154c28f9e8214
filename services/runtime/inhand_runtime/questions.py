"""Questions over Zenoh: asked on a key, answered by all who serve it."""

import logging
from collections.abc import Callable, Iterator

import zenoh

from inhand_runtime.errors import InhandError
from inhand_runtime.session import Session
from inhand_runtime.wording import printable

log = logging.getLogger(__name__)

TIMED_OUT = "Timeout"
"""What Zenoh itself replies in the name of one that did not in time."""

Question = zenoh.Queryable[None]
"""A handle: what is asked is answered as long as somebody keeps it."""


def answer(session: Session, key: str, on_request: Callable[[bytes], bytes | None]) -> Question:
    """Answer what is asked on a key, or on all of a pattern, from Zenoh's threads; keep the
    returned handle.

    ``on_request`` returns the reply, or None where the request is another's to answer; what it
    raises is logged, and answered as an error.
    """

    def receive(query: zenoh.Query) -> None:
        with query:
            request = b"" if query.payload is None else query.payload.to_bytes()
            try:
                reply = on_request(request)
            except Exception as error:
                log.exception("a request on %s failed", key)
                query.reply_err(str(error).encode())
                return
            if reply is not None:
                query.reply(query.key_expr if "*" in key else key, reply)

    return session.declare_queryable(key, receive)


def ask(
    session: Session, key: str, request: bytes, timeout_s: float
) -> Iterator[tuple[str, bytes]]:
    """Ask all who answer on a key, or on those of a pattern; their keys and replies as they come,
    until all have or time is up.

    Raises InhandError for one that answers with an error.
    """
    replies = session.get(
        key,
        payload=request,
        target=zenoh.QueryTarget.ALL,
        consolidation=zenoh.ConsolidationMode.NONE,
        timeout=timeout_s,
    )
    for reply in replies:
        if reply.ok is not None:
            yield str(reply.ok.key_expr), reply.ok.payload.to_bytes()
        elif reply.err is not None and (text := reply.err.payload.to_string()) != TIMED_OUT:
            raise InhandError(printable(f"{key}: {text}"))
