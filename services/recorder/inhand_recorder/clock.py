"""Steps of the wall clock while a recorder runs, as network time makes them."""

import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from datetime import UTC, datetime

CLOCK_RECORD = "clock_steps"
"""The name of the metadata record that a recording keeps its clock's steps in."""
SMALLEST_STEP_NS = 100_000_000
"""Nanoseconds by which the wall clock must leave the monotonic one to be called set."""


class ClockWatch:
    """Compares the wall clock with the monotonic one, which nobody sets."""

    def __init__(
        self,
        wall_ns: Callable[[], int] = time.time_ns,
        monotonic_ns: Callable[[], int] = time.monotonic_ns,
    ) -> None:
        self._wall_ns = wall_ns
        self._monotonic_ns = monotonic_ns
        self._offset_ns = self._offset()

    def step(self) -> tuple[int, int] | None:
        """When the clock was set since the last call, and by how much, in nanoseconds; or None."""
        offset_ns = self._offset()
        step_ns = offset_ns - self._offset_ns
        self._offset_ns = offset_ns
        return None if abs(step_ns) < SMALLEST_STEP_NS else (self._wall_ns(), step_ns)

    def _offset(self) -> int:
        return self._wall_ns() - self._monotonic_ns()


def time_text(time_ns: int) -> str:
    """A time of the wall clock, in nanoseconds since the epoch, as a person reads it (UTC)."""
    return datetime.fromtimestamp(time_ns / 1e9, UTC).isoformat(timespec="milliseconds")


def format_clock_steps(steps: Mapping[int, int]) -> dict[str, str]:
    """The values of the metadata record, from steps by the time at which they were seen."""
    return {str(at_ns): f"{step_ns:+d}" for at_ns, step_ns in steps.items()}


def parse_clock_steps(values: Mapping[str, str]) -> dict[int, int]:
    """What ``format_clock_steps`` wrote; what is damaged is left out."""
    steps = {}
    for at_ns, step_ns in values.items():
        with suppress(ValueError):
            steps[int(at_ns)] = int(step_ns)
    return steps
