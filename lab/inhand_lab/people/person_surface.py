"""The visible surface of a person: rigid parts on the joints, skin, hair and clothes.

Radii of limbs are fractions of stature after the circumferences of ANSUR II.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from inhand_runtime.compiled import njit
from inhand_schemas.joints import Joint
from inhand_tracker.geometry.arrays import Array, Indices

from inhand_lab.geometry.surfaces import Rgb, Surface, ellipsoid, join_surfaces, limb
from inhand_lab.geometry.transforms import MIRROR, Transform, normalised
from inhand_lab.people.body_motion import BodyMotion
from inhand_lab.people.person import SimulatedPerson
from inhand_lab.people.solids import belly, head_radii, pelvis, rib_cage

SKIN = ((236, 196, 170), (214, 166, 132), (176, 124, 88), (124, 84, 60), (88, 58, 42))
EYE = (40, 34, 32)
EYE_WHITE = (232, 228, 222)
LIP_RED = (150, 30, 40)
HAIR = ((36, 28, 24), (78, 52, 34), (120, 88, 52), (164, 150, 130))

LimbSolid = tuple[Joint, Joint, float, float, str]
"""Parent and child joint, radii at both as fractions of stature, and what covers the limb."""


def _both_sides(*limbs: tuple[str, str, float, float, str]) -> list[LimbSolid]:
    """Limbs of the right side, then those of the left."""
    return [
        (Joint[f"{parent}_{side}"], Joint[f"{child}_{side}"], root, tip, cover)
        for side in ("RIGHT", "LEFT")
        for parent, child, root, tip, cover in limbs
    ]


LIMB_SOLIDS: tuple[LimbSolid, ...] = (
    *_both_sides(
        ("SHOULDER", "ELBOW", 0.029, 0.025, "shirt"), ("ELBOW", "WRIST", 0.024, 0.016, "skin")
    ),
    *_both_sides(
        ("HIP", "KNEE", 0.047, 0.034, "trousers"), ("KNEE", "ANKLE", 0.033, 0.023, "trousers")
    ),
    *_both_sides(("ANKLE", "FOOT", 0.022, 0.017, "shoes")),
    (Joint.SHOULDER_CENTER, Joint.SHOULDER_RIGHT, 0.034, 0.031, "shirt"),
    (Joint.SHOULDER_CENTER, Joint.SHOULDER_LEFT, 0.034, 0.031, "shirt"),
    (Joint.SHOULDER_CENTER, Joint.HEAD, 0.034, 0.031, "skin"),
)
"""The limbs, which are drawn and which hide joints."""
_PARENTS, _CHILDREN = (np.array([limb[end] for limb in LIMB_SOLIDS]) for end in range(2))


@dataclass(frozen=True)
class PersonSurface:
    """A person's surface; ``part`` (V,) is the index of the part that moves each vertex."""

    surface: Surface
    part: Indices

    def posed(self, body: BodyMotion, frame: int) -> Surface:
        """The surface in the frame of reference of the body, at one of its frames."""
        frames = _part_frames(body, frame)
        vertices, normals = _turned(
            self.part, frames.rotation, self.surface.vertices, self.surface.normals
        )
        return Surface(
            vertices + frames.translation[self.part],
            normals,
            self.surface.faces,
            self.surface.colours,
        )


@njit(cache=True, nogil=True)
def _turned(part, rotations, vertices, normals):  # type: ignore[no-untyped-def]
    """Vertices and normals (V, 3) turned by the rotations (K, 3, 3) of their parts (V,)."""
    turned, facing = np.empty_like(vertices), np.empty_like(normals)
    for vertex in range(len(part)):
        turn = rotations[part[vertex]]
        x, y, z = vertices[vertex]
        across, up, out = normals[vertex]
        for axis in range(3):
            turned[vertex, axis] = turn[axis, 0] * x + turn[axis, 1] * y + turn[axis, 2] * z
            facing[vertex, axis] = turn[axis, 0] * across + turn[axis, 1] * up + turn[axis, 2] * out
    return turned, facing


