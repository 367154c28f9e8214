"""The messages of one topic, found by number and by time of capture."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol, overload

import numpy as np
from inhand_runtime.recording import RecordedMessage
from inhand_runtime.recording.chunk_table import Integers

from inhand_recorder.recorded import Recorded


@dataclass(frozen=True)
class Places:
    """Where N messages of a key are: the numbers of their files and their numbers therein, and
    their times of reception in nanoseconds, each (N,)."""

    files: Integers
    numbers: Integers
    received_ns: Integers

    def chosen(self, which: Integers) -> "Places":
        """Return those with the numbers (M,)."""
        return Places(self.files[which], self.numbers[which], self.received_ns[which])

    def rows(self) -> Iterator[tuple[int, int, int]]:
        """Yield the three numbers of each message."""
        columns = (self.files, self.numbers, self.received_ns)
        yield from zip(*(one.tolist() for one in columns), strict=True)


class SeriesSource(Protocol):
    """Reads what a series consists of, by key, number of the file, and number in that."""

    def read_at(self, key: str, file: int, number: int) -> RecordedMessage:
        """Read a message; raises RecordingError."""

    def decode(self, message: RecordedMessage) -> Recorded:
        """Decode a message; raises MessageError."""

    def decoded_at(self, key: str, file: int, number: int) -> Recorded | None:
        """Read and decode a message; None, and counted, where it is damaged."""

    def captured_ns(self, key: str, places: Places) -> Integers:
        """Read the times of capture of messages; raises RecordingError."""


class Series(Sequence[Recorded]):
    """The N messages of one topic in the order of their reception.

    ``series[number]`` reads a message, and a slice is a series. A loop passes over damaged messages
    and counts them in the recording's ``damaged``; what is asked for by number or time raises
    RecordingError or MessageError where it is damaged.
    """

    def __init__(self, source: SeriesSource, key: str, topic: str, places: Places) -> None:
        self.key, self.topic = key, topic
        self._source, self.places = source, places

    def __len__(self) -> int:
        return len(self.places.numbers)

    def __iter__(self) -> Iterator[Recorded]:
        for file, number, _ in self.places.rows():
            message = self._source.decoded_at(self.key, file, number)
            if message is not None:
                yield message

    @overload
    def __getitem__(self, number: int) -> Recorded: ...
    @overload
    def __getitem__(self, number: slice) -> "Series": ...
    def __getitem__(self, number: "int | slice") -> "Recorded | Series":
        if isinstance(number, slice):
            return self._chosen(np.arange(*number.indices(len(self))))
        if not -len(self) <= number < len(self):
            raise IndexError(f"{self.topic} has {len(self)} messages, and none of number {number}")
        places = self.places
        message = self._source.read_at(
            self.key, int(places.files[number]), int(places.numbers[number])
        )
        return self._source.decode(message)

    @property
    def received_ns(self) -> Integers:
        """Times of reception (N,) in nanoseconds since the epoch."""
        return self.places.received_ns

    @cached_property
    def times_ns(self) -> Integers:
        """Times of capture (N,) in nanoseconds since the epoch, read without the payloads."""
        return self._source.captured_ns(self.key, self.places)

    def nearest(self, time_ns: int, within_ns: int | None = None) -> Recorded | None:
        """Return the message that was captured nearest to a time; None where none was within
        ``within_ns`` nanoseconds of it, or where there is none at all."""
        if not len(self):
            return None
        times_ns = self.times_ns
        if self._sorted:
            place = int(np.searchsorted(times_ns, time_ns))
            around = times_ns[max(place - 1, 0) : place + 1]
            number = max(place - 1, 0) + int(np.argmin(np.abs(around - time_ns)))
        else:
            number = int(np.argmin(np.abs(times_ns - time_ns)))
        if within_ns is not None and abs(int(times_ns[number]) - time_ns) > within_ns:
            return None
        return self[number]

    def latest(self, time_ns: int) -> Recorded | None:
        """Return the message that was captured last until a time; None where none was."""
        if self._sorted:
            number = int(np.searchsorted(self.times_ns, time_ns, side="right")) - 1
            return self[number] if number >= 0 else None
        before = np.flatnonzero(self.times_ns <= time_ns)
        return self[int(before[np.argmax(self.times_ns[before])])] if len(before) else None

    @cached_property
    def _sorted(self) -> bool:
        """Whether no time goes back, as where a clock was set."""
        return bool((np.diff(self.times_ns) >= 0).all())

    def between(self, start_ns: int, end_ns: int) -> "Series":
        """Return those that were captured from ``start_ns`` until before ``end_ns``."""
        return self._chosen(np.flatnonzero((start_ns <= self.times_ns) & (self.times_ns < end_ns)))

    def _chosen(self, numbers: Integers) -> "Series":
        return Series(self._source, self.key, self.topic, self.places.chosen(numbers))
