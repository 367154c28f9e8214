"""Zenoh as it comes, without this project's session: the reference that its delays are beside."""

import json
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from typing import Any

import zenoh

KEY = "raw/frame"

RawSession = zenoh.Session


def raw_session(
    address: str, *, listens: bool, shared_memory: bool
) -> AbstractContextManager[zenoh.Session]:
    """Open a peer that listens at an address, or connects to it, and has no other links."""
    return _opened(
        {
            "mode": "peer",
            "listen/endpoints": [address] if listens else [],
            "connect/endpoints": [] if listens else [address],
            "transport/shared_memory/enabled": shared_memory,
        }
    )


def raw_router(address: str) -> AbstractContextManager[zenoh.Session]:
    """Run a router that encrypts nothing and has no rules."""
    return _opened(
        {
            "mode": "router",
            "listen/endpoints": [address],
            "transport/shared_memory/enabled": False,
        }
    )


@contextmanager
def _opened(values: dict[str, Any]) -> Iterator[zenoh.Session]:
    config = zenoh.Config()
    for key, value in {**values, "scouting/multicast/enabled": False}.items():
        config.insert_json5(key, json.dumps(value))
    with zenoh.open(config) as session:
        yield session


class RawPublisher:
    """Puts bytes with Zenoh's usual settings."""

    def __init__(self, session: zenoh.Session) -> None:
        self._publisher = session.declare_publisher(KEY)

    def put(self, payload: bytes) -> None:
        """Send."""
        self._publisher.put(payload)

    def wanted(self) -> bool:
        """Whether anybody listens now."""
        status: Any = self._publisher.matching_status
        return bool(status.matching)


def subscribe_raw(
    session: zenoh.Session, on_payload: Callable[[bytes], None]
) -> zenoh.Subscriber[None]:
    """Call ``on_payload`` from Zenoh's thread with the bytes of each sample; keep the handle."""

    def receive(sample: zenoh.Sample) -> None:
        on_payload(sample.payload.to_bytes())

    return session.declare_subscriber(KEY, receive)