def build_person_surface(person: SimulatedPerson, joints: Array) -> PersonSurface:
    """The surface of this person, with bones as between the joints (20, 3), and clothed."""
    palette = _palette(person)
    size = person.height * person.girth
    parts = [
        limb(_distance(joints, parent, child), root * size, tip * size, palette[cover])
        for parent, child, root, tip, cover in LIMB_SOLIDS
    ]
    parts += [
        ellipsoid(*pelvis(person), palette["trousers"]),
        join_surfaces([ellipsoid(*part(person), palette["shirt"]) for part in (rib_cage, belly)]),
        _head(person, palette["skin"], palette["hair"]),
    ]
    hand = _right_hand(person, palette["skin"])
    left = Surface(hand.vertices * MIRROR, hand.normals * MIRROR, hand.faces[:, ::-1], hand.colours)
    parts += [hand, left]
    counts = [len(part.vertices) for part in parts]
    return PersonSurface(join_surfaces(parts), np.repeat(np.arange(len(parts)), counts))


def _distance(joints: Array, parent: Joint, child: Joint) -> float:
    return float(np.linalg.norm(joints[child] - joints[parent]))


def _part_frames(body: BodyMotion, frame: int) -> Transform:
    joints = body.joints[frame]
    right = body.from_chest.rotation[frame, :, 0] + 0.01 * body.from_chest.rotation[frame, :, 1]
    along = normalised(joints[_CHILDREN] - joints[_PARENTS])
    across = normalised(np.cross(along, right))
    bones = np.stack([np.cross(across, along), across, along], axis=2)
    wholes = (
        body.from_pelvis,
        body.from_chest,
        body.from_head,
        body.from_right_hand,
        body.from_left_hand,
    )
    return Transform(
        np.concatenate([joints[_PARENTS], [whole.translation[frame] for whole in wholes]]),
        np.concatenate([bones, [whole.rotation[frame] for whole in wholes]]),
    )


def _palette(person: SimulatedPerson) -> dict[str, Rgb]:
    random = np.random.default_rng(person.appearance)

    def cloth() -> Rgb:
        dye = random.uniform(40.0, 190.0) + random.normal(0.0, 35.0, 3)
        red, green, blue = (int(value) for value in np.clip(dye, 20.0, 230.0))
        return red, green, blue

    return {
        "skin": SKIN[random.integers(len(SKIN))],
        "hair": HAIR[random.integers(len(HAIR))],
        "shirt": cloth(),
        "trousers": cloth(),
        "shoes": cloth(),
    }


def _head(person: SimulatedPerson, skin: Rgb, hair: Rgb) -> Surface:
    wide, deep, high = radii = head_radii(person)
    cap = ellipsoid((0.0, -0.18 * deep, 0.20 * high), radii * (1.07, 0.95, 0.87), hair)
    nose = ellipsoid((0.0, 0.99 * deep, -0.12 * high), (0.014, 0.019, 0.024), skin, detail=1)
    mouth = ellipsoid((0.0, 0.88 * deep, -0.45 * high), (0.026, 0.008, 0.008), _lips(skin), 1)
    face = [nose, mouth]
    for side in (-1.0, 1.0):
        aside = side * 0.42 * wide
        face += [
            ellipsoid((aside, 0.885 * deep, 0.10 * high), (0.018, 0.008, 0.009), EYE_WHITE, 1),
            ellipsoid((aside, 0.930 * deep, 0.10 * high), (0.008, 0.006, 0.008), EYE, 1),
            ellipsoid((aside, 0.875 * deep, 0.27 * high), (0.022, 0.007, 0.005), hair, 1),
            ellipsoid((side * wide, -0.05 * deep, 0.0), (0.010, 0.020, 0.032), skin, 1),
        ]
    return join_surfaces([ellipsoid((0.0, 0.0, 0.0), radii, skin), cap, *face])


def _lips(skin: Rgb) -> Rgb:
    """The colour of the lips of somebody of this skin: between it and red."""
    red, green, blue = (round(0.55 * s + 0.45 * r) for s, r in zip(skin, LIP_RED, strict=True))
    return red, green, blue


def _right_hand(person: SimulatedPerson, colour: Rgb) -> Surface:
    """Half closed: the back of the hand, the fingers bent over the palm, the thumb."""
    size = person.height / 1.75
    back = ellipsoid((0.002, -0.005, 0.0), np.array([0.018, 0.070, 0.042]) * size, colour)
    fingers = ellipsoid((-0.026, 0.050, -0.002), np.array([0.030, 0.030, 0.038]) * size, colour)
    thumb = ellipsoid((-0.024, 0.030, 0.034), np.array([0.016, 0.042, 0.014]) * size, colour, 1)
    return join_surfaces([back, fingers, thumb])
