"""Losses per key, from the numbers that messages carry."""

import re
from collections.abc import Mapping
from dataclasses import dataclass

from inhand_runtime.recording import SEQUENCE_MASK

LOSSES_RECORD = "losses"
"""The name of the metadata record that a recording keeps its losses in."""

_FORMAT = re.compile(
    r"received=(\d+) lost=(\d+) restarts=(\d+) dropped=(\d+)(?: unwritten=(\d+))?(?: before=(\d+))?"
)


@dataclass(frozen=True)
class Losses:
    """What came of one key and what did not.

    ``lost`` counts the numbers that are missing; ``dropped`` those among them that reached this
    process and found its queue full, and ``unwritten`` those among the dropped that came while the
    disk took nothing; ``restarts`` how often a publisher began anew. ``before`` are numbers that
    are missing between the recorder's former file and the first one here.
    """

    received: int = 0
    lost: int = 0
    restarts: int = 0
    dropped: int = 0
    unwritten: int = 0
    before: int = 0


@dataclass
class _Count:
    """What came of one key so far, and what did not."""

    latest: int
    received: int = 1
    lost: int = 0
    restarts: int = 0
    before: int = 0


class LossCounter:
    """Counts one recording's losses, each key from the first message seen on.

    A gap forward is lost messages. A jump back is a restarted publisher or a looped replay, and
    loses nothing. A repeated number is a duplicate and not counted at all. Numbers are compared
    in the 32 bits that a recording keeps, so that a count from the file agrees.
    """

    def __init__(self, former: Mapping[str, int] | None = None) -> None:
        """``former`` are the latest numbers in the recorder's former file, by key."""
        self._former = former or {}
        self._counts: dict[str, _Count] = {}

    def count(self, key: str, sequence: int) -> None:
        """Take note of one message."""
        sequence &= SEQUENCE_MASK
        count = self._counts.get(key)
        if count is None:
            missing = sequence - self._former.get(key, sequence) - 1
            self._counts[key] = _Count(sequence, before=max(missing, 0))
            return
        step = sequence - count.latest
        if step == 0:
            return
        count.latest = sequence
        count.received += 1
        if step < 0:
            count.restarts += 1
        else:
            count.lost += step - 1

    @property
    def latest(self) -> Mapping[str, int]:
        """The latest number by key."""
        return {key: count.latest for key, count in self._counts.items()}

    def losses(
        self,
        dropped: Mapping[str, int] | None = None,
        unwritten: Mapping[str, int] | None = None,
    ) -> dict[str, Losses]:
        """The count so far by key, with the drops that the queue counted by key, and those among
        them for which the disk was to blame."""
        dropped, unwritten = dropped or {}, unwritten or {}
        losses = {}
        for key in sorted(self._counts.keys() | dropped.keys()):
            count = self._counts.get(key, _Count(0, received=0))
            losses[key] = Losses(
                received=count.received,
                lost=count.lost,
                restarts=count.restarts,
                dropped=dropped.get(key, 0),
                unwritten=unwritten.get(key, 0),
                before=count.before,
            )
        return losses


def format_losses(losses: Mapping[str, Losses]) -> dict[str, str]:
    """The values of the metadata record ``losses``."""
    return {
        key: f"received={one.received} lost={one.lost} "
        f"restarts={one.restarts} dropped={one.dropped}"
        + (f" unwritten={one.unwritten}" if one.unwritten else "")
        + (f" before={one.before}" if one.before else "")
        for key, one in losses.items()
    }


def parse_losses(values: Mapping[str, str]) -> dict[str, Losses]:
    """What ``format_losses`` wrote; raises ValueError."""
    return {key: _parse(key, value) for key, value in values.items()}


def _parse(key: str, value: str) -> Losses:
    match = _FORMAT.fullmatch(value)
    if match is None:
        raise ValueError(f"the losses of {key} are written as {value!r}")
    return Losses(*(int(number or 0) for number in match.groups()))
