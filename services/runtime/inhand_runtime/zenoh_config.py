"""What Zenoh is told of a session: how long it waits, what it queues, and who it is."""

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import zenoh

from inhand_runtime.hub_access import read_password
from inhand_runtime.settings import ZenohSettings

CLIENT_TIMEOUT_MS = 3_000
HANDSHAKE_TIMEOUT_MS = 1_500
FOR_EVER_MS = -1
RETRY = {"period_init_ms": 100, "period_max_ms": 1000}
"""How soon a connection is tried again."""
LEASE_MS = 10_000
"""Milliseconds without a sign of life after which a link is closed, whatever waits for it."""
LONGEST_WAIT_US = 7_000_000
"""Microseconds that a frame waits for a link that takes nothing before the link is closed: who
stands still for less keeps it. Were it to wait at the end of the lease, closing the link would hold
a thread that sends."""
SIGNS_IN_A_LEASE = 10
"""Number of signs of life that are sent in that time."""
LONGEST_QUEUE = 16
"""Batches of 64 KiB that may wait for a link: some frames, or bursts of small messages, which share
batches, so that a busy moment drops none."""

SENDING_THREADS = 8
"""Number of Zenoh's threads that send: where a link to somebody who stands still is closed, one of
them waits for seconds for what a publisher still holds for that link, and with the single one that
Zenoh has by itself so does all else (seen with Zenoh 1.10.2)."""
_RUNTIME_VARIABLE = "ZENOH_RUNTIME"


def session_config(
    settings: ZenohSettings, listen: tuple[str, ...], connect: tuple[str, ...]
) -> zenoh.Config:
    """Zenoh's settings of a session that listens and connects there, by the credentials or the
    login of ``settings``."""
    client = settings.mode == "client"
    values: dict[str, Any] = {
        "mode": settings.mode,
        "listen/endpoints": list(listen),
        "connect/endpoints": list(connect),
        "connect/timeout_ms": CLIENT_TIMEOUT_MS if client else FOR_EVER_MS,
        "connect/exit_on_failure": client,
        "connect/retry": RETRY,
    }
    if settings.credentials is not None:
        values["transport/link/tls"] = {
            **_known_by(settings.credentials.authority),
            "connect_certificate": str(settings.credentials.certificate),
            "connect_private_key": str(settings.credentials.key),
            "enable_mtls": True,
        }
    if settings.login is not None:
        password = read_password(settings.login)
        values["transport/auth/usrpwd"] = {"user": settings.login.user, "password": password}
        values["transport/link/tls"] = _known_by(settings.login.authority)
    return zenoh_config(values)


def _known_by(authority: Path) -> dict[str, Any]:
    """Zenoh's settings of TLS by which a client knows its hub."""
    return {
        "root_ca_certificate": str(authority),
        "verify_name_on_connect": True,
        "close_link_on_expiration": True,
    }


def zenoh_config(values: Mapping[str, Any]) -> zenoh.Config:
    """Zenoh's settings of a session, with those that all sessions of ours have."""
    shared: dict[str, Any] = {
        "transport/unicast/open_timeout": HANDSHAKE_TIMEOUT_MS,
        "scouting/multicast/enabled": False,
        "transport/link/tx/lease": LEASE_MS,
        "transport/link/tx/keep_alive": SIGNS_IN_A_LEASE,
        "transport/link/tx/queue/congestion_control/block/wait_before_close": LONGEST_WAIT_US,
        "transport/link/tx/queue/size/data": LONGEST_QUEUE,
        "transport/link/tx/queue/size/data_low": LONGEST_QUEUE,
        "transport/link/tx/queue/size/real_time": LONGEST_QUEUE,
        "transport/shared_memory/enabled": False,
    }
    # Zenoh reads it once, when a process opens its first session.
    os.environ.setdefault(_RUNTIME_VARIABLE, f"(tx: (worker_threads: {SENDING_THREADS}))")
    config = zenoh.Config()
    for key, value in {**shared, **values}.items():
        config.insert_json5(key, json.dumps(value))
    return config
