"""Where the camera stands in the person's world, and which way it looks."""

from __future__ import annotations

import numpy as np
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.camera import Intrinsics

from inhand_lab.geometry.transforms import Transform, normalised, rotation_about
from inhand_lab.people.person import SimulatedPerson
from inhand_lab.world.parameters import DEFAULT_CAMERA_PLACING


def place_camera(
    person: SimulatedPerson, intrinsics: Intrinsics, random: np.random.Generator
) -> tuple[float, Transform]:
    """The direction to the camera as a turn to the person's left, and camera_from_world."""
    placing = DEFAULT_CAMERA_PLACING
    facing = float(random.uniform(-placing.aside, placing.aside))
    fitting = (person.height + placing.headroom) * intrinsics.fy / intrinsics.height
    distance = max(random.uniform(*placing.distance), fitting)
    ahead = rotation_about("z", facing)[:, 1]
    position = ahead * distance + np.array([0.0, 0.0, random.uniform(*placing.height)])
    target = np.array([0.0, 0.0, placing.aim * person.height + random.normal(0.0, 0.02)])
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
