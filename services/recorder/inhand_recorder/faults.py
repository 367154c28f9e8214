"""Names each message of a recording that is damaged, cut off, unchecked or left out."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from inhand_runtime.wording import counted
from mcap.records import Message

from inhand_recorder.clock import time_text
from inhand_recorder.scanning import Stretch

RECOVERY_RECORD = "recovery"
"""The name of the metadata record in which a recovered file says where it comes from."""
FAULTS_FIELD = "faults"
"""The field of that record with what its origin's faults cost, a line each."""

DAMAGED = "damaged, its checksum contradicts it"
CUT_OFF = "cut off"
UNCHECKED = "unchecked, no checksum covers it"
UNDECODABLE = "undecodable"
APART = "kept apart as undecodable"
FOREIGN = "under a key that is not Inhand's"


@dataclass(frozen=True)
class Fault:
    """What is wrong with one message; ``received_ns`` is since the epoch.

    Of a damaged message key, number and time are what its head says, which lies within its chunk's
    times; damage to the head itself can make them false.
    """

    key: str
    number: int
    received_ns: int
    what: str


class FaultLedger:
    """Collects what is wrong with messages, from stretches in the file's order."""

    def __init__(self, keys: Mapping[int, str]) -> None:
        self._keys = keys
        self._latest_ns = 0
        self._reasons: dict[tuple[str, str], str] = {}
        self.faults: list[Fault] = []
        self.places: list[str] = []

    def take(self, stretch: Stretch) -> None:
        """Take note of all that a stretch lost."""
        for records, what in ((stretch.broken, DAMAGED), (stretch.cut_off, CUT_OFF)):
            for record in records:
                if record.channel_id in self._keys:
                    self.note(record, what)
        if stretch.unread_bytes or (stretch.state == "cut" and stretch.expected):
            self.places.append(self._place(stretch))
        for one in (*stretch.records, *stretch.doubtful):
            if isinstance(one, Message):
                self._latest_ns = max(self._latest_ns, one.log_time)

    def note(self, record: Message, what: str, reason: str = "") -> None:
        """Take note of one message; of a key's messages of one fault the first reason stays."""
        key = self._keys.get(record.channel_id, f"channel {record.channel_id}")
        self.faults.append(Fault(key, record.sequence, record.log_time, what))
        self._reasons.setdefault((key, what), reason)

    def lines(self, *, kept: Sequence[str] = ()) -> list[str]:
        """Return a line for each place, and one for each key's messages of one fault.

        Where ``kept`` names the faults whose messages a recovered file keeps, each line says
        whether its messages are kept or left out.
        """
        grouped: dict[tuple[str, str], list[Fault]] = {}
        for fault in self.faults:
            grouped.setdefault((fault.key, fault.what), []).append(fault)
        lines = []
        for (key, what), faults in grouped.items():
            end = "" if not kept else ", kept" if what in kept else ", left out"
            reason = self._reasons[key, what]
            first = "" if not reason else f"; the first: {reason}" if faults[1:] else f"; {reason}"
            lines.append(f"{_named(key, faults)}: {what}{end}{first}")
        return self.places + lines

    def _place(self, stretch: Stretch) -> str:
        where = (
            "the file ends within the part that begins at byte"
            if stretch.state == "cut"
            else f"{counted(stretch.unread_bytes, 'byte')} cannot be read in the damaged part "
            "from byte"
        )
        where = f"{where} {stretch.offset}"
        known = [one for one in (*stretch.broken, *stretch.cut_off) if one.channel_id in self._keys]
        if stretch.expected is None:
            return f"{where}: how many messages it held is not known" + (
                f"; {counted(len(known), 'message')} can be named" if known else ""
            )
        read = sum(isinstance(record, Message) for record in stretch.records)
        lost, nameless = stretch.expected - read, stretch.expected - read - len(known)
        line = f"{where}: {lost:,} of its {counted(stretch.expected, 'message')} lost"
        if nameless <= 0:
            return line
        held = [one for one in stretch.records if isinstance(one, Message)]
        after_ns = max((one.log_time for one in held), default=self._latest_ns)
        after = (
            f", received after {time_text(after_ns)}" if stretch.state == "cut" and after_ns else ""
        )
        return f"{line}; {nameless:,} of these cannot be named{after}"


def _named(key: str, faults: Sequence[Fault]) -> str:
    first, last = faults[0].received_ns, faults[-1].received_ns
    if len(faults) == 1:
        return f"{key} number {faults[0].number}, received {time_text(first)}"
    numbers = ", ".join(_ranges([fault.number for fault in faults]))
    return (
        f"{key}: {counted(len(faults), 'message')}, numbers {numbers}, received from "
        f"{time_text(first)} to {time_text(last)}"
    )


def _ranges(numbers: Sequence[int]) -> Iterator[str]:
    """Each run of numbers as ``3`` or ``3-7``."""
    start = numbers[0]
    for before, number in pairwise((*numbers, None)):
        if number is None or before is None or number != before + 1:
            yield str(start) if start == before else f"{start}-{before}"
            start = number if number is not None else 0
