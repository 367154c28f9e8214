"""One person over time, as all cameras have them together."""

from dataclasses import dataclass, field, replace

import numpy as np

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.rig.joint_fusion import fuse_joints
from inhand_tracker.rig.kernels.fuse import mean_distance
from inhand_tracker.rig.parameters import RigParameters
from inhand_tracker.rig.sightings import MIRRORED, Sighting

AS_THEY_ARE = np.arange(20)
"""The order (20,) of joints whose sides are not exchanged."""


@dataclass(frozen=True)
class FusedPerson:
    """A person at a time: ``joints`` (20, 3) in the rig's frame of reference, those that no camera
    sees NaN; ``states`` (20,) as indices of ``STATES``, and ``confidences`` (20,)."""

    identity: int
    joints: Array
    states: Array
    confidences: Array


@dataclass
class PersonTrack:
    """A person who keeps a number: the joints (20, 3) at a time, in metres, and their velocities.

    ``camera_ids`` are what the cameras call the person; ``turned_s`` is for how long most of them
    have read the person with left and right exchanged.
    """

    identity: int
    joints: Array
    time_ns: int
    parameters: RigParameters
    velocities: Array = field(default_factory=lambda: np.zeros((20, 3)))
    camera_ids: dict[str, int] = field(default_factory=dict)
    turned_s: float = 0.0

    def expected(self, time_ns: int) -> Array:
        """Return where joints (20, 3) should be at a time."""
        return self.joints + self.moved(time_ns - self.time_ns)

    def moved(self, elapsed_ns: int) -> Array:
        """Return how far joints go (20, 3) within a time, which may be negative."""
        longest = self.parameters.longest_step_s
        return np.asarray(self.velocities * np.clip(elapsed_ns / 1e9, -longest, longest))

    def distance(self, sighting: Sighting) -> float:
        """Return how far a sighting is from where this person should be, in metres: the mean
        distance of joints, whichever side is which; infinite where no joint is in both."""
        expected = self.expected(sighting.time_ns)
        away = mean_distance(sighting.joints, expected, AS_THEY_ARE)
        if away > self.parameters.swapped_m:
            away = min(away, mean_distance(sighting.joints, expected, MIRRORED))
        if self.camera_ids.get(sighting.camera, sighting.camera_id) != sighting.camera_id:
            away += self.parameters.other_id_m
        return away

    def take(self, sightings: list[Sighting], time_ns: int) -> FusedPerson:
        """Take what cameras see of this person, and return the person at a time."""
        facing = [self._facing(one) for one in sightings]
        turned = sum(one is not seen for one, seen in zip(facing, sightings, strict=True))
        self._note_turn(turned / len(sightings), time_ns)
        # What a camera saw a little earlier or later is moved to this time.
        joints = np.stack([one.joints + self.moved(time_ns - one.time_ns) for one in facing])
        deviations = np.stack([one.deviations for one in facing])
        rays = np.stack([one.rays for one in facing])
        states = np.stack([one.states for one in facing])
        confidences = np.stack([one.confidences for one in facing])
        fused, weights = fuse_joints(
            joints, deviations, rays, self.expected(time_ns), self.parameters
        )
        self._move_to(fused, time_ns)
        for one in sightings:
            self.camera_ids[one.camera] = one.camera_id
        counted = weights / np.maximum(weights.max(axis=0), 1e-9)
        best = np.where(counted > 1 / 2, states, 0).max(axis=0)
        sure = np.where(counted > 1 / 2, confidences, 0.0).max(axis=0)
        return FusedPerson(self.identity, fused, best, sure)

    def _facing(self, sighting: Sighting) -> Sighting:
        """Exchange left and right where a camera takes the person's back for the front."""
        expected = self.expected(sighting.time_ns)
        away = mean_distance(sighting.joints, expected, AS_THEY_ARE)
        if not self.parameters.swapped_m < away < np.inf:
            return sighting
        exchanged = mean_distance(sighting.joints, expected, MIRRORED)
        clearly = away - exchanged > self.parameters.swapped_m
        if clearly and exchanged < self.parameters.swapped_ratio * away:
            return sighting.exchanged()
        return sighting

    def _note_turn(self, share: float, time_ns: int) -> None:
        """Note the share of cameras that have this person's sides the other way round."""
        elapsed = min(max((time_ns - self.time_ns) / 1e9, 0.0), self.parameters.longest_step_s)
        self.turned_s = max(self.turned_s + (2.0 * share - 1.0) * elapsed, 0.0)

    def exchanged(self) -> "PersonTrack":
        """Return the person with left and right exchanged."""
        return replace(
            self,
            joints=self.joints[MIRRORED],
            velocities=self.velocities[MIRRORED],
            turned_s=0.0,
        )

    @property
    def is_turned(self) -> bool:
        """Whether this person has left for right, by most of what cameras say."""
        return self.turned_s > self.parameters.turned_time_s

    def _move_to(self, joints: Array, time_ns: int) -> None:
        """Take new joints (20, 3), where they are known."""
        known = np.asarray(np.isfinite(joints).all(axis=1) & np.isfinite(self.joints).all(axis=1))
        elapsed = (time_ns - self.time_ns) / 1e9
        if elapsed > 0.0:
            share = 1.0 - np.exp(-elapsed / self.parameters.velocity_time_s)
            went = np.where(known[:, None], (joints - self.joints) / elapsed, 0.0)
            speeds = np.linalg.norm(went, axis=1, keepdims=True)
            went *= np.minimum(1.0, self.parameters.most_m_s / np.maximum(speeds, 1e-9))
            self.velocities = self.velocities + share * (went - self.velocities)
        self.joints = np.where(np.isfinite(joints), joints, self.joints)
        self.time_ns = time_ns
