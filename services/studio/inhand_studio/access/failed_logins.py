"""Counts failed logins, and makes who fails too often wait."""

import ipaddress
import time
from collections import deque
from collections.abc import Callable

from inhand_studio.access.parameters import DEFAULT_GATE, GateParameters

IPV6_NETWORK_BITS = 64
"""Bits of an IPv6 address that its owner cannot choose: the others are one caller."""


class FailedLogins:
    """Remembers the failed logins of the last window, by address."""

    def __init__(
        self,
        parameters: GateParameters = DEFAULT_GATE,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.total = 0
        self._parameters = parameters
        self._clock = clock
        self._recent: deque[tuple[float, str]] = deque()

    def wait_s(self, address: str | None) -> float:
        """Return the seconds until the address may try again, 0 where it may now."""
        now = self._clock()
        while self._recent and self._recent[0][0] <= now - self._parameters.window_s:
            self._recent.popleft()
        caller = _caller(address)
        own = [when for when, whose in self._recent if whose == caller]
        ends = []
        for times, most in (
            (own, self._parameters.failures_an_address),
            ([when for when, _ in self._recent], self._parameters.failures_in_all),
        ):
            if len(times) >= most:
                ends.append(times[-most] + self._parameters.window_s)
        return max((end - now for end in ends), default=0.0)

    def note(self, address: str | None) -> None:
        """Count a failed login; to be called only where ``wait_s`` was 0, so few are kept."""
        self.total += 1
        self._recent.append((self._clock(), _caller(address)))


def _caller(address: str | None) -> str:
    """Return what all addresses that one caller can choose have in common."""
    try:
        parsed = ipaddress.ip_address((address or "").partition("%")[0])
    except ValueError:
        return "unknown"
    if isinstance(parsed, ipaddress.IPv6Address):
        if parsed.ipv4_mapped is not None:
            return str(parsed.ipv4_mapped)
        return str(ipaddress.ip_network((parsed, IPV6_NETWORK_BITS), strict=False))
    return str(parsed)
