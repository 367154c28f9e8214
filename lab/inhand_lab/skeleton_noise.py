"""What a skeleton tracker makes of true joints.

Errors are slow, as the tracker's own filter leaves them: a second-order Ornstein-Uhlenbeck process
per joint, larger towards the hands and feet and in fast motion. Where the body hides a joint from
the camera the tracker guesses: the error is larger and the joint is called inferred. In the eight
people of UTD-MHAD bones vary by 3 % (trunk, legs) to 8 % (arms) and the hand by 36 %.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from inhand_lab.figure import LIMBS
from inhand_lab.person import Person
from inhand_lab.transforms import Floats

MISSING, INFERRED, TRACKED = 0, 1, 2

DEVIATIONS = 1e-3 * np.array(
    [8, 8, 9, 9, 12, 16, 18, 22, 12, 16, 18, 22, 10, 13, 14, 18, 10, 13, 14, 18], float
)
"""Deviation of a tracked joint's error along each axis, metres, in the order of Joint."""

MEMORY = 0.35
"""Correlation time of errors, seconds."""
SMOOTHING = 0.08
"""Time constant of the tracker's own filter, seconds."""
WHITE = 0.0006
GUESS_FACTOR = 3.5
"""How much larger the error of an inferred joint is."""
CLEARANCE = 0.05
"""A limb hides a joint only from at least this far in front of it, metres."""
FAST = 1.2
"""Speed of a joint, metres a second, at which its error has doubled."""


@dataclass(frozen=True)
class SkeletonReading:
    """What the tracker says: joints (T, 20, 3) in metres, states (T, 20) as MISSING, INFERRED or
    TRACKED, confidences (T, 20) in [0, 1], which know of the error but not all."""

    joints: Floats
    states: NDArray[np.uint8]
    confidences: Floats


def read_skeleton(
    person: Person, true_joints: Floats, frame_rate: float, random: np.random.Generator
) -> SkeletonReading:
    """The tracker's reading of joints (T, 20, 3) in the camera's frame."""
    shape = true_joints.shape
    hidden = _soften(hidden_joints(person, true_joints), frame_rate)
    travelled = np.diff(true_joints, axis=0, prepend=true_joints[:1])
    speed = np.linalg.norm(travelled, axis=2) * frame_rate
    size = DEVIATIONS * (1.0 + speed / FAST) * (1.0 + (GUESS_FACTOR - 1.0) * hidden)
    error = size[..., None] * _wander(random, shape, frame_rate)
    joints = true_joints + error + WHITE * random.normal(size=shape)
    states = np.where(hidden > 0.5, INFERRED, TRACKED).astype(np.uint8)
    surprise = np.linalg.norm(error, axis=2) / (3.0 * DEVIATIONS * np.sqrt(3.0))
    opinion = 0.95 - 0.45 * hidden - 0.25 * surprise + 0.06 * random.normal(size=shape[:2])
    return SkeletonReading(joints, states, np.clip(opinion, 0.05, 1.0))


def hidden_joints(person: Person, joints: Floats) -> NDArray[np.bool_]:
    """Whether (T, 20) another limb or the trunk stands between a joint and the camera."""
    hidden = np.zeros(joints.shape[:2], bool)
    trunk = (0, 2, 0.065, 0.065)
    for parent, child, root, tip in [trunk, *(limb[:4] for limb in LIMBS)]:
        radius = 0.5 * (root + tip) * person.height * person.girth
        covered = _crosses(joints, joints[:, parent], joints[:, child], radius)
        covered[:, [parent, child]] = False
        hidden |= covered
    return hidden


def _crosses(joints: Floats, start: Floats, end: Floats, radius: float) -> NDArray[np.bool_]:
    """Whether (T, 20) the line of sight to a joint passes a capsule well in front of the joint.

    The capsule's axis is from start to end (T, 3). The nearest points of two lines after
    Ericson, *Real-Time Collision Detection*, section 5.1.9.
    """
    axis = (end - start)[:, None]
    offset = -start[:, None]
    sight_sight = np.sum(joints**2, axis=2)
    axis_axis = np.sum(axis**2, axis=2)
    sight_axis = np.sum(joints * axis, axis=2)
    sight_offset = np.sum(joints * offset, axis=2)
    axis_offset = np.sum(axis * offset, axis=2)
    spread = np.maximum(sight_sight * axis_axis - sight_axis**2, 1e-12)
    along = np.clip((sight_axis * axis_offset - sight_offset * axis_axis) / spread, 0.0, 1.0)
    share = np.clip((sight_axis * along + axis_offset) / axis_axis, 0.0, 1.0)
    along = np.clip((sight_axis * share - sight_offset) / sight_sight, 0.0, 1.0)
    gap = along[..., None] * joints - start[:, None] - share[..., None] * axis
    touched = np.linalg.norm(gap, axis=2) < 0.8 * radius
    before = (1.0 - along) * np.sqrt(sight_sight) > radius + CLEARANCE
    return np.logical_and(touched, before)


def _soften(hidden: NDArray[np.bool_], frame_rate: float) -> Floats:
    """How far (T, 20), 0 to 1, the tracker has gone over from seeing to guessing."""
    kept = np.exp(-1.0 / (frame_rate * SMOOTHING))
    values = hidden.astype(float)
    softened, _ = lfilter([1.0 - kept], [1.0, -kept], values, axis=0, zi=kept * values[:1])
    return np.asarray(softened)


def _wander(random: np.random.Generator, shape: tuple[int, ...], frame_rate: float) -> Floats:
    """A second-order Ornstein-Uhlenbeck process along the first axis, of unit deviation."""
    slow, fast = (np.exp(-1.0 / (frame_rate * constant)) for constant in (MEMORY, SMOOTHING))
    first, second = slow + fast, -slow * fast
    variance = (1.0 - second) / ((1.0 + second) * ((1.0 - second) ** 2 - first**2))
    settling = int(6.0 * MEMORY * frame_rate)
    pushes = random.normal(size=(settling + shape[0], *shape[1:])) / np.sqrt(variance)
    return np.asarray(lfilter([1.0], [1.0, -first, -second], pushes, axis=0)[settling:])
