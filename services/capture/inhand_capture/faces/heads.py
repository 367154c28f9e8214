"""The heads of bodies: of those that a network finds in a picture, and of skeletons in space."""

import numpy as np
from inhand_schemas.joints import Joint
from inhand_schemas.messages import CameraInfo, Person

from inhand_capture.estimation.found_person import Floats, FoundPerson
from inhand_capture.estimation.parameters import DEFAULT_LIFTING
from inhand_capture.faces.discs import Disc
from inhand_capture.faces.parameters import FaceParameters

SHOULDERS = (Joint.SHOULDER_LEFT, Joint.SHOULDER_RIGHT)
HIPS = (Joint.HIP_LEFT, Joint.HIP_RIGHT)
LIMBS = (
    (Joint.SHOULDER_LEFT, Joint.ELBOW_LEFT, DEFAULT_LIFTING.upper_arm),
    (Joint.SHOULDER_RIGHT, Joint.ELBOW_RIGHT, DEFAULT_LIFTING.upper_arm),
    (Joint.HIP_LEFT, Joint.KNEE_LEFT, DEFAULT_LIFTING.thigh),
    (Joint.HIP_RIGHT, Joint.KNEE_RIGHT, DEFAULT_LIFTING.thigh),
)
"""Ends of limbs, and their usual lengths in trunks."""
NEAREST_M = 0.1
"""Distance of a head from the camera, metres, at which one that is nearer is taken to be."""


def head_of(person: FoundPerson, parameters: FaceParameters) -> Disc | None:
    """Return what to hide of somebody whom a network found; None where no head can be said."""
    shoulders, hips = (person.pixels[list(pair)].mean(axis=0) for pair in (SHOULDERS, HIPS))
    head = person.pixels[Joint.HEAD]
    if not np.isfinite(head).all():
        head = hips + DEFAULT_LIFTING.head * (shoulders - hips)
    metre = pixels_of_a_metre(person.pixels, parameters)
    if not np.isfinite(head).all() or not np.isfinite(metre):
        return None
    return Disc(float(head[0]), float(head[1]), parameters.head_radius_m * metre)


def pixels_of_a_metre(pixels: Floats, parameters: FaceParameters) -> float:
    """Return the pixels of a metre at the place of somebody's joints (20, 2), by their least
    foreshortened part; NaN where none is known."""
    shoulders, hips = (pixels[list(pair)].mean(axis=0) for pair in (SHOULDERS, HIPS))
    trunk = shoulders - hips
    usual = DEFAULT_LIFTING.usual_trunk_m
    across = pixels[SHOULDERS[0]] - pixels[SHOULDERS[1]]
    sizes = [
        np.linalg.norm(trunk) / usual,
        np.linalg.norm(across) / parameters.usual_shoulders_m,
        *(np.linalg.norm(pixels[a] - pixels[b]) / (length * usual) for a, b, length in LIMBS),
    ]
    return float(np.fmax.reduce(sizes))


def head_of_skeleton(person: Person, info: CameraInfo, parameters: FaceParameters) -> Disc | None:
    """Return what to hide of a skeleton in space; None where its head is missing, or behind."""
    if person.states[Joint.HEAD] == "missing":
        return None
    x, y, z = person.joints[Joint.HEAD]
    if z <= 0.0:
        return None
    z = max(z, NEAREST_M)
    focal = max(info.fx, info.fy)
    return Disc(
        info.fx * x / z + info.cx, info.fy * y / z + info.cy, focal * parameters.head_radius_m / z
    )
