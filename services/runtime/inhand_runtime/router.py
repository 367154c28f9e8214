"""A Zenoh router in this process: clients with certificates may do there what rules say."""

import contextlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import zenoh
from inhand_schemas.topics import Delivery

from inhand_runtime.errors import InhandError
from inhand_runtime.session import (
    CONGESTION,
    PRIORITIES,
    Session,
    closing_at_once,
    log_what_is_asked_for,
)
from inhand_runtime.zenoh_config import (
    FOR_EVER_MS,
    HANDSHAKE_TIMEOUT_MS,
    RETRY,
    zenoh_config,
)

LARGEST_MESSAGE_BYTES = 64 << 20
"""Bytes of a message, at the most, that a router puts together: no frame is as large."""


@dataclass(frozen=True)
class RouterSettings:
    """Where a router listens, the files (PEM) of its certificate, key and authority, Zenoh's access
    rules, and to which other routers it connects.

    Clients show certificates, or where there is a file of ``users`` a name and password of it.
    What comes on the keys of ``deliveries`` goes on as these say, whatever its sender wants: one
    who lets nothing be dropped would stop all others where one reader stands still.
    """

    listen: tuple[str, ...]
    certificate: Path
    key: Path
    authority: Path
    access_control: Mapping[str, Any]
    deliveries: Sequence[tuple[Delivery, Sequence[str]]]
    connect: tuple[str, ...] = ()
    users: Path | None = None


@contextlib.contextmanager
def open_router(settings: RouterSettings) -> Iterator[Session]:
    """Run a router, with a session of this process in it, until the block ends; raises InhandError.

    The session itself is bound by no rule.
    """
    log_what_is_asked_for()
    tls = {
        "root_ca_certificate": str(settings.authority),
        "listen_certificate": str(settings.certificate),
        "listen_private_key": str(settings.key),
        "connect_certificate": str(settings.certificate),
        "connect_private_key": str(settings.key),
        "enable_mtls": settings.users is None,
        "verify_name_on_connect": True,
        "close_link_on_expiration": True,
    }
    by_name = {} if settings.users is None else {"dictionary_file": str(settings.users)}
    config = zenoh_config(
        {
            "mode": "router",
            "listen/endpoints": list(settings.listen),
            "listen/exit_on_failure": True,
            "connect/endpoints": [f"{one}#enable_mtls=true" for one in settings.connect],
            "connect/timeout_ms": FOR_EVER_MS,
            "connect/exit_on_failure": False,
            "connect/retry": RETRY,
            "scouting/gossip/enabled": False,
            "adminspace/enabled": False,
            "transport/unicast/accept_timeout": HANDSHAKE_TIMEOUT_MS,
            "transport/link/protocols": ["tls"],
            "transport/link/tls": tls,
            "transport/auth/usrpwd": by_name,
            "transport/link/rx/max_message_size": LARGEST_MESSAGE_BYTES,
            "access_control": dict(settings.access_control),
            "qos/network": [
                _overwritten(number, delivery, keys)
                for number, (delivery, keys) in enumerate(settings.deliveries)
            ],
        }
    )
    try:
        session = zenoh.open(config)
    except zenoh.ZError:
        raise InhandError(
            f"cannot listen on {', '.join(settings.listen)}: the port is in use, or the address is "
            f"not of this machine; or {settings.certificate} and {settings.key} cannot be used"
        ) from None
    with session, closing_at_once(session):
        yield session


def _overwritten(number: int, delivery: Delivery, keys: Sequence[str]) -> dict[str, Any]:
    return {
        "id": f"delivery {number}",
        "messages": ["put", "delete", "query"],
        "key_exprs": list(keys),
        "flows": ["ingress"],
        "overwrite": {
            "priority": _setting(PRIORITIES[delivery.priority]),
            "congestion_control": _setting(CONGESTION[delivery.congestion]),
            "express": False,
        },
    }


def _setting(value: zenoh.Priority | zenoh.CongestionControl) -> str:
    """Return a value of Zenoh as its settings write it."""
    return str(value).rpartition(".")[2].lower()
