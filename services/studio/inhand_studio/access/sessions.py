"""Browsers that have given the password."""

import secrets
import time
from collections.abc import Callable

from inhand_studio.access.parameters import DEFAULT_GATE, GateParameters


class Sessions:
    """Remembers browsers by a token that nobody can guess, until it is too old."""

    def __init__(
        self,
        parameters: GateParameters = DEFAULT_GATE,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._parameters = parameters
        self._clock = clock
        self._ends: dict[str, float] = {}

    def begin(self) -> str:
        """Return the token of a new session."""
        self._forget_old()
        token = secrets.token_urlsafe(32)
        self._ends[token] = self._clock() + self._parameters.session_s
        return token

    def knows(self, token: str | None) -> bool:
        """Whether a token is of a session that has not ended."""
        return token is not None and self._ends.get(token, 0.0) > self._clock()

    def _forget_old(self) -> None:
        now = self._clock()
        kept = [(token, end) for token, end in self._ends.items() if end > now]
        self._ends = dict(kept[-(self._parameters.most_sessions - 1) :])
