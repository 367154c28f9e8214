"""Simulated people who use nothing: they stand about, or walk, before the same skeleton tracker.

Those who fidget move their hands anywhere: recognition learns from them, and from people who walk,
what using nothing looks like. Those who gesture touch their faces, cross their arms and so on; of
them nobody learns.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, get_args

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import Transform, normalised, rotation_about, rotation_from_axes
from inhand_lab.motions.performance import (
    ContactKind,
    Stance,
    feet_apart,
    hanging_hands,
    heading_of,
    stand,
)
from inhand_lab.motions.timeline import Key, drift, minimum_jerk, move_through
from inhand_lab.people.body_motion import BodyMotion
from inhand_lab.people.joint_sequence import JointSequence
from inhand_lab.people.kinematics import Trunk, place_body, place_trunk
from inhand_lab.people.person import SimulatedPerson, sample_person
from inhand_lab.sensing.cameras import KINECT
from inhand_lab.sensing.skeleton_noise import MISSING, read_skeleton
from inhand_lab.world.interactions import INTERACTIONS
from inhand_lab.world.simulation import Simulation

Idleness = Literal["stand", "gesture", "walkOnSpot", "walkAbout", "fidget"]
IDLENESS: tuple[Idleness, ...] = get_args(Idleness)

GESTURES = {
    "hips": ((0.20, 0.03, -0.38), (-0.6, 0.3, -0.7)),
    "crossed": ((-0.10, 0.20, -0.20), (-1.0, 0.1, 0.2)),
    "head": ((0.10, 0.04, 0.24), (-0.5, -0.2, 0.8)),
    "face": ((0.04, 0.14, 0.12), (-0.4, -0.3, 0.9)),
    "watch": ((-0.02, 0.28, -0.12), (-1.0, 0.2, 0.1)),
    "belly": ((0.00, 0.16, -0.34), (-1.0, 0.2, -0.1)),
}
"""Where a right hand goes, in statures of 1.75 m in the chest's frame, and where its fingers
point. A gesture is of one hand or of both."""
BOTH_HANDS = 0.4
GESTURE_SECONDS, HANGING_SECONDS, WAY_SECONDS = (1.0, 4.0), (1.0, 5.0), 0.7
FIDGET_LOW, FIDGET_HIGH = (-0.30, -0.10, -0.60), (0.60, 0.55, 0.55)
"""Between which corners, as GESTURES, the right hand of somebody who fidgets goes."""
FIDGET_SECONDS, FIDGET_WAY_SECONDS = (0.0, 1.5), (0.3, 1.2)
FIDGETS = 6
"""Before the hands hang again, at most."""
CADENCE, STRIDE = 1.75, 0.62
"""Steps a second, and a step's length in metres for 1.75 m of stature."""
CIRCLE = 0.9
"""Radius in metres of the way of who walks about."""
SPACE_TO_WALK = 0.5
"""So much farther back, in metres, is the wall of a room to walk about in."""
SWING = 0.35
"""Radians by which arms swing."""
CAMERA_HEIGHT, CAMERA_DISTANCE, CAMERA_ASIDE = (1.0, 1.4), (2.9, 3.6), 0.5
UNUSED = INTERACTIONS["drinkFromMug"]
"""A simulation has an object: that of these people is behind the camera."""


_MoveHands = Callable[
    [SimulatedPerson, Array, np.random.Generator, Trunk, tuple[Transform, Transform]],
    tuple[list[Key], list[Key]],
]


def watch_idle(
    idleness: Idleness, participant: int, seed: int, frames: int = 360, frame_rate: float = 30.0
) -> JointSequence:
    """What a skeleton tracker makes of somebody idle, for as many frames."""
    idle = simulate_idle(idleness, participant, seed, frames, frame_rate)
    missing = idle.joint_states == MISSING
    seen = np.where(missing[..., None], np.nan, idle.joints_in_camera)
    times_ns = np.rint(np.arange(frames) / frame_rate * 1e9).astype(np.int64)
    left_handed = idle.person.handedness == "left"
    return JointSequence(idleness, f"p{participant:02}", left_handed, seen, times_ns)


