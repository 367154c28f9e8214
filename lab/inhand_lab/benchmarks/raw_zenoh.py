"""Zenoh as it comes, without this project's session: the reference that its delays are beside."""

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import zenoh

KEY = "raw/frame"

RawSession = zenoh.Session


@contextmanager
def raw_session(address: str, *, listens: bool, shared_memory: bool) -> Iterator[zenoh.Session]:
    """Open a peer that listens at an address, or connects to it, and has no other links."""
    config = zenoh.Config()
    values: dict[str, Any] = {
        "mode": "peer",
        "listen/endpoints": [address] if listens else [],
        "connect/endpoints": [] if listens else [address],
        "scouting/multicast/enabled": False,
        "transport/shared_memory/enabled": shared_memory,
    }
    for key, value in values.items():
        config.insert_json5(key, json.dumps(value))
    with zenoh.open(config) as session:
        yield session


@contextmanager
def raw_router(address: str) -> Iterator[zenoh.Session]:
    """Run a router that encrypts nothing and has no rules."""
    config = zenoh.Config()
    values: dict[str, Any] = {
        "mode": "router",
        "listen/endpoints": [address],
        "scouting/multicast/enabled": False,
        "transport/shared_memory/enabled": False,
    }
    for key, value in values.items():
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
