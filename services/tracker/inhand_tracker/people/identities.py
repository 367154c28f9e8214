"""Who is who among several people, when the camera's ids may be exchanged.

People are told apart by where they go and by the lengths of their bones. A camera's own id counts
as well, but less than both: two people who cross often leave with each other's.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from inhand_schemas.joints import Joint
from inhand_schemas.messages import Person
from scipy.optimize import linear_sum_assignment

from inhand_tracker.body.skeleton import part_lengths
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.wire.conversion import joints_of

PATIENCE_NS = 2_000_000_000
"""Who is not seen for so long is forgotten."""
FARTHEST_M = 0.6
"""Nobody is farther than this from where they were expected, and half a metre a second more."""
DRIFT_M_S = 0.5
POSITION_SIGMA_M = 0.08
LENGTH_SIGMA = 0.06
"""Of the mean difference of the logarithms of bone lengths."""
OTHER_ID_COST = 2.0
IMPOSSIBLE = 1e6
SMOOTHING_S = 0.15
LENGTH_FRAMES = 60
"""Bone lengths are means over about so many frames."""

_CENTRE = np.array([Joint.HIP_CENTER, Joint.SPINE, Joint.SHOULDER_CENTER])
# Hands and feet are the least sure.
_BONES = np.array([0, 1, 2, 3, 4, 5, 7, 8, 9, 11, 12, 13, 15, 16, 17])


@dataclass
class _Known:
    """One person: where the trunk is and how it moves, and the logarithms of bone lengths."""

    identity: int
    camera_id: int
    place: Array
    time_ns: int
    velocity: Array = field(default_factory=lambda: np.zeros(3))
    lengths: Array = field(default_factory=lambda: np.full(len(_BONES), np.nan))
    frames: int = 0

    def expected(self, time_ns: int) -> Array:
        return self.place + self.velocity * ((time_ns - self.time_ns) / 1e9)


class Identities:
    """Gives each person a number that stays, whatever the camera calls them."""

    def __init__(self) -> None:
        self._known: list[_Known] = []
        self._next = 0

    def assign(self, people: Sequence[Person], time_ns: int) -> dict[int, Person]:
        """The people of a frame by their lasting numbers; those without a trunk are left out."""
        if any(time_ns < known.time_ns for known in self._known):
            self._known = []
        self._known = [k for k in self._known if time_ns - k.time_ns <= PATIENCE_NS]
        seen = [(person, joints_of(person)) for person in people]
        seen = [(person, joints) for person, joints in seen if np.isfinite(joints[_CENTRE]).all()]
        found: dict[int, Person] = {}
        new = set(range(len(seen)))
        if self._known and seen:
            costs = np.array([[self._cost(k, *one, time_ns) for one in seen] for k in self._known])
            for row, column in zip(*linear_sum_assignment(costs), strict=True):
                if costs[row, column] < IMPOSSIBLE:
                    known = self._known[row]
                    person, joints = seen[column]
                    _take(known, person, joints, time_ns)
                    found[known.identity] = person
                    new.discard(int(column))
        for stranger in sorted(new):
            person, joints = seen[stranger]
            known = _Known(self._next, person.id, joints[_CENTRE].mean(axis=0), time_ns)
            _take(known, person, joints, time_ns)
            self._known.append(known)
            found[known.identity] = person
            self._next += 1
        return found

    def _cost(self, known: _Known, person: Person, joints: Array, time_ns: int) -> float:
        away = float(np.linalg.norm(joints[_CENTRE].mean(axis=0) - known.expected(time_ns)))
        unseen = (time_ns - known.time_ns) / 1e9
        if away > FARTHEST_M + DRIFT_M_S * unseen:
            return IMPOSSIBLE
        cost = 0.5 * (away / (POSITION_SIGMA_M + DRIFT_M_S * unseen)) ** 2
        apart = _log_lengths(joints) - known.lengths
        if np.isfinite(apart).any():
            cost += 0.5 * (float(np.nanmean(np.abs(apart))) / LENGTH_SIGMA) ** 2
        return cost + (OTHER_ID_COST if person.id != known.camera_id else 0.0)


def _take(known: _Known, person: Person, joints: Array, time_ns: int) -> None:
    place = joints[_CENTRE].mean(axis=0)
    since = (time_ns - known.time_ns) / 1e9
    if since > 0.0:
        share = 1.0 - np.exp(-since / SMOOTHING_S)
        known.velocity = known.velocity + share * ((place - known.place) / since - known.velocity)
    known.place, known.time_ns, known.camera_id = place, time_ns, person.id
    known.frames += 1
    weight = 1.0 / min(known.frames, LENGTH_FRAMES)
    lengths = _log_lengths(joints)
    better = np.where(np.isfinite(known.lengths), known.lengths, lengths)
    moved = np.where(np.isfinite(lengths), lengths - better, 0.0)
    known.lengths = better + weight * moved


def _log_lengths(joints: Array) -> Array:
    return np.log(np.maximum(part_lengths(joints)[_BONES], 1e-3))
