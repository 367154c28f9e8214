"""One instance a name: of two that want the same, one starts and the other ends with a clear line.

A process cannot ask whether a name is free the moment its session opens: it is not yet connected to
all others then. So it shows a token, its claim, and asks again and again until no new link has
come for a while. Each claims before it asks, so of two that are connected one at least sees the
other. Whoever is up already stays; of two that start, the older claim does.

Two that could not reach each other for so long are both up when they meet, and the younger ends.
"""

import contextlib
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor

from inhand_schemas.errors import KeyFormatError
from inhand_schemas.keys import Site, parse_claim

from inhand_runtime.errors import InhandError
from inhand_runtime.session import (
    Session,
    connected,
    session_id,
    shown,
    tokens,
    watch_tokens,
)

QUIET_S = 0.5
"""Seconds without a new link after which a process is taken to be connected to all others."""
QUIET_ALONE_S = 1.5
"""The same where there is no link at all: when the holder of the meeting address has died, the
others look for a new one once a second."""
LONGEST_WAIT_S = 5.0
"""Seconds after which a process starts even though links still come and go."""
POLL_S = 0.05

STARTING, UP = "starting", "up"


class Elders:
    """The other processes that are up under one's name and claimed it earlier; thread-safe."""

    def __init__(self, claim: str) -> None:
        self._claim = claim
        self._lock = threading.Lock()
        self._now: set[str] = set()
        self._before: set[str] = set()

    def change(self, key: str, is_shown: bool) -> None:
        """Take note of the token of a claim."""
        with contextlib.suppress(KeyFormatError):  # a foreign program's token is nobody of ours
            claim = parse_claim(key)
            with self._lock:
                if is_shown and claim < self._claim:
                    self._now.add(claim)
                else:
                    self._now.discard(claim)

    def stayed(self) -> bool:
        """Whether one of them was there at the last call as well: a lost link's ghost is not."""
        with self._lock:
            stayed = bool(self._now & self._before)
            self._before = set(self._now)
        return stayed


@contextlib.contextmanager
def claimed_name(
    session: Session,
    site: Site,
    service: str,
    instance: str,
    stop: threading.Event,
    meanwhile: Callable[[], object],
) -> Iterator[Elders]:
    """Hold the name of an instance, and announce it, until the block ends.

    Raises InhandError when another has it, or what ``meanwhile`` raises. It takes half a second,
    and 1.5 s for the first process of a rig, in which ``meanwhile`` works; ``stop`` ends the wait.
    """
    claim = f"{time.time_ns():020d}_{session_id(session)}"
    elders = Elders(claim)
    with contextlib.ExitStack() as held:
        with shown(session, site.claim_key(service, instance, STARTING, claim)):
            with ThreadPoolExecutor(1, "claim") as executor:
                free = executor.submit(_is_free, session, site, service, instance, claim, stop)
                meanwhile()
            if not free.result():
                raise InhandError(
                    f"{service} {instance} runs already in rig {site.rig!r} of realm "
                    f"{site.realm!r}: stop it first, or give this one another name"
                )
            held.enter_context(shown(session, site.claim_key(service, instance, UP, claim)))
        held.enter_context(shown(session, site.live_key(service, instance)))
        handle = watch_tokens(session, site.claim_pattern(service, instance, UP), elders.change)
        yield elders
        del handle


def _is_free(
    session: Session, site: Site, service: str, instance: str, claim: str, stop: threading.Event
) -> bool:
    """Ask until all links have come; False as soon as somebody is up, or has an older claim."""
    begin = last_change = time.monotonic()
    known = connected(session)
    while True:
        now, others = time.monotonic(), connected(session)
        if others != known:
            known, last_change = others, now
        quiet = now - last_change >= (QUIET_S if known else QUIET_ALONE_S)
        settled = quiet or now - begin >= LONGEST_WAIT_S or stop.is_set()
        if tokens(session, site.live_key(service, instance)):
            return False
        starting = tokens(session, site.claim_pattern(service, instance, STARTING))
        if any(_claim_of(key) < claim for key in starting):
            return False
        if settled:
            return True
        stop.wait(POLL_S)


def _claim_of(key: str) -> str:
    try:
        return parse_claim(key)
    except KeyFormatError:  # a foreign program's token gives way to each of ours
        return "~"
