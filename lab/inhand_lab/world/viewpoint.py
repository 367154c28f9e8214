"""Where the camera stands in the person's world, and which way it looks."""

from __future__ import annotations

import numpy as np
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.camera import Intrinsics

from inhand_lab.geometry.transforms import Transform, normalised, rotation_about
from inhand_lab.people.person import SimulatedPerson

HEIGHT = (1.0, 1.4)
"""Range of a camera's height above the floor, metres."""
DISTANCE = (2.2, 3.0)
"""Range of its distance from the person, metres; more where the person would not fit."""
ASIDE = np.radians(30.0)
"""Angle by which it is aside of what the person faces, at the most, radians."""
HEADROOM = 0.60
"""Height that is in the image beside the person's, metres."""
AIM = 0.43
"""Height that the camera looks at, as a share of stature."""


def place_camera(
    person: SimulatedPerson, intrinsics: Intrinsics, random: np.random.Generator
) -> tuple[float, Transform]:
    """The direction to the camera as a turn to the person's left, and camera_from_world."""
    facing = float(random.uniform(-ASIDE, ASIDE))
    fitting = (person.height + HEADROOM) * intrinsics.fy / intrinsics.height
    distance = max(random.uniform(*DISTANCE), fitting)
    ahead = rotation_about("z", facing)[:, 1]
    position = ahead * distance + np.array([0.0, 0.0, random.uniform(*HEIGHT)])
    target = np.array([0.0, 0.0, AIM * person.height + random.normal(0.0, 0.02)])
    return facing, looking(position, target)


def looking(position: Array, target: Array) -> Transform:
    """camera_from_world of an upright camera at a position (3,) that looks at a target (3,)."""
    forward = normalised(target - position)
    right = normalised(np.cross(forward, [0.0, 0.0, 1.0]))
    world_from_camera = np.stack([right, np.cross(forward, right), forward], axis=1)
    return Transform(position, world_from_camera).inverse()


def facing_of(camera_from_world: Transform) -> float:
    """The direction to a camera as a turn to the left of the world's y axis, radians."""
    viewpoint = camera_from_world.inverse().translation
    return float(np.arctan2(-viewpoint[0], viewpoint[1]))
