"""Colour and depth of one moment brought together."""

from dataclasses import dataclass
from typing import Generic, Protocol, TypeVar

from inhand_capture.sources.oak.parameters import OAK


class Stamped(Protocol):
    """A frame with the device's number and time."""

    @property
    def number(self) -> int:
        """The device's sequence number."""

    @property
    def device_ns(self) -> int:
        """When it was captured by the device's clock, nanoseconds."""


C = TypeVar("C", bound=Stamped)
D = TypeVar("D", bound=Stamped)
S = TypeVar("S", bound=Stamped)


@dataclass(frozen=True)
class Pair(Generic[C, D]):
    """A moment's colour and depth."""

    colour: C
    depth: D


class Pairing(Generic[C, D]):
    """Pairs frames of the same sequence number whose times agree to half a frame.

    Sensors that start one after the other number their frames differently: where times contradict
    the numbers, or no numbers ever meet, the difference is learned from the times.
    """

    def __init__(self, frame_rate: float) -> None:
        self._apart_ns = OAK.farthest_frames * 1e9 / frame_rate
        self._colour: dict[int, C] = {}
        self._depth: dict[int, D] = {}
        self._ahead = 0  # how far depth's numbers are ahead of colour's

    def colour(self, frame: C) -> Pair[C, D] | None:
        """Take a frame of colour; return the moment that it completes."""
        _add(self._colour, frame)
        partner = self._depth.get(frame.number + self._ahead)
        if partner is None or not self._agree(frame, partner):
            partner = self._nearest(frame, self._depth, contradicted=partner is not None)
        return None if partner is None else self._complete(frame, partner)

    def depth(self, frame: D) -> Pair[C, D] | None:
        """Take a frame of depth; return the moment that it completes."""
        _add(self._depth, frame)
        partner = self._colour.get(frame.number - self._ahead)
        if partner is None or not self._agree(frame, partner):
            partner = self._nearest(frame, self._colour, contradicted=partner is not None)
        return None if partner is None else self._complete(partner, frame)

    def _agree(self, one: Stamped, other: Stamped) -> bool:
        return abs(one.device_ns - other.device_ns) <= self._apart_ns

    def _nearest(self, frame: Stamped, others: dict[int, S], *, contradicted: bool) -> S | None:
        """Return the other frame of this time, where numbers do not say which it is."""
        if not contradicted and len(others) < OAK.waiting_frames:
            return None
        near = [other for other in others.values() if self._agree(frame, other)]
        return min(near, key=lambda other: abs(frame.device_ns - other.device_ns), default=None)

    def _complete(self, colour: C, depth: D) -> Pair[C, D]:
        self._ahead = depth.number - colour.number
        _forget_up_to(self._colour, colour)
        _forget_up_to(self._depth, depth)
        return Pair(colour, depth)


def _add(waiting: dict[int, S], frame: S) -> None:
    if waiting and frame.number <= next(reversed(waiting)):
        waiting.clear()  # the device numbers anew
    waiting[frame.number] = frame
    while len(waiting) > OAK.waiting_frames:
        del waiting[next(iter(waiting))]


def _forget_up_to(waiting: dict[int, S], frame: Stamped) -> None:
    for number in [number for number in waiting if number <= frame.number]:
        del waiting[number]
