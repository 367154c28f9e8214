"""Who is who from frame to frame, and what is remembered of each."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from inhand_capture.estimation.body_lengths import BodyLengths
from inhand_capture.estimation.found_person import Floats
from inhand_capture.estimation.lifting import Lifted
from inhand_capture.estimation.one_euro import OneEuroFilter
from inhand_capture.estimation.parameters import DEFAULT_FOLLOWING
from inhand_capture.estimation.sides import Sides

JOINTS = 20


@dataclass
class FollowedPerson:
    """One person: their id, where they were last, and what their body is like."""

    middle: Floats
    """The middle of the hips (3,), metres in the camera frame."""
    seen_ns: int
    id: int | None = None
    """None until somebody is followed."""
    body: BodyLengths = field(default_factory=BodyLengths)
    sides: Sides = field(default_factory=Sides)
    filter: OneEuroFilter = field(default_factory=lambda: OneEuroFilter(JOINTS))
    seen: Floats = field(default_factory=lambda: np.full((JOINTS, 3), np.nan))
    """The network's joints (20, 3) in the frame of ``seen_ns``."""


class PeopleFollowed:
    """Gives people in view ids that last as long as they stay, or come back at once."""

    def __init__(self) -> None:
        self._people: list[FollowedPerson] = []
        self._next_id = 0

    def match(self, middles: Sequence[Floats], time_ns: int) -> list[FollowedPerson | None]:
        """Return who is at each middle of hips (3,), nearest first; None for somebody new."""
        forgotten_ns = DEFAULT_FOLLOWING.forgotten_s * 1e9
        self._people = [one for one in self._people if 0 <= time_ns - one.seen_ns <= forgotten_ns]
        distances = [
            (float(np.linalg.norm(middle - one.middle)), place, one)
            for place, middle in enumerate(middles)
            for one in self._people
        ]
        matched: list[FollowedPerson | None] = [None] * len(middles)
        taken: set[int | None] = set()
        for distance, place, one in sorted(distances, key=lambda pair: pair[0]):
            near = distance <= self._reach(one, time_ns)
            if near and matched[place] is None and one.id not in taken:
                matched[place] = one
                taken.add(one.id)
        return matched

    def see(self, person: FollowedPerson, middle: Floats, lifted: Lifted, time_ns: int) -> int:
        """Remember where somebody is, and return their id: one that nobody had for somebody new."""
        if person.id is None:
            person.id = self._next_id
            self._next_id += 1
            self._people.append(person)
        person.middle, person.seen, person.seen_ns = middle, lifted.seen, time_ns
        person.body.add(lifted.seen, lifted.states)
        return person.id

    def _reach(self, one: FollowedPerson, time_ns: int) -> float:
        parameters = DEFAULT_FOLLOWING
        way = parameters.speed_m * (time_ns - one.seen_ns) / 1e9
        return min(parameters.reach_m + way, parameters.farthest_m)