def simulate_idle(
    idleness: Idleness, participant: int, seed: int, frames: int = 360, frame_rate: float = 30.0
) -> Simulation:
    """Somebody idle before the camera, for as many frames; the object is out of its sight."""
    person = sample_person(seed, participant)
    random = np.random.default_rng([seed, participant, IDLENESS.index(idleness), 0x1D7E])
    times = np.arange(frames) / frame_rate
    if idleness in _HANDS:
        body = _stand(person, times, random, _HANDS[idleness])
    else:
        body = _walk(person, times, random, 0.0 if idleness == "walkOnSpot" else CIRCLE)
    camera_from_world = _camera(random)
    seen = body.seen_from(camera_from_world)
    reading = read_skeleton(person, seen.joints, frame_rate, random)
    viewpoint = camera_from_world.inverse().translation
    space = SPACE_TO_WALK if idleness == "walkAbout" else 0.0
    further = -space * normalised(viewpoint * [1.0, 1.0, 0.0])
    return Simulation(
        idleness,
        participant,
        seed,
        0,
        frame_rate,
        person,
        UNUSED.object_model(),
        KINECT,
        reading.joints,
        reading.states,
        reading.confidences,
        seen,
        Transform(np.array([0.0, 0.0, -9.0]), np.eye(3)).repeated(frames),
        np.full(frames, ContactKind.RESTING, np.uint8),
        camera_from_world @ Transform(further, np.eye(3)),
        float(np.arctan2(-viewpoint[0], viewpoint[1])),
        (),
    )


def _camera(random: np.random.Generator) -> Transform:
    """camera_from_world of a camera that looks at the world's origin."""
    aside = random.uniform(-CAMERA_ASIDE, CAMERA_ASIDE)
    distance, height = random.uniform(*CAMERA_DISTANCE), random.uniform(*CAMERA_HEIGHT)
    position = np.array([np.sin(aside) * distance, np.cos(aside) * distance, height])
    forward = normalised(np.array([0.0, 0.0, 0.8]) - position)
    right = normalised(np.cross(forward, [0.0, 0.0, 1.0]))
    axes = np.stack([right, np.cross(forward, right), forward], axis=1)
    return Transform(position, axes).inverse()


def _stand(
    person: SimulatedPerson, times: Array, random: np.random.Generator, move: _MoveHands
) -> BodyMotion:
    right, left = feet_apart(len(times))
    still = np.zeros((len(times), 3))
    turn = drift(times, random, 0.08, 6.0)
    weight = np.stack(
        [drift(times, random, 0.02, 6.0), np.zeros(len(times)), np.zeros(len(times))], axis=1
    )
    glances = np.stack(
        [drift(times, random, 0.10, 4.0), np.zeros(len(times)), drift(times, random, 0.3, 4.0)],
        axis=1,
    )
    posture = stand(person, times, random, Stance(right, left, turn, weight, still, glances))
    trunk = place_trunk(person, posture)
    hanging = hanging_hands(person, trunk, random)
    hands = [move_through(times, keys) for keys in move(person, times, random, trunk, hanging)]
    return place_body(person, posture, hands[0], hands[1])


def _gesture_keys(
    person: SimulatedPerson,
    times: Array,
    random: np.random.Generator,
    trunk: Trunk,
    hanging: tuple[Transform, Transform],
) -> tuple[list[Key], list[Key]]:
    """Where the right and the left hand are, one gesture after the other."""
    keys = ([Key(0.0, hanging[0])], [Key(0.0, hanging[1])])
    now = float(random.uniform(*HANGING_SECONDS))
    while now < times[-1]:
        name = str(random.choice(list(GESTURES)))
        lasts = float(random.uniform(*GESTURE_SECONDS))
        both, side = random.random() < BOTH_HANDS, int(random.integers(2))
        for hand in (0, 1):
            if both or hand == side:
                pose = _gesture(person, name, hand, trunk, len(times))
                keys[hand].extend(
                    [
                        Key(now, hanging[hand]),
                        Key(now + WAY_SECONDS, pose),
                        Key(now + WAY_SECONDS + lasts, pose),
                        Key(now + 2.0 * WAY_SECONDS + lasts, hanging[hand]),
                    ]
                )
        now += 2.0 * WAY_SECONDS + lasts + float(random.uniform(*HANGING_SECONDS))
    return keys


def _fidget_keys(
    person: SimulatedPerson,
    times: Array,
    random: np.random.Generator,
    trunk: Trunk,
    hanging: tuple[Transform, Transform],
) -> tuple[list[Key], list[Key]]:
    """Where the right and the left hand are, each by itself: anywhere, and hanging in between."""
    keys: tuple[list[Key], list[Key]] = ([], [])
    for hand in (0, 1):
        now = float(random.uniform(*HANGING_SECONDS))
        keys[hand].append(Key(now, hanging[hand]))
        while now < times[-1]:
            for _ in range(int(random.integers(1, FIDGETS + 1))):
                place = random.uniform(FIDGET_LOW, FIDGET_HIGH)
                pose = _placed(person, place, random.normal(size=3), hand, trunk, len(times))
                reached = now + float(random.uniform(*FIDGET_WAY_SECONDS))
                now = reached + float(random.uniform(*FIDGET_SECONDS))
                keys[hand].extend([Key(reached, pose), Key(now, pose)])
            now += WAY_SECONDS
            keys[hand].append(Key(now, hanging[hand]))
            now += float(random.uniform(*HANGING_SECONDS))
            keys[hand].append(Key(now, hanging[hand]))
    return keys


