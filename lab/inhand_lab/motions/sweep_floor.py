"""sweepFloor: take a broom that leans on a cupboard, sweep with both hands, lean it back."""

from __future__ import annotations

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import MIRROR, Transform, normalised, rotation_about
from inhand_lab.motions.furniture import Cuboid, Furniture
from inhand_lab.motions.grips import DRIFT_PERIOD, SLIDE_DRIFT, TURN_DRIFT, wrap_bar
from inhand_lab.motions.performance import (
    ContactKind,
    Performance,
    Stance,
    contacts,
    feet_apart,
    hanging_hands,
    stand,
    step,
)
from inhand_lab.motions.timeline import (
    Key,
    Move,
    Pause,
    Stage,
    drift,
    minimum_jerk,
    move_through,
    schedule,
    track,
)
from inhand_lab.objects.broom import BROOM_HALF_LENGTH, broom
from inhand_lab.people.kinematics import Trunk, place_trunk
from inhand_lab.people.person import SimulatedPerson

OPENING = (
    Pause("wait", 0.4),
    Move("reach", 0.9),
    Move("grasp", 0.25),
    Move("take", 1.1),
)
USE = (Move("stroke", 0.8), Move("back", 0.7), Pause("gather", 0.2))
CLOSING = (
    Move("return", 1.1),
    Move("release", 0.25),
    Move("withdraw", 0.9),
    Pause("wait", 0.4),
)

RIGHT_HAND_UP = 0.58
LEFT_HAND_UP = 0.75
"""Where the hands are along the broom from the bristles' tips, as shares of the stature."""
HIGHEST_GRIP = 1.32
RIGHT_ELBOW = np.array([0.06, -0.08, -0.28])
LEFT_ELBOW = np.array([0.15, 0.02, -0.20])
"""About where the elbows are from the shoulders, the left one mirrored, in metres."""

LEAN = 0.14
"""Of the broom against the cupboard, radians."""
CUPBOARD_HEIGHT = 1.10


def perform(person: SimulatedPerson, times: Array, random: np.random.Generator) -> Performance:
    """Sweeping at these times, in seconds from the start."""
    stages = schedule(person, random, float(times[-1]), OPENING, USE, CLOSING)
    brush = _brush_track(person, times, random, stages)
    posture = stand(person, times, random, _stance(person, times, random, stages, brush))
    trunk = place_trunk(person, posture)
    cupboard, leaning = _lean_on_cupboard(random)
    sweeping = _sweep(person, times, random, trunk, brush, stages)
    rest = leaning.repeated(len(times))
    start = {stage.name: stage.start for stage in stages}
    end = {stage.name: stage.end for stage in stages}
    first_stroke = min(stage.start for stage in stages if stage.name == "stroke")
    carried = move_through(
        times,
        [
            Key(start["take"], rest),
            Key(first_stroke, sweeping, bow=(0.0, 0.04, 0.06)),
            Key(start["return"], sweeping),
            Key(end["return"], rest, bow=(0.0, 0.04, 0.06)),
        ],
    )
    right_held, left_held = _hold(person, times, random, trunk, carried)
    right_rest, left_rest = hanging_hands(person, trunk, random)
    right_hand = move_through(
        times,
        [
            Key(start["reach"], right_rest),
            Key(end["reach"], right_held, bow=(0.0, 0.08, 0.0)),
            Key(start["withdraw"], right_held),
            Key(end["withdraw"], right_rest, bow=(0.0, 0.05, 0.0)),
        ],
    )
    joined = start["take"] + 0.85 * (end["take"] - start["take"])
    left_hand = move_through(
        times,
        [
            Key(start["take"], left_rest),
            Key(joined, left_held, bow=(-0.03, 0.10, 0.0)),
            Key(start["return"], left_held),
            Key(start["return"] + 0.8 * (end["return"] - start["return"]), left_rest),
        ],
    )
    changes = [
        (0.0, ContactKind.RESTING),
        (end["grasp"], ContactKind.RIGHT_HAND),
        (joined, ContactKind.BOTH_HANDS),
        (start["return"], ContactKind.RIGHT_HAND),
        (start["release"], ContactKind.RESTING),
    ]
    contact = contacts(times, changes)
    return Performance(posture, right_hand, left_hand, carried, contact, cupboard)


def _brush_track(
    person: SimulatedPerson, times: Array, random: np.random.Generator, stages: list[Stage]
) -> Array:
    """Where the brush is (T,) to the right of the body, metres: across to the left and back."""
    reach = 0.15 * person.height * person.manner.amplitude

    def right_end() -> float:
        return 0.10 + reach + float(random.normal(0.0, 0.03))

    keys = [(0.0, right_end())]
    for stage in stages:
        if stage.name == "stroke":
            left_end = 0.10 - reach + float(random.normal(0.0, 0.03))
            keys += [(stage.start, keys[-1][1]), (stage.end, left_end)]
        if stage.name == "back":
            keys.append((stage.end, right_end()))
    return track(times, keys)


