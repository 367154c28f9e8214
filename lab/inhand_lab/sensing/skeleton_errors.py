"""How a skeleton tracker errs before its filter: from frame to frame and from bone to bone.

A tracker errs by pose: what it takes for the elbow changes as the arm moves, hardly while it
rests, and is the same again when the arm comes back. So it is with the trunk, which also depends on
where the arms are. On top of that errors wander, in calm spells and busy ones, as the body is
stirred rather than with time: by how a joint moves against its parent and by how much is moving at
all. They grow in movement and shrink again after it, joints slide along bones rather than off them,
and have a part of their parents' errors.
"""

from __future__ import annotations

import numpy as np
from inhand_schemas.joints import PARENTS, Joint
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.recursion import leaky_sum
from inhand_lab.sensing.skeleton_noise_parameters import PoseMistakes, WanderingErrors

TRUNK_JOINTS = (
    Joint.SPINE,
    Joint.SHOULDER_CENTER,
    Joint.HEAD,
    Joint.HIP_LEFT,
    Joint.HIP_RIGHT,
)
ARM_JOINTS = (Joint.ELBOW_LEFT, Joint.WRIST_LEFT, Joint.ELBOW_RIGHT, Joint.WRIST_RIGHT)
"""Joints on which mistakes of the trunk depend too: arms hide and lift it."""
HANDS = (Joint.HAND_LEFT, Joint.HAND_RIGHT)


def speeds(joints: Array, frame_rate: float) -> Array:
    """Speeds (T, J) at which joints (T, J, 3) come, m/s."""
    steps = np.diff(joints, axis=0, prepend=joints[:1])
    return np.asarray(np.linalg.norm(steps, axis=2) * frame_rate)


def mistake(person: int, joints: Array, noise: PoseMistakes) -> Array:
    """Mistakes (T, 20, 3) about joints (T, 20, 3), in metres, that depend on the pose.

    They are the same whenever this person, a number, is in the same pose, and nearly the same in a
    similar one.

    A Gaussian process over the place of each joint as seen from the hips, to which the arms' is
    added for the trunk, made of random waves (Rahimi & Recht, *Random Features for Large-Scale
    Kernel Machines*, 2007).
    """
    random = np.random.default_rng([0x71AC, person])
    place = joints - joints[:, :1]
    place[:, TRUNK_JOINTS] += place[:, ARM_JOINTS].mean(axis=1, keepdims=True)
    place /= noise.similar.column
    waves = random.normal(size=(20, noise.waves, 3))
    phases = random.uniform(0.0, 2.0 * np.pi, (20, noise.waves, 3))
    angles = np.einsum("tjk,jwk->tjw", place, waves)[..., None] + phases
    deviations = 1e-3 * noise.deviations_mm.column
    mistakes = deviations * np.sqrt(2.0 / noise.waves) * np.cos(angles).sum(axis=2)
    for end in HANDS:
        bone = joints[:, end] - joints[:, PARENTS[end]]
        length = np.linalg.norm(bone, axis=1, keepdims=True)
        along = np.sum(mistakes[:, end] * bone, axis=1, keepdims=True) / length
        aside = mistakes[:, end] - bone * (along / length)
        mistakes[:, end] = noise.across * aside + bone * (np.exp(along / length) - 1.0)
    return np.asarray(mistakes)


def stirring(joints: Array, frame_rate: float, noise: WanderingErrors) -> Array:
    """Speeds (T, 20) by which joints (T, 20, 3) disturb the tracker, m/s."""
    against = joints - joints[:, PARENTS]
    against[:, 0] = joints[:, 0]
    own = speeds(against, frame_rate)
    speed = own + noise.shared * own.mean(axis=1, keepdims=True)
    return np.asarray(speed / (1.0 + speed / noise.most_stirred))


def wander(
    random: np.random.Generator, speed: Array, frame_rate: float, noise: WanderingErrors
) -> Array:
    """Errors (T, 20, 3) in metres of joints that are stirred as by speeds (T, 20)."""
    busy = _busyness(random, speed.shape, frame_rate, noise)
    noticed = speed * (speed / (speed + noise.creep)) ** 2
    elapsed = busy * (1.0 / noise.memory_at_rest + noticed / noise.way) / frame_rate
    kept = np.exp(-elapsed)[..., None]
    unit = np.sqrt((noise.tails - 2.0) / noise.tails)
    pushes = unit * random.standard_t(noise.tails, (*speed.shape, 3)) * np.sqrt(1.0 - kept**2)
    errors = np.empty_like(pushes)
    error = random.normal(size=pushes.shape[1:])
    for frame in range(len(pushes)):
        errors[frame] = error = kept[frame] * error + pushes[frame]
    grown = noise.at_rest + (1.0 - noise.at_rest) * np.minimum(speed / noise.in_movement, 1.0)
    deviations = 1e-3 * noise.deviations_mm.column
    return np.asarray(errors * deviations * grown[..., None])


def inherited(errors: Array, joints: Array, noise: WanderingErrors) -> Array:
    """Errors (T, 20, 3) of joints (T, 20, 3), less across their bones than along them.

    Each joint has a part of its parent's; the hip centre's are left out, for they are the whole
    body's.
    """
    bones = joints - joints[:, PARENTS]
    bones /= np.maximum(np.linalg.norm(bones, axis=2, keepdims=True), 1e-6)
    along = bones * np.sum(errors * bones, axis=2, keepdims=True)
    whole = along + noise.aside.column * (errors - along)
    whole[:, 0] = 0.0
    shares = noise.inherited.column
    for joint, parent in enumerate(PARENTS):
        if parent >= 0:
            whole[:, joint] += shares[joint] * whole[:, parent]
    return np.asarray(whole)


def _busyness(
    random: np.random.Generator, shape: tuple[int, ...], frame_rate: float, noise: WanderingErrors
) -> Array:
    """Values (T, ...) of a log-normal process of median 1 along time, without a bound.

    A bound of 40, which 30 % of the values exceed, was tried: `inhand simulate --realism` then has
    13 of its 132 judged properties off by more than a factor of 1.5, and none without it.
    """
    kept = np.exp(-1.0 / (frame_rate * noise.spell))
    start = random.normal(size=shape[1:])
    pushes = np.sqrt(1.0 - kept**2) * random.normal(size=shape)
    return np.exp(noise.busyness * leaky_sum(pushes, kept, start))
