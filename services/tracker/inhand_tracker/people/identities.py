"""Identifies several people over time, when the camera's ids may be exchanged.

People are told apart by where they go and by the lengths of their bones. A camera's own id counts
as well, but less than both: two people who cross often leave with each other's.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from inhand_schemas.joints import Joint
from inhand_schemas.messages import Person

from inhand_tracker.body.skeleton import part_lengths
from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.people.cheapest_pairs import cheapest_pairs
from inhand_tracker.people.parameters import DEFAULT_PEOPLE, PeopleParameters
from inhand_tracker.wire.conversion import joints_of

IMPOSSIBLE = 1e6
"""Cost of taking somebody for a person who cannot be there."""

_TRUNK = np.array([Joint.HIP_CENTER, Joint.SPINE, Joint.SHOULDER_CENTER])
_CHEST = np.array([Joint.SHOULDER_CENTER])
# Numbers of the parts whose lengths count: hands and feet are the least sure.
_BONES = np.array([0, 1, 2, 3, 4, 5, 7, 8, 9, 11, 12, 13, 15, 16, 17])


@dataclass(frozen=True)
class _Sighting:
    """A person of one frame: where the trunk is (3,), and the logarithms of bone lengths."""

    person: Person
    place: Array
    log_lengths: Array


@dataclass
class _Track:
    """A person over time: where the trunk is, how it moves, the logarithms of bone lengths."""

    identity: int
    camera_id: int
    place: Array
    time_ns: int
    velocity: Array = field(default_factory=lambda: np.zeros(3))
    log_lengths: Array = field(default_factory=lambda: np.full(len(_BONES), np.nan))
    frames: int = 0

    def expected_place(self, time_ns: int) -> Array:
        return self.place + self.velocity * ((time_ns - self.time_ns) / 1e9)


class Identities:
    """Gives each person a number that stays, whatever the camera calls them.

    A person is where the trunk is, or, where hips are not needed (``needs_hips``), the chest.
    """

    def __init__(
        self, parameters: PeopleParameters = DEFAULT_PEOPLE, *, needs_hips: bool = True
    ) -> None:
        self._place_joints = _TRUNK if needs_hips else _CHEST
        self._parameters = parameters
        self._tracks: list[_Track] = []
        self._next = 0

    def assign(self, people: Sequence[Person], time_ns: int) -> dict[int, Person]:
        """Number the people of a frame, by who they were before.

        Those whose trunk is not seen are left out. A clock that went back starts anew.
        """
        self._forget(time_ns)
        sightings = _sightings(people, self._place_joints)
        matches = self._match(sightings, time_ns)
        numbered: dict[int, Person] = {}
        for index, sighting in enumerate(sightings):
            track = matches.get(index) or self._new_track(sighting, time_ns)
            self._update(track, sighting, time_ns)
            numbered[track.identity] = sighting.person
        return numbered

    def _forget(self, time_ns: int) -> None:
        if any(time_ns < track.time_ns for track in self._tracks):
            self._tracks = []
        patience_ns = self._parameters.patience_ns
        self._tracks = [one for one in self._tracks if time_ns - one.time_ns <= patience_ns]

    def _match(self, sightings: Sequence[_Sighting], time_ns: int) -> dict[int, _Track]:
        """The tracks of sightings, by their numbers; strangers have none."""
        if not self._tracks or not sightings:
            return {}
        costs = np.array(
            [[self._cost(track, one, time_ns) for one in sightings] for track in self._tracks]
        )
        return {
            column: self._tracks[row]
            for row, column in cheapest_pairs(costs)
            if costs[row, column] < IMPOSSIBLE
        }

    def _cost(self, track: _Track, sighting: _Sighting, time_ns: int) -> float:
        """The negative log-likelihood of a sighting of a track's person."""
        parameters = self._parameters
        away = float(np.linalg.norm(sighting.place - track.expected_place(time_ns)))
        drift = parameters.drift_m_s * ((time_ns - track.time_ns) / 1e9)
        if away > parameters.farthest_m + drift:
            return IMPOSSIBLE
        cost = 0.5 * (away / (parameters.position_sigma_m + drift)) ** 2
        apart = np.abs(sighting.log_lengths - track.log_lengths)
        if np.isfinite(apart).any():
            cost += 0.5 * (float(np.nanmean(apart)) / parameters.length_sigma) ** 2
        return cost + (parameters.other_id_cost if sighting.person.id != track.camera_id else 0.0)

    def _new_track(self, sighting: _Sighting, time_ns: int) -> _Track:
        track = _Track(self._next, sighting.person.id, sighting.place, time_ns)
        self._tracks.append(track)
        self._next += 1
        return track

    def _update(self, track: _Track, sighting: _Sighting, time_ns: int) -> None:
        """Take a sighting of a track's person."""
        elapsed = (time_ns - track.time_ns) / 1e9
        if elapsed > 0.0:
            share = 1.0 - np.exp(-elapsed / self._parameters.velocity_time_s)
            velocity = (sighting.place - track.place) / elapsed
            track.velocity = track.velocity + share * (velocity - track.velocity)
        track.place, track.time_ns = sighting.place, time_ns
        track.camera_id = sighting.person.id
        track.frames += 1
        weight = 1.0 / min(track.frames, self._parameters.length_frames)
        mean = np.where(np.isfinite(track.log_lengths), track.log_lengths, sighting.log_lengths)
        change = np.where(np.isfinite(sighting.log_lengths), sighting.log_lengths - mean, 0.0)
        track.log_lengths = mean + weight * change


def _sightings(people: Sequence[Person], place_joints: Indices) -> list[_Sighting]:
    """The people of whom all joints are seen that say where they are."""
    sightings = []
    for person in people:
        joints = joints_of(person)
        if np.isfinite(joints[place_joints]).all():
            lengths = np.log(np.maximum(part_lengths(joints)[_BONES], 1e-3))
            sightings.append(_Sighting(person, joints[place_joints].mean(axis=0), lengths))
    return sightings
