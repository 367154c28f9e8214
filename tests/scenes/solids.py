"""A body as solids, to judge what goes through what."""

from functools import cache

import numpy as np
import trimesh
from inhand_lab.geometry.transforms import Transform
from inhand_lab.people.body_motion import BodyMotion
from inhand_lab.people.person import SimulatedPerson
from inhand_lab.people.person_surface import LIMB_SOLIDS
from inhand_lab.people.solids import belly, head_radii, pelvis, rib_cage
from inhand_lab.world.interactions import INTERACTIONS
from inhand_schemas.joints import Joint
from inhand_tracker.geometry.arrays import Array

SPACING = 0.03
MOST_POINTS = 200
ARM_JOINTS = {
    "right": (Joint.ELBOW_RIGHT, Joint.WRIST_RIGHT, Joint.HAND_RIGHT),
    "left": (Joint.ELBOW_LEFT, Joint.WRIST_LEFT, Joint.HAND_LEFT),
}
FOREARM_RADII = (0.024, 0.016)
"""Shares of the stature, at elbow and wrist."""
UPPER_ARM_RADII = (0.029, 0.025)
"""Shares of the stature, at shoulder and elbow."""
HAND_RADIUS = 0.012
"""Of the stature: half the thickness of a palm."""


def depth_in_trunk_and_head(
    person: SimulatedPerson, body: BodyMotion, points: Array
) -> dict[str, Array]:
    """How deep (T, V) points (T, V, 3) are in each solid, metres; negative is outside."""
    head = np.zeros(3), head_radii(person)
    return {
        "head": _depth_in_ellipsoid(body.from_head, *head, points),
        "ribs": _depth_in_ellipsoid(body.from_chest, *rib_cage(person), points),
        "belly": _depth_in_ellipsoid(body.from_chest, *belly(person), points),
        "pelvis": _depth_in_ellipsoid(body.from_pelvis, *pelvis(person), points),
    }


def depth_in_limbs(person: SimulatedPerson, body: BodyMotion, points: Array) -> dict[str, Array]:
    """How deep (T, V) points (T, V, 3) are in each limb, by the name of its further joint."""
    size = person.height * person.girth
    return {
        child.name: _depth_in_capsule(
            body.joints[:, parent], body.joints[:, child], root * size, tip * size, points
        )
        for parent, child, root, tip, _ in LIMB_SOLIDS
    }


def forearm_and_hand(person: SimulatedPerson, body: BodyMotion, side: str) -> tuple[Array, Array]:
    """Centres (T, K, 3) and radii (K,) of balls that fill a forearm and the palm's middle."""
    elbow, wrist, hand = (body.joints[:, joint] for joint in ARM_JOINTS[side])
    shares = np.linspace(0.3, 1.0, 6)
    along = elbow[:, None] + shares[:, None] * (wrist - elbow)[:, None]
    root, tip = FOREARM_RADII
    radii = [*(root + shares * (tip - root)) * person.girth, HAND_RADIUS]
    return np.concatenate([along, hand[:, None]], axis=1), np.array(radii) * person.height


def upper_arm(person: SimulatedPerson, body: BodyMotion, side: str) -> tuple[Array, Array]:
    """Centres (T, K, 3) and radii (K,) of balls that fill the lower two thirds of an upper arm:
    the rest lies against the ribs at the armpit."""
    elbow = ARM_JOINTS[side][0]
    shoulder, end = body.joints[:, elbow - 1], body.joints[:, elbow]
    shares = np.linspace(1.0 / 3.0, 1.0, 7)
    root, tip = UPPER_ARM_RADII
    centres = shoulder[:, None] + shares[:, None] * (end - shoulder)[:, None]
    return centres, (root + shares * (tip - root)) * person.girth * person.height


@cache
def surface_points(interaction: str) -> Array:
    """Points (V, 3) all over an object, in its frame."""
    model = INTERACTIONS[interaction].object_model()
    points, _ = trimesh.remesh.subdivide_to_size(model.vertices, model.faces, SPACING)
    points = np.unique(np.round(points, 4), axis=0)
    chosen = np.random.default_rng(0).permutation(len(points))[:MOST_POINTS]
    return np.asarray(points[chosen])


def placed(world_from_object: Transform, points: Array) -> Array:
    """Points (V, 3) of an object as (T, V, 3) in the world."""
    turned = points @ np.swapaxes(world_from_object.rotation, 1, 2)
    return np.asarray(turned + world_from_object.translation[:, None])


def _depth_in_ellipsoid(
    world_from_part: Transform, centre: Array, radii: Array, points: Array
) -> Array:
    offset = points - world_from_part.translation[:, None]
    local = offset @ world_from_part.rotation - centre
    squares = local * local
    level = np.sqrt(squares @ radii**-2.0)
    slope = np.sqrt(squares @ radii**-4.0)
    return np.asarray(level * (1.0 - level) / np.maximum(slope, 1e-9))


def _depth_in_capsule(start: Array, end: Array, root: float, tip: float, points: Array) -> Array:
    axis = end - start
    offset = points - start[:, None]
    length = _squared(axis)[:, None]
    along = (offset @ axis[:, :, None])[..., 0]
    share = np.clip(along / length, 0.0, 1.0)
    square = _squared(offset) - share * (2.0 * along - share * length)
    return np.asarray(root + share * (tip - root) - np.sqrt(np.maximum(square, 0.0)))


def _squared(vectors: Array) -> Array:
    """Squared lengths (...) of vectors (..., 3)."""
    return np.asarray((vectors * vectors) @ np.ones(3))
