"""sweepFloor: take a broom that leans on a cupboard, sweep with both hands, lean it back."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import MIRROR, Transform, normalised, rotation_about
from inhand_lab.motions.furniture import Cuboid, Furniture
from inhand_lab.motions.grips import DRIFT_PERIOD, SLIDE_DRIFT, TURN_DRIFT, wrap_bar
from inhand_lab.motions.performance import ContactKind, Performance, Stance, hanging_hands, step
from inhand_lab.motions.reaching import attention, carried_by
from inhand_lab.motions.script import Script, To, write_script
from inhand_lab.motions.timeline import Move, Pause, Plan, Stage, minimum_jerk
from inhand_lab.objects.broom import BROOM_HALF_LENGTH, broom
from inhand_lab.people.kinematics import Trunk
from inhand_lab.people.person import SimulatedPerson

PLAN = Plan(
    opening=(Pause("wait", 0.4), Move("reach", 0.9), Move("grasp", 0.25), Move("take", 1.1)),
    use=(Move("stroke", 0.8), Move("back", 0.7), Pause("gather", 0.2)),
    closing=(Move("return", 1.1), Move("release", 0.25), Move("withdraw", 0.9), Pause("wait", 0.4)),
)

RIGHT_HAND_UP = 0.58
LEFT_HAND_UP = 0.75
"""Where the hands are along the broom from the bristles' tips, as shares of the stature."""
HIGHEST_GRIP = 1.32
RIGHT_ELBOW = np.array([0.06, -0.08, -0.28])
LEFT_ELBOW = np.array([0.15, 0.02, -0.20])
"""About where the elbows are from the shoulders, the left one mirrored, in metres."""
JOINED = 0.85
"""Share of taking the broom after which the left hand holds it as well."""

LEAN = 0.14
"""Of the broom against the cupboard, radians."""
CUPBOARD_HEIGHT = 1.10


def perform(person: SimulatedPerson, times: Array, random: np.random.Generator) -> Performance:
    """Sweeping at these times, in seconds from the start."""
    script = write_script(person, times, random, PLAN)
    brush = _brush_track(script)
    posture, trunk = script.stand(_stance(script, brush))
    cupboard, leaning = _lean_on_cupboard(random)
    sweeping, rest = _sweep(script, trunk, brush), script.still(leaning)
    there, back = To(sweeping, bow=(0.0, 0.04, 0.06)), To(rest, bow=(0.0, 0.04, 0.06))
    carried = script.way(rest, {"take": there, "return": back})
    right_held, left_held = _hold(script, trunk, carried)
    right_rest, left_rest = hanging_hands(person, trunk, random)
    there, back = To(right_held, bow=(0.0, 0.08, 0.0)), To(right_rest, bow=(0.0, 0.05, 0.0))
    right_hand = script.way(right_rest, {"reach": there, "withdraw": back})
    there = To(left_held, bow=(-0.03, 0.10, 0.0), part=(0.0, JOINED))
    back = To(left_rest, part=(0.0, 0.8))
    left_hand = script.way(left_rest, {"take": there, "return": back})
    joining = (script.stage("take").at(JOINED), ContactKind.BOTH_HANDS)
    leaving = (script.stage("return").start, ContactKind.RIGHT_HAND)
    contact = carried_by(script, joining, leaving)
    return Performance(posture, right_hand, left_hand, carried, contact, cupboard, script.stages)


def _brush_track(script: Script) -> Array:
    """Where the brush is (T,) to the right of the body, metres: across to the left and back."""
    reach = 0.15 * script.person.height * script.person.manner.amplitude

    def right_end(_: Stage | None = None) -> float:
        return 0.10 + reach + float(script.random.normal(0.0, 0.03))

    def left_end(_: Stage) -> float:
        return 0.10 - reach + float(script.random.normal(0.0, 0.03))

    return script.level(right_end(), {"stroke": left_end, "back": right_end})


