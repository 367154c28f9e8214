"""Achievements that go on for longer than a window: they are counted piece by piece."""

from collections.abc import Sequence
from dataclasses import dataclass, field

from inhand_outcomes.outcome import Outcome


@dataclass
class LastingOutcomes:
    """What goes on of one object in one person's hands.

    ``counted_ns`` is until when the track is counted: measures see what comes after it.
    """

    settle_ns: float
    piece_ns: float
    counted_ns: int = 0
    carried: dict[str, Outcome] = field(default_factory=dict)
    """What is counted, by kind."""

    def follow(self, found: Sequence[Outcome], last_ns: int, *, ended: bool) -> list[Outcome]:
        """Take the lasting outcomes after ``counted_ns`` of a track that reaches ``last_ns``, in
        order of time; what has come to its end."""
        done: list[Outcome] = []
        under_way: set[str] = set()
        for outcome in found:
            carried = self.carried.pop(outcome.kind, None)
            if carried is not None and outcome.start_ns - carried.end_ns > self.settle_ns:
                done.append(carried)
                carried = None
            whole = outcome if carried is None else carried.with_more(outcome)
            if ended or last_ns - outcome.end_ns > self.settle_ns:
                done.append(whole)
                self.counted_ns = max(self.counted_ns, outcome.end_ns)
                continue
            under_way.add(outcome.kind)
            if outcome.end_ns - outcome.start_ns >= self.piece_ns:
                self.carried[outcome.kind] = whole
                self.counted_ns = max(self.counted_ns, outcome.end_ns)
            elif carried is not None:
                self.carried[outcome.kind] = carried
        for kind, carried in list(self.carried.items()):
            quiet = last_ns - carried.end_ns > self.settle_ns and kind not in under_way
            if ended or quiet:
                done.append(self.carried.pop(kind))
        return done
