"""Where the camera stands in the person's world, and which way it looks."""

from __future__ import annotations

import numpy as np
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.camera import Intrinsics

from inhand_lab.geometry.transforms import Transform, normalised, rotation_about
from inhand_lab.motions.furniture import Cuboid, Furniture
from inhand_lab.people.person import SimulatedPerson
from inhand_lab.world.parameters import (
    CAMERA_PLACINGS,
    USUAL_VIEWS,
    CameraPlacing,
    Range,
)

SEEN_AT = (0.45, 0.6, 0.75, 0.9)
"""Heights of what a camera must see of a person, as shares of stature."""


def place_camera(
    person: SimulatedPerson,
    intrinsics: Intrinsics,
    random: np.random.Generator,
    furniture: Furniture = (),
    views: str = USUAL_VIEWS,
) -> tuple[float, Transform]:
    """The direction to the camera as a turn to the person's left, and camera_from_world.

    ``furniture`` is what the person uses; it stands between camera and person only where it does so
    from everywhere that is tried. ``views`` names one of CAMERA_PLACINGS.
    """
    placing = CAMERA_PLACINGS[views]
    for _ in range(placing.tries):
        facing, position = _position(person, intrinsics, random, placing)
        if not hidden(person, position, furniture):
            break
    return facing, looking(position, _target(person, random, placing))


def place_beside(
    person: SimulatedPerson,
    intrinsics: Intrinsics,
    random: np.random.Generator,
    placing: CameraPlacing,
    directions: Range,
) -> Transform:
    """camera_from_world of a place for a camera of a rig, in one of these directions, which are
    turns to the left of the person's y axis in radians; ``aside`` of the placing is not used."""
    turn = float(random.uniform(*directions))
    position = _away(person, intrinsics, random, placing, turn)
    return looking(position, _target(person, random, placing))


def _position(
    person: SimulatedPerson,
    intrinsics: Intrinsics,
    random: np.random.Generator,
    placing: CameraPlacing,
) -> tuple[float, Array]:
    facing = float(random.uniform(-placing.aside, placing.aside))
    return facing, _away(person, intrinsics, random, placing, facing)


def _away(
    person: SimulatedPerson,
    intrinsics: Intrinsics,
    random: np.random.Generator,
    placing: CameraPlacing,
    turn: float,
) -> Array:
    """A position (3,) in a direction that is a turn to the left of the y axis."""
    fitting = (person.height + placing.headroom) * intrinsics.fy / intrinsics.height
    distance = max(random.uniform(*placing.distance), fitting)
    ahead = rotation_about("z", turn)[:, 1]
    return ahead * distance + np.array([0.0, 0.0, random.uniform(*placing.height)])


def _target(person: SimulatedPerson, random: np.random.Generator, placing: CameraPlacing) -> Array:
    return np.array([0.0, 0.0, placing.aim * person.height + random.normal(0.0, 0.02)])


def hidden(person: SimulatedPerson, position: Array, furniture: Furniture) -> bool:
    """Whether a piece of furniture hides half of the person's height, or more, from a position (3,)
    in the person's world."""
    points = np.outer(SEEN_AT, [0.0, 0.0, person.height])
    return any(
        2 * sum(_between(box, position, p) for p in points) >= len(points) for box in furniture
    )


def _between(box: Cuboid, one: Array, other: Array) -> bool:
    """Whether the line from one point (3,) to the other passes through a cuboid."""
    way = other - one
    way = np.where(np.abs(way) < 1e-9, 1e-9, way)
    half = 0.5 * np.array(box.size)
    bounds = (np.array([-half, half]) + box.centre - one) / way
    enters, leaves = bounds.min(axis=0).max(), bounds.max(axis=0).min()
    return bool(max(enters, 0.0) < min(leaves, 1.0))


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
