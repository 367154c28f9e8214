"""Whether a hub's rules know an instance: what they do not know they drop without a word."""

import threading
import time

from inhand_runtime.errors import InhandError
from inhand_runtime.questions import ask
from inhand_runtime.session import Session
from inhand_runtime.settings import Section, Settings, ZenohSettings

WITHIN_S = 3.0
"""Seconds in which a hub answers an instance that it knows: the hub may just have started."""
REPLY_S, POLL_S = 1.0, 0.1


def _shown(settings: ZenohSettings) -> str:
    if settings.login is not None:
        return f"the user {settings.login.user}"
    return f"the certificate {settings.certificate}"


def require_known(
    session: Session, settings: Settings[Section], service: str, stop: threading.Event
) -> None:
    """Ask the hub until it answers on the key of this instance alone, or ``stop`` is set.

    Raises InhandError when it does not.
    """
    site, key = settings.site, settings.site.access_key(service, settings.instance)
    end = time.monotonic() + WITHIN_S
    while not (stop.is_set() or any(True for _ in ask(session, key, b"", REPLY_S))):
        if time.monotonic() > end:
            raise InhandError(
                f"the hub at {', '.join(settings.zenoh.connect)} lets "
                f"{_shown(settings.zenoh)} do nothing as {service} {settings.instance} of rig "
                f"{site.rig!r}, realm {site.realm!r}: it was revoked, or is of another role, name, "
                "rig or realm; `inhand hub add` says what to write"
            )
        stop.wait(POLL_S)