def _stance(
    person: SimulatedPerson,
    times: Array,
    random: np.random.Generator,
    stages: list[Stage],
    brush: Array,
) -> Stance:
    """Turning and leaning with the brush, and now and then a small step to a new place."""
    count = len(times)
    working = [stage for stage in stages if stage.name in ("stroke", "back", "gather")]
    keys = [
        (working[0].start - 0.9, 0.0),
        (working[0].start, 1.0),
        (working[-1].end, 1.0),
        (working[-1].end + 0.9, 0.0),
    ]
    work = track(times, keys)
    aside = work * (brush - 0.10)
    trunk = np.stack([0.20 * work, 0.10 * aside, -0.55 * aside], axis=1)
    head = np.stack([-0.35 * work, np.zeros(count), -0.5 * aside], axis=1)
    shift = np.stack([0.12 * aside, 0.02 * work, np.zeros(count)], axis=1)
    for stage in stages:
        if stage.name in ("reach", "return"):
            keys = [(stage.start, 0.0), (stage.end, 1.0), (stage.end + 1.0, 0.0)]
            looked = track(times, keys)[:, None]
            trunk += looked * np.array([0.20, 0.05, -0.20])
            head += looked * np.array([-0.15, 0.0, -0.40])
    right_foot, left_foot = feet_apart(count, half_width=0.13)
    here = np.zeros(2)
    steps = [stage for stage in stages if stage.name in ("back", "return")]
    for stage in steps:
        there = here
        if stage.name == "return":
            there = np.zeros(2)
        elif stage.repetition % 2 == 1:
            there = random.uniform((-0.12, 0.0), (0.08, 0.12))
        middle = 0.5 * (stage.start + stage.end)
        right_foot += step(times, stage.start, middle, there - here)
        left_foot += step(times, middle, stage.end, there - here)
        here = there
    return Stance(right_foot, left_foot, np.zeros(count), shift, trunk, head)


def _lean_on_cupboard(random: np.random.Generator) -> tuple[Furniture, Transform]:
    """A cupboard at the right, and the broom leaning on its near edge, world_from_object."""
    x, y = 0.36 + random.normal(0.0, 0.02), 0.24 + random.normal(0.0, 0.03)
    axis = np.array([np.sin(LEAN), 0.0, np.cos(LEAN)])
    standing = _stand_on_floor(axis[None], np.zeros(1), np.array([[x, y]]), np.zeros(1))[0]
    edge = x + CUPBOARD_HEIGHT * np.tan(LEAN) + 0.02
    centre = (float(edge) + 0.175, y - 0.11, CUPBOARD_HEIGHT / 2.0)
    return (Cuboid(centre, (0.35, 0.30, CUPBOARD_HEIGHT), (206, 200, 188)),), standing


def _sweep(
    person: SimulatedPerson,
    times: Array,
    random: np.random.Generator,
    trunk: Trunk,
    brush: Array,
    stages: list[Stage],
) -> Transform:
    """The broom at work, world_from_object (T): its head on the floor but on the way back."""
    hips = trunk.world_from_pelvis.translation
    ahead = 0.31 * person.height + drift(times, random, 0.02, 4.0)
    head = np.stack([hips[:, 0] + brush, hips[:, 1] + ahead], axis=1)
    end = hips + np.array([0.0, 0.26, 0.14]) * person.height
    end[:, 0] -= 0.12 * brush
    foot = np.concatenate([head, np.zeros((len(times), 1))], axis=1)
    raised = np.zeros(len(times))
    for stage in stages:
        if stage.name == "back":
            share = minimum_jerk((times - stage.start) / (stage.end - stage.start))
            raised += 0.07 * 4.0 * share * (1.0 - share)
    turn = person.manner.grip_turn + drift(times, random, TURN_DRIFT, DRIFT_PERIOD)
    return _stand_on_floor(normalised(end - foot), turn, head, raised)


def _stand_on_floor(axis: Array, turn: Array, head: Array, raised: Array) -> Transform:
    """The broom, world_from_object (T), along axis (T, 3) with its brush over head (T, 2).

    The brush is wide ahead of the person but for its turn (T,) about the handle, radians, and its
    lowest point is raised (T,) metres above the floor.
    """
    ahead = rotation_about("z", turn)[:, :, 1]
    wide = normalised(ahead - axis * np.sum(ahead * axis, axis=1, keepdims=True))
    rotation = np.stack([wide, np.cross(axis, wide), axis], axis=-1)
    heights = np.einsum("tj,vj->tv", rotation[:, 2], broom().vertices)
    tips = np.concatenate([head, np.zeros((len(head), 1))], axis=1)
    place = tips + BROOM_HALF_LENGTH * axis
    place[:, 2] = raised - heights.min(axis=1)
    return Transform(place, rotation)


def _hold(
    person: SimulatedPerson,
    times: Array,
    random: np.random.Generator,
    trunk: Trunk,
    carried: Transform,
) -> tuple[Transform, Transform]:
    """Both fists around the handle, world_from_hand (T), thumbs up, each away from its elbow."""
    axis = carried.rotation[:, :, 2]
    foot = carried.translation - BROOM_HALF_LENGTH * axis
    hands = []
    for share, shoulder, elbow, side in (
        (RIGHT_HAND_UP, trunk.right_shoulder, RIGHT_ELBOW, np.ones(3)),
        (LEFT_HAND_UP, trunk.left_shoulder, LEFT_ELBOW, MIRROR),
    ):
        up = min(share * person.height + 0.05 * person.manner.grip_slide, HIGHEST_GRIP)
        along = up + drift(times, random, SLIDE_DRIFT, DRIFT_PERIOD)
        point = foot + along[:, None] * axis
        hands.append(wrap_bar(axis * side, point * side, shoulder * side + elbow))
    return hands[0], hands[1].mirrored()