def _still_keys(
    person: SimulatedPerson,
    times: Array,
    random: np.random.Generator,
    trunk: Trunk,
    hanging: tuple[Transform, Transform],
) -> tuple[list[Key], list[Key]]:
    """Both hands hang."""
    return [Key(0.0, hanging[0])], [Key(0.0, hanging[1])]


_HANDS: dict[str, _MoveHands] = {
    "stand": _still_keys,
    "gesture": _gesture_keys,
    "fidget": _fidget_keys,
}


def _gesture(person: SimulatedPerson, name: str, hand: int, trunk: Trunk, count: int) -> Transform:
    place, fingers = (np.array(value) for value in GESTURES[name])
    return _placed(person, place, fingers, hand, trunk, count)


def _placed(
    person: SimulatedPerson, place: Array, fingers: Array, hand: int, trunk: Trunk, count: int
) -> Transform:
    pose = Transform(
        place * person.height / 1.75, rotation_from_axes(fingers, np.array([0.0, 0.4, 0.9]))
    ).repeated(count)
    return trunk.world_from_chest @ (pose if hand == 0 else pose.mirrored())


def _walk(
    person: SimulatedPerson, times: Array, random: np.random.Generator, radius: float
) -> BodyMotion:
    """On the spot, where the radius is 0, or in a circle about the world's origin."""
    pace = CADENCE * person.manner.tempo
    stride = STRIDE * person.height / 1.75 * person.manner.amplitude
    speed = pace * stride if radius else 0.0
    start, way = random.uniform(0.0, 2.0 * np.pi), float(random.choice([-1.0, 1.0]))
    feet = [_foot(times, side, pace, speed, radius, start, way) for side in (1.0, -1.0)]
    heading = _heading(times * speed, radius, start, way)
    still = np.zeros((len(times), 3))
    stance = Stance(feet[0], feet[1], heading, still, still, still)
    posture = stand(person, times, random, stance)
    trunk = place_trunk(person, posture)
    phase = SWING * person.manner.amplitude * np.sin(np.pi * pace * times)
    right, left = hanging_hands(person, trunk, random)
    return place_body(
        person,
        posture,
        _swung(right, trunk.right_shoulder, trunk, phase),
        _swung(left, trunk.left_shoulder, trunk, -phase),
    )


def _swung(hand: Transform, shoulder: Array, trunk: Trunk, angle: Array) -> Transform:
    """A hanging hand turned forwards about its shoulder by angles (T,)."""
    upright = rotation_about("z", heading_of(trunk.world_from_chest))
    turn = upright @ rotation_about("x", angle) @ np.swapaxes(upright, 1, 2)
    offset = (turn @ (hand.translation - shoulder)[..., None])[..., 0]
    return Transform(shoulder + offset, turn @ hand.rotation)


def _heading(way_gone: Array, radius: float, start: float, way: float) -> Array:
    if not radius:
        return np.zeros(len(way_gone))
    return start + way * (way_gone / radius) + (np.pi if way < 0.0 else 0.0)


def _foot(
    times: Array, side: float, pace: float, speed: float, radius: float, start: float, way: float
) -> Array:
    """The sole (T, 3) of one foot: it stands, then swings past the other to its next place."""
    swing = 0.8 / pace
    first = 0.0 if side > 0.0 else 1.0 / pace
    landings = np.arange(first - 2.0 / pace, times[-1] + 4.0 / pace, 2.0 / pace)
    places = np.array(
        [_place(speed * (landing + 0.5 / pace), side, radius, start, way) for landing in landings]
    )
    sole = np.repeat(places[:1], len(times), axis=0)
    for landing, before, after in zip(landings[1:], places, places[1:], strict=False):
        share = minimum_jerk((times - (landing - swing)) / swing)
        sole += share[:, None] * (after - before)
        sole[:, 2] += 0.10 * 4.0 * share * (1.0 - share)
    return sole


def _place(way_gone: float, side: float, radius: float, start: float, way: float) -> Array:
    """Where a foot stands when the body has gone so many metres."""
    aside = 0.08 * side
    if not radius:
        return np.array([aside, 0.0, 0.0])
    turn = float(_heading(np.array([way_gone]), radius, start, way)[0])
    right = np.array([np.cos(turn), np.sin(turn), 0.0])
    return right * (radius * way + aside)
