"""How a skeleton tracker errs before its filter: from frame to frame and from bone to bone.

A tracker errs by pose: what it takes for the elbow changes as the arm moves, hardly while it
rests, and is the same again when the arm comes back. So it is with the trunk, which also depends on
where the arms are. On top of that errors wander, in calm spells and busy ones, as the body is
stirred rather than with time: by how a joint moves against its parent and by how much is moving at
all. They grow in movement and shrink again after it, joints slide along bones rather than off them,
and have a part of their parents' errors. Hands and feet, small as they are, are now and then seen
turned or cut short, a hand flips, and a fast wrist stays behind or leaves the arm. Sizes were found
by the realism table; none was chosen for what a method makes of it.
"""

from __future__ import annotations

import numpy as np
from inhand_schemas.joints import PARENTS, Joint
from inhand_tracker.geometry.arrays import Array, Indices
from scipy.spatial.transform import Rotation

from inhand_lab.geometry.recursion import leaky_sum

_ARM, _LEG = (1.1, 20, 1.1, 13), (7.2, 13, 10, 6.3)
MISTAKES = 1e-3 * np.array([0, 5, 10, 0.8, *_ARM, *_ARM, *_LEG, *_LEG], float)
"""Deviation, along each axis and over all poses, of where a joint is taken to be, metres, in the
order of Joint."""
_ARM_SIMILAR, _LEG_SIMILAR = (0.092, 0.051, 0.035, 0.04), (0.11, 0.005, 0.026, 0.04)
SIMILAR = np.array(
    [0.085, 0.096, 0.16, 0.18, *_ARM_SIMILAR, *_ARM_SIMILAR, *_LEG_SIMILAR, *_LEG_SIMILAR]
)
"""How far, in metres, a joint must go from the hips' point of view to be mistaken otherwise."""
ACROSS = 0.10
"""A hand is seen too short or too long rather than turned: that share of the mistake is aside."""
TRUNK = (Joint.SPINE, Joint.SHOULDER_CENTER, Joint.HEAD, Joint.HIP_LEFT, Joint.HIP_RIGHT)
ARMS = (Joint.ELBOW_LEFT, Joint.WRIST_LEFT, Joint.ELBOW_RIGHT, Joint.WRIST_RIGHT)
"""What joints of the trunk are taken for depends on where these are too: arms hide and lift it."""
WAVES = 12
"""Waves that a mistake is made of."""

_ARM_WANDERING, _LEG_WANDERING = (10, 18.5, 6.7, 15.3), (8.3, 19, 10, 2.8)
DEVIATIONS = 1e-3 * np.array(
    [5.5, 5.8, 16.5, 7.5, *_ARM_WANDERING, *_ARM_WANDERING, *_LEG_WANDERING, *_LEG_WANDERING], float
)
"""Deviation of a joint's wandering error along each axis, metres."""
SHARED = 0.52
"""How much the mean of all joints' movement stirs each one."""
MOST_STIRRED = 1.55
"""Speed, metres a second, that no joint seems to go beyond."""
AT_REST, IN_MOVEMENT = 0.023, 0.103
"""Share of the deviation that an error has at rest, and the speed at which it has all of it."""
WAY = 4.6
"""Way in metres over which a wandering error is forgotten."""
CREEP = 0.043
"""Speed, metres a second, at which the tracker begins to take notice: slower counts for less."""
_ARM_INHERITED, _LEG_INHERITED = (0.13, 0.16, 0.39, 0.25), (0.27, 0.25, 0.13, 0.39)
INHERITED = np.array(
    [0, 0.25, 0.099, 0.33, *_ARM_INHERITED, *_ARM_INHERITED, *_LEG_INHERITED, *_LEG_INHERITED]
)
"""Share of its parent's error that a joint has as well."""
_ARM_ASIDE, _LEG_ASIDE = (0.068, 0.052, 2, 0.57), (0.042, 0.047, 0.39, 0.18)
ASIDE = np.array([1.0, 0.028, 0.034, 0.16, *_ARM_ASIDE, *_ARM_ASIDE, *_LEG_ASIDE, *_LEG_ASIDE])
"""How much of an error is left across the bone: joints slide along limbs rather than off them, but
for wrists."""
MEMORY_AT_REST = 10.0
"""Seconds in which the error of a joint at rest is forgotten."""
SPELL = 0.083
"""Correlation time of busy spells, seconds."""
BUSYNESS, BUSIEST = 7.0, 40.0
"""Deviation of the logarithm of how busy the error is, and how many times its median at most: it
is calm or very busy, and hardly ever in between."""
TAILS = 3.0
"""Degrees of freedom of Student's t: the errors' steps have long tails."""

