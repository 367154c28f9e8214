"""What a skeleton tracker makes of true joints.

It errs (skeleton_errors.py, skeleton_episodes.py), guesses what the body hides from the camera and
calls that inferred, smooths all of it (skeleton_filter.py), and now and then loses the person. The
sizes of all this are set in skeleton_noise_parameters.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from inhand_schemas.joints import PARENTS
from inhand_tracker.geometry.arrays import Array, Bytes, Flags, Indices

from inhand_lab.geometry.recursion import leaky_sum
from inhand_lab.people.person import SimulatedPerson
from inhand_lab.people.person_surface import LIMB_SOLIDS
from inhand_lab.sensing.noise_parameters import DEFAULT_NOISE
from inhand_lab.sensing.skeleton_episodes import FEET, flip_hands, lose_wrists, misread_ends
from inhand_lab.sensing.skeleton_errors import HANDS, inherited, mistake, speeds, stirring, wander
from inhand_lab.sensing.skeleton_filter import smooth
from inhand_lab.sensing.skeleton_noise_parameters import SkeletonNoise, SkeletonReadingNoise

MISSING, INFERRED, TRACKED = 0, 1, 2


@dataclass(frozen=True)
class SkeletonReading:
    """A tracker's reading: joints (T, 20, 3) in metres, states and confidences (T, 20).

    States are MISSING, INFERRED or TRACKED; confidences in [0, 1] reflect the error in part. Where
    the person is lost all joints are MISSING, without confidence, and as last seen.
    """

    joints: Array
    states: Bytes
    confidences: Array


def read_skeleton(
    person: SimulatedPerson,
    true_joints: Array,
    frame_rate: float,
    random: np.random.Generator,
    noise: SkeletonNoise = DEFAULT_NOISE.skeleton,
    covered: Flags | None = None,
) -> SkeletonReading:
    """The tracker's reading of joints (T, 20, 3) in the camera's frame.

    ``covered`` (T, 20) is which of them somebody else hides.
    """
    seen = _ends_as_seen(true_joints, noise.reading)
    speed = speeds(seen, frame_rate)
    hidden = hidden_joints(person, true_joints, noise.reading)
    if covered is not None:
        hidden |= covered
    guessed = _soften(hidden, frame_rate, noise.reading)
    widened = 1.0 + (noise.reading.guess_factor - 1.0) * guessed
    stirred = stirring(seen, frame_rate, noise.wandering)
    wandering = wander(random, stirred, frame_rate, noise.wandering)
    error = mistake(person.appearance, seen, noise.mistakes) + wandering
    raw = seen + error[:, :1] + widened[..., None] * inherited(error, seen, noise.wandering)
    raw = misread_ends(random, raw, frame_rate, noise.episodes)
    raw = flip_hands(random, raw, speed, frame_rate, noise.episodes)
    raw = lose_wrists(random, raw, speed, frame_rate, noise.episodes)
    joints = smooth(raw, guessed, noise.filter)
    states = np.where(guessed > 0.5, INFERRED, TRACKED).astype(np.uint8)
    away = np.linalg.norm(joints - seen, axis=2)
    confidences = _confidences(random, away, guessed, noise.reading)
    last_seen = _last_seen(random, len(joints), frame_rate, noise.reading)
    lost = last_seen < np.arange(len(joints))
    states[lost], confidences[lost] = MISSING, 0.0
    return SkeletonReading(joints[last_seen], states, confidences)


def _ends_as_seen(joints: Array, noise: SkeletonReadingNoise) -> Array:
    """Joints (T, 20, 3) with hands and feet where on their bones a Kinect puts them."""
    seen = joints.copy()
    for ends, share in ((HANDS, noise.seen_hand), (FEET, noise.seen_foot)):
        for end in ends:
            root = joints[:, PARENTS[end]]
            seen[:, end] = root + share * (joints[:, end] - root)
    return seen


def _confidences(
    random: np.random.Generator, error: Array, guessed: Array, noise: SkeletonReadingNoise
) -> Array:
    """Confidences (T, 20) of a tracker that has an inkling of its errors (T, 20), in metres."""
    surprise = np.minimum(error / noise.surprise, 1.0)
    confidence = (
        noise.confidence
        - noise.confidence_less_guessed * guessed
        - noise.confidence_less_surprise * surprise
        + noise.confidence_deviation * random.normal(size=error.shape)
    )
    return np.clip(confidence, noise.least_confidence, 1.0)


def _last_seen(
    random: np.random.Generator, count: int, frame_rate: float, noise: SkeletonReadingNoise
) -> Indices:
    """The last frame (T,) up to each in which the person is not lost; never lost at first."""
    losses = random.random(count) < 1.0 / (noise.seconds_between_losses * frame_rate)
    lost = np.zeros(count, bool)
    for start in np.flatnonzero(losses):
        length = 1 + random.geometric(min(1.0 / (noise.seconds_lost * frame_rate), 1.0))
        lost[max(start, 1) : start + length] = True
    return np.maximum.accumulate(np.where(lost, 0, np.arange(count)))


def hidden_joints(person: SimulatedPerson, joints: Array, noise: SkeletonReadingNoise) -> Flags:
    """Whether (T, 20) another limb or the trunk stands between a joint and the camera."""
    hidden = np.zeros(joints.shape[:2], bool)
    for parent, child, radius in _capsules(person):
        covered = _crosses(joints, joints[:, parent], joints[:, child], radius, noise)
        covered[:, [parent, child]] = False
        hidden |= covered
    return hidden


def joints_behind(
    person: SimulatedPerson,
    body: Array,
    joints: Array,
    noise: SkeletonReadingNoise = DEFAULT_NOISE.skeleton.reading,
) -> Flags:
    """Whether (T, 20) a person with joints ``body`` (T, 20, 3) hides the joints (T, 20, 3) of
    somebody else from the camera."""
    hidden = np.zeros(joints.shape[:2], bool)
    for parent, child, radius in _capsules(person):
        hidden |= _crosses(joints, body[:, parent], body[:, child], radius, noise)
    return hidden


def _capsules(person: SimulatedPerson) -> list[tuple[int, int, float]]:
    """A person's trunk and limbs: two joints and the radius about the line between them, metres."""
    trunk = (0, 2, 0.065, 0.065)
    return [
        (parent, child, 0.5 * (root + tip) * person.height * person.girth)
        for parent, child, root, tip in [trunk, *(limb[:4] for limb in LIMB_SOLIDS)]
    ]


def _crosses(
    joints: Array, start: Array, end: Array, radius: float, noise: SkeletonReadingNoise
) -> Flags:
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
    touched = np.linalg.norm(gap, axis=2) < noise.cover * radius
    before = (1.0 - along) * np.sqrt(sight_sight) > radius + noise.clearance
    return np.logical_and(touched, before)


def _soften(hidden: Flags, frame_rate: float, noise: SkeletonReadingNoise) -> Array:
    """Shares (T, 20), 0 to 1, by which the tracker has gone over from seeing to guessing."""
    kept = np.exp(-1.0 / (frame_rate * noise.hesitation))
    values = hidden.astype(float)
    return leaky_sum((1.0 - kept) * values, kept, values[0])
