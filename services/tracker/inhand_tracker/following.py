"""Whose object is followed when several people are in view."""

from collections.abc import Sequence

from inhand_schemas.messages import Person

from inhand_tracker.body import JOINT

PATIENCE_NS = 1_000_000_000


class Follower:
    """Follows one person by id; when that one is gone for a second, the nearest to the camera."""

    def __init__(self) -> None:
        self.person_id: int | None = None
        self._seen_ns = 0

    def choose(self, people: Sequence[Person], time_ns: int) -> Person | None:
        """The person followed, of those seen at a time; None while that one is not seen."""
        chosen = next((person for person in people if person.id == self.person_id), None)
        waiting = self.person_id is not None and 0 <= time_ns - self._seen_ns < PATIENCE_NS
        if chosen is None and not waiting:
            chosen = _nearest(people)
        if chosen is not None:
            self.person_id, self._seen_ns = chosen.id, time_ns
        return chosen


def _nearest(people: Sequence[Person]) -> Person | None:
    hips = JOINT["HipCenter"]
    seen = [person for person in people if person.states[hips] != "missing"]
    return min(seen, key=lambda person: person.joints[hips][2], default=None)
