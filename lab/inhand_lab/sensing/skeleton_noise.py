"""What a skeleton tracker makes of true joints.

It errs as skeleton_errors tells, guesses what the body hides from the camera, calls that inferred,
and smooths all of it with tracker_filter. The sizes of errors are those of the eight people of
UTD-MHAD, who were filmed by a Kinect (`inhand simulate --realism` prints both side by side). Their
recordings hold no confidences and no losses; what is assumed of these stands here.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from inhand_schemas.joints import PARENTS, Joint
from inhand_tracker.geometry.arrays import Array, Bytes, Flags, Indices

from inhand_lab.geometry.recursion import leaky_sum
from inhand_lab.people.person import SimulatedPerson
from inhand_lab.people.person_surface import LIMB_SOLIDS
from inhand_lab.sensing.skeleton_errors import (
    flip_hands,
    inherited,
    lose_wrists,
    misread_ends,
    mistake,
    speeds,
    stirring,
    wander,
)
from inhand_lab.sensing.skeleton_filter import smooth

MISSING, INFERRED, TRACKED = 0, 1, 2

SEEN_SHARE = {
    Joint.HAND_LEFT: 0.85,
    Joint.HAND_RIGHT: 0.85,
    Joint.FOOT_LEFT: 0.5,
    Joint.FOOT_RIGHT: 0.5,
}
"""Where on its bone a Kinect puts the end: short of the palm, and on the instep."""
GUESS_FACTOR = 3.0
"""How much larger the error of an inferred joint is."""
HESITATION = 0.08
"""Time constant, seconds, of going over from seeing to guessing."""
CLEARANCE = 0.05
"""A limb hides a joint only from at least this far in front of it, metres."""
SECONDS_BETWEEN_LOSSES, SECONDS_LOST = 120.0, 0.25
"""How rarely the whole person is lost, and for how long, on average."""


@dataclass(frozen=True)
class SkeletonReading:
    """What the tracker says: joints (T, 20, 3) in metres, states (T, 20) as MISSING, INFERRED or
    TRACKED, confidences (T, 20) in [0, 1], which know of the error but not all.

    Where the person is lost all joints are MISSING, without confidence, and as last seen.
    """

    joints: Array
    states: Bytes
    confidences: Array


def read_skeleton(
    person: SimulatedPerson, true_joints: Array, frame_rate: float, random: np.random.Generator
) -> SkeletonReading:
    """The tracker's reading of joints (T, 20, 3) in the camera's frame."""
    seen = true_joints.copy()
    for end, share in SEEN_SHARE.items():
        root = true_joints[:, PARENTS[end]]
        seen[:, end] = root + share * (true_joints[:, end] - root)
    speed = speeds(seen, frame_rate)
    guessed = _soften(hidden_joints(person, true_joints), frame_rate)
    widened = 1.0 + (GUESS_FACTOR - 1.0) * guessed
    error = mistake(person.appearance, seen) + wander(
        random, stirring(seen, frame_rate), frame_rate
    )
    raw = seen + error[:, :1] + widened[..., None] * inherited(error, seen)
    raw = misread_ends(random, raw, frame_rate)
    raw = flip_hands(random, raw, speed, frame_rate)
    raw = lose_wrists(random, raw, speed, frame_rate)
    joints = smooth(raw, guessed)
    states = np.where(guessed > 0.5, INFERRED, TRACKED).astype(np.uint8)
    confidences = _opinion(random, np.linalg.norm(joints - seen, axis=2), guessed)
    last_seen = _last_seen(random, len(joints), frame_rate)
    lost = last_seen < np.arange(len(joints))
    states[lost], confidences[lost] = MISSING, 0.0
    return SkeletonReading(joints[last_seen], states, confidences)


def _opinion(random: np.random.Generator, error: Array, guessed: Array) -> Array:
    """Confidences (T, 20) by a tracker that has an inkling of its errors (T, 20), in metres."""
    surprise = np.minimum(error / 0.05, 1.0)
    opinion = 0.95 - 0.40 * guessed - 0.35 * surprise + 0.08 * random.normal(size=error.shape)
    return np.clip(opinion, 0.05, 1.0)


def _last_seen(random: np.random.Generator, count: int, frame_rate: float) -> Indices:
    """For each frame the last one (T,) in which the person was not lost; never lost at first."""
    losses = random.random(count) < 1.0 / (SECONDS_BETWEEN_LOSSES * frame_rate)
    lost = np.zeros(count, bool)
    for start in np.flatnonzero(losses):
        length = 1 + random.geometric(min(1.0 / (SECONDS_LOST * frame_rate), 1.0))
        lost[max(start, 1) : start + length] = True
    return np.maximum.accumulate(np.where(lost, 0, np.arange(count)))


def hidden_joints(person: SimulatedPerson, joints: Array) -> Flags:
    """Whether (T, 20) another limb or the trunk stands between a joint and the camera."""
    hidden = np.zeros(joints.shape[:2], bool)
    trunk = (0, 2, 0.065, 0.065)
    for parent, child, root, tip in [trunk, *(limb[:4] for limb in LIMB_SOLIDS)]:
        radius = 0.5 * (root + tip) * person.height * person.girth
        covered = _crosses(joints, joints[:, parent], joints[:, child], radius)
        covered[:, [parent, child]] = False
        hidden |= covered
    return hidden


def _crosses(joints: Array, start: Array, end: Array, radius: float) -> Flags:
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


def _soften(hidden: Flags, frame_rate: float) -> Array:
    """How far (T, 20), 0 to 1, the tracker has gone over from seeing to guessing."""
    kept = np.exp(-1.0 / (frame_rate * HESITATION))
    values = hidden.astype(float)
    return leaky_sum((1.0 - kept) * values, kept, values[0])