def _stance(script: Script, brush: Array) -> Stance:
    """Turning and leaning with the brush, and now and then a small step to a new place."""
    working = script.every("stroke", "back", "gather")
    work = script.around(replace(working[0], end=working[-1].end), 0.9, 0.9)
    aside, looked = work * (brush - 0.10), attention(script, linger=1.0)
    trunk = np.outer(work, [0.20, 0.0, 0.0]) + np.outer(aside, [0.0, 0.10, -0.55])
    head = np.outer(work, [-0.35, 0.0, 0.0]) + np.outer(aside, [0.0, 0.0, -0.5])
    shift = np.outer(work, [0.0, 0.02, 0.0]) + np.outer(aside, [0.12, 0.0, 0.0])
    trunk += np.outer(looked, [0.20, 0.05, -0.20])
    head += np.outer(looked, [-0.15, 0.0, -0.40])
    stance = script.upright_stance(trunk, head, shift, half_width=0.13)
    right_steps, left_steps = _steps(script)
    return replace(
        stance,
        right_foot=stance.right_foot + right_steps,
        left_foot=stance.left_foot + left_steps,
    )


def _steps(script: Script) -> tuple[Array, Array]:
    """The ways (T, 3) of the right and the left foot to a new place after every other stroke."""
    right, left = np.zeros((2, len(script.times), 3))
    here = np.zeros(2)
    for stage in script.every("back", "return"):
        there = here
        if stage.name == "return":
            there = np.zeros(2)
        elif stage.repetition % 2 == 1:
            there = script.random.uniform((-0.12, 0.0), (0.08, 0.12))
        right += step(script.times, stage.start, stage.at(0.5), there - here)
        left += step(script.times, stage.at(0.5), stage.end, there - here)
        here = there
    return right, left


def _lean_on_cupboard(random: np.random.Generator) -> tuple[Furniture, Transform]:
    """A cupboard at the right, and the broom leaning on its near edge, world_from_object."""
    x, y = 0.36 + random.normal(0.0, 0.02), 0.24 + random.normal(0.0, 0.03)
    axis = np.array([np.sin(LEAN), 0.0, np.cos(LEAN)])
    standing = _stand_on_floor(axis[None], np.zeros(1), np.array([[x, y]]), np.zeros(1))[0]
    edge = x + CUPBOARD_HEIGHT * np.tan(LEAN) + 0.02
    centre = (float(edge) + 0.175, y - 0.11, CUPBOARD_HEIGHT / 2.0)
    return (Cuboid(centre, (0.35, 0.30, CUPBOARD_HEIGHT), (206, 200, 188)),), standing


def _sweep(script: Script, trunk: Trunk, brush: Array) -> Transform:
    """The broom at work, world_from_object (T): its head on the floor but on the way back."""
    person, times = script.person, script.times
    hips = trunk.world_from_pelvis.translation
    ahead = 0.31 * person.height + script.drift(0.02, 4.0)
    head = np.stack([hips[:, 0] + brush, hips[:, 1] + ahead], axis=1)
    end = hips + np.array([0.0, 0.26, 0.14]) * person.height
    end[:, 0] -= 0.12 * brush
    foot = np.concatenate([head, np.zeros((len(times), 1))], axis=1)
    raised = np.zeros(len(times))
    for stage in script.every("back"):
        share = minimum_jerk((times - stage.start) / stage.seconds)
        raised += 0.07 * 4.0 * share * (1.0 - share)
    turn = person.manner.grip_turn + script.drift(TURN_DRIFT, DRIFT_PERIOD)
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


def _hold(script: Script, trunk: Trunk, carried: Transform) -> tuple[Transform, Transform]:
    """Both fists around the handle, world_from_hand (T), thumbs up, each away from its elbow."""
    person = script.person
    axis = carried.rotation[:, :, 2]
    foot = carried.translation - BROOM_HALF_LENGTH * axis
    hands = []
    for share, shoulder, elbow, side in (
        (RIGHT_HAND_UP, trunk.right_shoulder, RIGHT_ELBOW, np.ones(3)),
        (LEFT_HAND_UP, trunk.left_shoulder, LEFT_ELBOW, MIRROR),
    ):
        up = min(share * person.height + 0.05 * person.manner.grip_slide, HIGHEST_GRIP)
        along = up + script.drift(SLIDE_DRIFT, DRIFT_PERIOD)
        point = foot + along[:, None] * axis
        hands.append(wrap_bar(axis * side, point * side, shoulder * side + elbow))
    return hands[0], hands[1].mirrored()