HANDS, FEET = (Joint.HAND_LEFT, Joint.HAND_RIGHT), (Joint.FOOT_LEFT, Joint.FOOT_RIGHT)
END_RATE = {"hand": 5.3, "foot": 8.4}
"""Misreadings of hand or foot a second."""
END_TURN = {"hand": 0.08, "foot": 0.30}
"""Deviation of the turn about each axis, radians."""
END_STRETCH = {"hand": 0.38, "foot": 0.14}
"""Deviation of the logarithm of the bone's stretching."""
END_STAY = 0.04
"""Chance that one lasts on to the next frame, as other episodes' STAY."""

FLIP_RATE, FLIP_RATE_MOVING, FLIP_STAY = 0.09, 0.28, 0.22
"""Flips of a hand a second, at rest and more for each metre a second."""

FAILURE_RATE, FAILURE_STAY = 2.4, 0.5
"""Failures of a wrist a second, for each metre a second above CALM and below WILD."""
CALM, WILD = 0.2, 0.6
STUCK_SHARE = 0.4
ASTRAY = 0.115
"""Deviation along each axis, metres, of a wrist that has left its arm."""


def speeds(joints: Array, frame_rate: float) -> Array:
    """How fast (T, J) joints (T, J, 3) come, metres a second."""
    steps = np.diff(joints, axis=0, prepend=joints[:1])
    return np.asarray(np.linalg.norm(steps, axis=2) * frame_rate)


def mistake(person: int, joints: Array) -> Array:
    """What a tracker takes joints (T, 20, 3) wrongly by, in metres: the same whenever this person,
    told by a number, is in the same pose, and nearly the same in a similar one.

    A Gaussian process over the place of each joint as seen from the hips, to which the arms' is
    added for the trunk, made of random waves (Rahimi & Recht, *Random Features for Large-Scale
    Kernel Machines*, 2007).
    """
    random = np.random.default_rng([0x71AC, person])
    place = joints - joints[:, :1]
    place[:, TRUNK] += place[:, ARMS].mean(axis=1, keepdims=True)
    place /= SIMILAR[:, None]
    waves = random.normal(size=(20, WAVES, 3))
    phases = random.uniform(0.0, 2.0 * np.pi, (20, WAVES, 3))
    angles = np.einsum("tjk,jwk->tjw", place, waves)[..., None] + phases
    mistakes = MISTAKES[:, None] * np.sqrt(2.0 / WAVES) * np.cos(angles).sum(axis=2)
    for end in HANDS:
        bone = joints[:, end] - joints[:, PARENTS[end]]
        length = np.linalg.norm(bone, axis=1, keepdims=True)
        along = np.sum(mistakes[:, end] * bone, axis=1, keepdims=True) / length
        aside = mistakes[:, end] - bone * (along / length)
        mistakes[:, end] = ACROSS * aside + bone * (np.exp(along / length) - 1.0)
    return np.asarray(mistakes)


def stirring(joints: Array, frame_rate: float) -> Array:
    """How much (T, 20) joints (T, 20, 3) disturb the tracker, as a speed in metres a second."""
    against = joints - joints[:, PARENTS]
    against[:, 0] = joints[:, 0]
    own = speeds(against, frame_rate)
    speed = own + SHARED * own.mean(axis=1, keepdims=True)
    return np.asarray(speed / (1.0 + speed / MOST_STIRRED))


def wander(random: np.random.Generator, speed: Array, frame_rate: float) -> Array:
    """Errors (T, 20, 3) in metres of joints that are stirred as by speeds (T, 20)."""
    busy = _busyness(random, speed.shape, frame_rate)
    noticed = speed * (speed / (speed + CREEP)) ** 2
    elapsed = busy * (1.0 / MEMORY_AT_REST + noticed / WAY) / frame_rate
    kept = np.exp(-elapsed)[..., None]
    unit = np.sqrt((TAILS - 2.0) / TAILS)
    pushes = unit * random.standard_t(TAILS, (*speed.shape, 3)) * np.sqrt(1.0 - kept**2)
    errors = np.empty_like(pushes)
    error = random.normal(size=pushes.shape[1:])
    for frame in range(len(pushes)):
        errors[frame] = error = kept[frame] * error + pushes[frame]
    grown = AT_REST + (1.0 - AT_REST) * np.minimum(speed / IN_MOVEMENT, 1.0)
    return np.asarray(errors * DEVIATIONS[:, None] * grown[..., None])


