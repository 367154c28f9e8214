"""Somebody who wanders about a room, as the skeleton trackers of several cameras read it.

Each camera has its own place, rate, clock and lost frames, and its own noise.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Array, Indices

from inhand_lab.geometry.transforms import Transform
from inhand_lab.people.body_motion import BodyMotion
from inhand_lab.people.person import sample_person
from inhand_lab.sensing.skeleton_noise import MISSING, read_skeleton
from inhand_lab.world.viewpoint import looking
from inhand_lab.world.wandering import wander

AIM_HEIGHT = 0.9
"""Height of the point above the room's middle that cameras look at, metres."""


@dataclass(frozen=True)
class WandererCamera:
    """Where a camera stands, how it counts time and what it loses.

    ``around`` is the angle about the room's middle from the world's y axis to the left, radians;
    ``distance`` from the middle and ``height`` above the floor are metres. The true time of what
    its clock says, in seconds, is ``(1 + drift) * said + offset_s``.
    """

    name: str
    around: float
    distance: float
    height: float
    frame_rate: float = 30.0
    offset_s: float = 0.0
    drift: float = 0.0
    dropped_share: float = 0.0

    @property
    def world_from_camera(self) -> Transform:
        """Its pose: it looks at the middle of the room."""
        ahead = np.array([-np.sin(self.around), np.cos(self.around), 0.0])
        position = ahead * self.distance + np.array([0.0, 0.0, self.height])
        return looking(position, np.array([0.0, 0.0, AIM_HEIGHT])).inverse()

    def true_times(self, said: Array) -> Array:
        """The true times (T,) of what the clock says (T,), seconds."""
        return (1.0 + self.drift) * said + self.offset_s


@dataclass(frozen=True)
class WandererView:
    """What one camera sees of the wanderer in N frames: what its clock says of them, seconds, the
    joints (N, 20, 3) in its frame, NaN where missing, and their confidences (N, 20)."""

    camera: WandererCamera
    said_s: Array
    joints: Array
    confidences: Array

    @property
    def stamps_ns(self) -> Indices:
        """The frames' times by the camera's clock, nanoseconds."""
        return np.rint(1e9 * self.said_s).astype(np.int64)


def watch_wanderer(
    participant: int, seed: int, seconds: float, cameras: Sequence[WandererCamera]
) -> list[WandererView]:
    """Simulate somebody who wanders for so many seconds, as the cameras see it."""
    return [
        _view(participant, seed, seconds, camera, number) for number, camera in enumerate(cameras)
    ]


def wander_at(participant: int, seed: int, seconds: float, times: Array) -> BodyMotion:
    """The movement of a wander of so many seconds at times (T,) of it."""
    random = np.random.default_rng([seed, participant, 0x3A1D])
    # The last of the times is the same for all cameras, so that the random numbers are.
    person = sample_person(seed, participant)
    return wander(person, np.append(times, seconds), random)[: len(times)]


def _view(
    participant: int, seed: int, seconds: float, camera: WandererCamera, number: int
) -> WandererView:
    random = np.random.default_rng([seed, participant, number, 0x3A1E])
    first = (random.uniform(0.0, 1.0) / camera.frame_rate - camera.offset_s) / (1.0 + camera.drift)
    said = first + np.arange(int(seconds * camera.frame_rate)) / camera.frame_rate
    said = said[camera.true_times(said) <= seconds]
    body = wander_at(participant, seed, seconds, camera.true_times(said))
    seen = camera.world_from_camera.inverse().apply(body.joints)
    reading = read_skeleton(sample_person(seed, participant), seen, camera.frame_rate, random)
    missing = reading.states == MISSING
    joints = np.where(missing[..., None], np.nan, reading.joints)
    kept = random.random(len(said)) >= camera.dropped_share
    return WandererView(camera, said[kept], joints[kept], reading.confidences[kept])
