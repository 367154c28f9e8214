"""When a recording's messages were received, by a clock that nobody set."""

from array import array
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from statistics import median_low

from inhand_runtime.recording.layout import REORDERED_NS

from inhand_recorder.clock import SMALLEST_STEP_NS, time_text


@dataclass
class Span:
    """The messages of one key: how many, and from when to when, in nanoseconds."""

    messages: int
    start_ns: int
    end_ns: int

    @property
    def rate_hz(self) -> float:
        """Messages a second from the first to the last; 0 for a single one."""
        seconds = (self.end_ns - self.start_ns) / 1e9
        return (self.messages - 1) / seconds if seconds > 0 else 0.0


@dataclass
class ReceptionTimes:
    """Times of reception in the file's order, in nanoseconds since the epoch, each with its key.

    ``in_order`` says that the file's order is that of reception, as in files of Inhand's: then a
    time that goes back shows that the clock was set. In other files the times alone say the order.
    """

    received_ns: "array[int]" = field(default_factory=lambda: array("Q"))
    in_order: bool = True
    _numbers: "array[int]" = field(default_factory=lambda: array("L"))
    _keys: dict[str, int] = field(default_factory=dict)

    def add(self, key: str, received_ns: int) -> None:
        """Take note of the next message."""
        self._numbers.append(self._keys.setdefault(key, len(self._keys)))
        self.received_ns.append(received_ns)

    def without_steps(
        self, noted: Mapping[int, int]
    ) -> tuple[dict[str, Span], float, tuple[str, ...]]:
        """Each key's span and the seconds of all, steps of the clock taken out, and a line a step.

        ``noted`` are steps in nanoseconds by the time at which each was seen. A step back that
        nobody noted is measured as if a usual time had passed between the messages around it.
        """
        steps, lines = self._noted_steps(noted)
        lines += self._visible_steps(steps)
        names, spans = list(self._keys), dict[str, Span]()
        offset_ns, earliest_ns, latest_ns = 0, None, 0
        for place, (number, time_ns) in enumerate(
            zip(self._numbers, self.received_ns, strict=True)
        ):
            offset_ns += steps.get(place, 0)
            time_ns -= offset_ns
            span = spans.setdefault(names[number], Span(0, time_ns, time_ns))
            span.messages += 1
            span.start_ns, span.end_ns = min(span.start_ns, time_ns), max(span.end_ns, time_ns)
            earliest_ns = time_ns if earliest_ns is None else min(earliest_ns, time_ns)
            latest_ns = max(latest_ns, time_ns) if place else time_ns
        return spans, (latest_ns - (earliest_ns or 0)) / 1e9, tuple(lines)

    def _gaps(self) -> Iterator[tuple[int, int]]:
        """The time from each message to the next, with the next one's place."""
        for place, (before, after) in enumerate(pairwise(self.received_ns), 1):
            yield after - before, place

    def _noted_steps(self, noted: Mapping[int, int]) -> tuple[dict[int, int], list[str]]:
        """Steps by the place of the first message behind each, where the gap fits it best.

        A step back that no time shows, since it lies in a longer silence or behind the last
        message, has no place.
        """
        steps: dict[int, int] = {}
        lines = []
        for at_ns, step_ns in sorted(noted.items()):
            fitting = [
                (abs(gap_ns - step_ns), place)
                for gap_ns, place in self._gaps()
                if place not in steps
                and gap_ns >= step_ns - SMALLEST_STEP_NS // 2
                and (step_ns > 0 or gap_ns < 0)
            ]
            line = f"the clock was set by {step_ns / 1e9:+.3f} s at {time_text(at_ns)}"
            if fitting:
                steps[min(fitting)[1]] = step_ns
                line += ": duration and rates are without that"
            lines.append(line)
        return steps, lines

    def _visible_steps(self, steps: dict[int, int]) -> list[str]:
        """Add steps back that nobody noted, and return a line for each."""
        if not self.in_order:
            return []
        back = [
            (gap_ns, place)
            for gap_ns, place in self._gaps()
            if gap_ns - steps.get(place, 0) < -REORDERED_NS
        ]
        usual_ns = median_low(gap_ns for gap_ns, _ in self._gaps()) if back else 0
        lines = []
        for gap_ns, place in back:
            steps[place] = gap_ns - max(usual_ns, 0)
            lines.append(
                f"the time of reception goes back by {-gap_ns / 1e9:.3f} s after "
                f"{time_text(self.received_ns[place - 1])}, and no step of the clock is noted: "
                "duration and rates are without that"
            )
        return lines