def inherited(errors: Array, joints: Array) -> Array:
    """Errors (T, 20, 3) of joints (T, 20, 3), less across their bones than along them, with what
    each joint has of its parent's; without the hip centre's, which are the whole body's."""
    bones = joints - joints[:, PARENTS]
    bones /= np.maximum(np.linalg.norm(bones, axis=2, keepdims=True), 1e-6)
    along = bones * np.sum(errors * bones, axis=2, keepdims=True)
    whole = along + ASIDE[:, None] * (errors - along)
    whole[:, 0] = 0.0
    for joint, parent in enumerate(PARENTS):
        if parent >= 0:
            whole[:, joint] += INHERITED[joint] * whole[:, parent]
    return np.asarray(whole)


def misread_ends(random: np.random.Generator, joints: Array, frame_rate: float) -> Array:
    """The joints (T, 20, 3) with hands and feet that are now and then turned or cut short."""
    misread = joints.copy()
    for end in (*HANDS, *FEET):
        kind = "hand" if end in HANDS else "foot"
        # Some people's hands and feet stand out, others' are lost in sleeves and in the floor.
        chance = np.full(len(joints), random.exponential() * END_RATE[kind] / frame_rate)
        begun = _episodes(random, np.minimum(chance, 0.5), END_STAY)
        turns = Rotation.from_rotvec(END_TURN[kind] * random.normal(size=(len(joints), 3)))
        stretch = np.exp(END_STRETCH[kind] * random.normal(size=(len(joints), 1)))
        wrong = begun >= 0
        root = joints[wrong, PARENTS[end]]
        bone = turns[begun[wrong]].apply(joints[wrong, end] - root)
        misread[wrong, end] = root + stretch[begun[wrong]] * bone
    return misread


def flip_hands(
    random: np.random.Generator, joints: Array, speed: Array, frame_rate: float
) -> Array:
    """The joints (T, 20, 3) with hands that now and then point back along the forearm."""
    flipped = joints.copy()
    for hand in HANDS:
        rate = FLIP_RATE + FLIP_RATE_MOVING * speed[:, hand]
        back = _episodes(random, np.minimum(rate / frame_rate, 0.5), FLIP_STAY) >= 0
        wrist = joints[back, PARENTS[hand]]
        flipped[back, hand] = 2.0 * wrist - joints[back, hand]
    return flipped


def lose_wrists(
    random: np.random.Generator, joints: Array, speed: Array, frame_rate: float
) -> Array:
    """The joints (T, 20, 3) with fast wrists that stay behind or leave the arm, hands with them."""
    lost = joints.copy()
    for wrist, hand in (
        (Joint.WRIST_LEFT, Joint.HAND_LEFT),
        (Joint.WRIST_RIGHT, Joint.HAND_RIGHT),
    ):
        rate = FAILURE_RATE * (np.clip(speed[:, wrist], CALM, WILD) - CALM)
        begun = _episodes(random, np.minimum(rate / frame_rate, 0.5), FAILURE_STAY)
        stuck = random.random(len(joints)) < STUCK_SHARE
        astray = ASTRAY * random.normal(size=(len(joints), 3))
        behind = (begun >= 0) & stuck[begun]
        away = (begun >= 0) & ~stuck[begun]
        for joint in (wrist, hand):
            lost[behind, joint] = joints[np.maximum(begun[behind] - 1, 0), joint]
            lost[away, joint] += astray[begun[away]]
    return lost


def _busyness(random: np.random.Generator, shape: tuple[int, ...], frame_rate: float) -> Array:
    """A log-normal process along the first axis, of median 1 and at most BUSIEST."""
    kept = np.exp(-1.0 / (frame_rate * SPELL))
    start = random.normal(size=shape[1:])
    pushes = np.sqrt(1.0 - kept**2) * random.normal(size=shape)
    return np.exp(BUSYNESS * leaky_sum(pushes, kept, start))


def _episodes(random: np.random.Generator, chance: Array, stay: float) -> Indices:
    """For each frame the one in which the episode that it is in began, -1 outside.

    An episode begins with the chance (T,) of its frame, and lasts on with the chance stay.
    """
    begins, stays = random.random(len(chance)) < chance, random.random(len(chance)) < stay
    begun = np.full(len(chance), -1, np.int64)
    for frame in range(len(chance)):
        if frame > 0 and begun[frame - 1] >= 0 and stays[frame]:
            begun[frame] = begun[frame - 1]
        elif begins[frame]:
            begun[frame] = frame
    return begun
