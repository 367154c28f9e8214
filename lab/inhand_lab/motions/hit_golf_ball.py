"""hitGolfBall: take a golf club that leans on a rack, swing it at a ball, lean it back."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from inhand_tracker.geometry.arrays import Array
from scipy.spatial.transform import Rotation

from inhand_lab.geometry.transforms import Transform, normalised, rotation_about
from inhand_lab.motions.arms import within_both_reaches
from inhand_lab.motions.furniture import WOOD, Cuboid, Furniture
from inhand_lab.motions.golf_swing import Swing, plan_swings
from inhand_lab.motions.grips import BAR_IN_PALM, hold_bar
from inhand_lab.motions.performance import ContactKind, Performance, hanging_hands
from inhand_lab.motions.reaching import carried_by, reaching_hand
from inhand_lab.motions.script import Script, To, write_script
from inhand_lab.motions.timeline import Move, Pause, Plan
from inhand_lab.objects.golf_club import SOLE, golf_club
from inhand_lab.people.kinematics import BALL_HEIGHT, Posture, Trunk, place_trunk
from inhand_lab.people.person import SimulatedPerson

PLAN = Plan(
    opening=(Pause("wait", 0.3), Move("reach", 0.8), Move("grasp", 0.2), Move("take", 1.0)),
    use=(
        Move("waggle", 0.65),
        Pause("settle", 0.35),
        Move("swing", 1.65, swift=True),
        Pause("finish", 0.5),
        Move("recover", 0.80),
    ),
    closing=(Move("return", 0.90), Move("release", 0.2), Move("withdraw", 0.8), Pause("wait", 0.3)),
)

HALF_STANCE = 0.12
"""Of the feet's distance from each other, in statures."""
SPINE_ASIDE, HIPS_AHEAD = 0.2, 2.0
"""Tilt of the spine away from the target, radians: by its lean, for the right hand is the lower
one, and by how far (in statures) the hips have gone ahead."""
ARM_PLANE = np.radians(17.0)
"""Lean of the arms' plane from the vertical."""
STEEPEST = np.radians(68.0)
OBLIQUE = (np.radians(40.0), np.radians(40.0))
"""Of the grip across the right and the left palm; the right one is more in the fingers."""
IN_FINGERS = BAR_IN_PALM + np.array([0.0, 0.010, 0.0])
"""Where the shaft passes through a varied person's right hand, further in the fingers: some hold it
so obliquely that it would lie in the wrist."""
HANDS_APART = 0.09
NECK_TURN = np.radians(65.0)
SQUARE = 0.3
"""How much the face is square to the swing's plane, beside what the left arm makes of it."""
FOOT_TURN = 0.6
"""Turn of the right foot to the left as its heel is lifted, by the lift."""
JOINED = 0.9
"""Share of taking the club after which the left hand holds it as well."""
AROUND_CLUB = (-0.05, 0.12, 0.0)
"""How the left hand's way to the club and back swings out, metres."""

RACK_PLACE = np.array([0.35, 0.46])
"""Where the sole of the club is, metres."""
CLEAR_OF_ARM = 0.16
"""Least distance of it from the right shoulder, to the right, metres: an arm hangs there."""
LEAN, ROLL = np.radians((30.0, -45.0))
"""Of the club on the rack."""
RACK_HEIGHT, RACK_DEPTH = 0.45, 0.11


def perform(person: SimulatedPerson, times: Array, random: np.random.Generator) -> Performance:
    """Golf at these times, in seconds from the start; the target is at the left."""
    script = write_script(person, times, random, PLAN)
    swing = plan_swings(script)
    posture = _posture(script, swing)
    trunk = place_trunk(person, posture)
    rack, leaning = _lean_on_rack(person, trunk, random)
    grips = _grips(script)
    waggle = int(np.argmax(script.times >= script.stage("waggle").start))
    swung = _swing_club(person, trunk, swing, address=waggle)
    swung = _above_floor(within_both_reaches(person, trunk, swung, grips))
    rest = script.still(leaning)
    take, back = To(swung, bow=(0.0, 0.0, 0.08)), To(rest, bow=(0.0, 0.0, 0.08))
    carried = script.way(rest, {"take": take, "return": back})
    right_rest, left_rest = hanging_hands(person, trunk, random)
    right_hand = reaching_hand(script, right_rest, carried @ grips[0], bow=(0.06, 0.0, 0.10))
    join = To(carried @ grips[1], AROUND_CLUB, part=(0.0, JOINED))
    leave = To(left_rest, AROUND_CLUB, part=(0.0, 0.8))
    left_hand = script.way(left_rest, {"take": join, "return": leave})
    joining = (script.stage("take").at(JOINED), ContactKind.BOTH_HANDS)
    leaving = (script.stage("return").start, ContactKind.RIGHT_HAND)
    contact = carried_by(script, joining, leaving)
    return Performance(posture, right_hand, left_hand, carried, contact, rack, script.stages)


def _posture(script: Script, swing: Swing) -> Posture:
    """Hips and shoulders turning about a spine that leans to the ball; eyes on the ball.

    The right heel comes off the floor as the weight goes to the left foot.
    """
    person, count = script.person, len(script.times)
    shift = np.stack([person.height * swing.slide, np.zeros(count), np.full(count, -0.015)], axis=1)
    leaning = np.outer(swing.lean, [1.0, 0.0, 0.0])
    half_width = HALF_STANCE * person.height
    stance = script.upright_stance(leaning, np.zeros((count, 3)), shift, half_width)
    pivoted = _pivot(person, stance.right_foot, swing.heel)
    shift[:, :2] -= 0.5 * (pivoted.translation - stance.right_foot)[:, :2]
    posture, _ = script.stand(replace(stance, right_foot=pivoted.translation))
    lean = swing.lean + person.manner.stoop + script.drift(0.01, 4.0)
    aside = rotation_about("y", SPINE_ASIDE * swing.lean - HIPS_AHEAD * swing.slide)
    pelvis = rotation_about("zx", swing.pelvis, -0.5 * lean)
    chest = aside @ rotation_about("zx", swing.chest, -lean)
    gaze = np.clip(1.5 * swing.gaze, swing.chest - NECK_TURN, swing.chest + NECK_TURN)
    head = rotation_about("zx", gaze, -1.5 * lean * (1.0 - 0.5 * swing.gaze))
    return replace(
        posture,
        world_from_pelvis=Transform(posture.world_from_pelvis.translation, pelvis),
        trunk_angles=_angles(pelvis, chest) * (-1.0, 1.0, 1.0),
        head_angles=_angles(chest, head),
        world_from_right_foot=pivoted,
    )


def _angles(world_from_one: Array, world_from_other: Array) -> Array:
    """The other's turns (T, 3) about the one's x, y and z axes."""
    between = np.swapaxes(world_from_one, 1, 2) @ world_from_other
    return Rotation.from_matrix(between).as_euler("yxz")[:, [1, 0, 2]]


def _pivot(person: SimulatedPerson, sole: Array, heel: Array) -> Transform:
    """The right foot, world_from_foot (T), its heel lifted by an angle (T,) over the ball."""
    ball = np.array([0.0, person.proportions.foot, BALL_HEIGHT])
    flat = rotation_about("z", -person.carriage.toes_out)
    turned = rotation_about("xz", -heel, FOOT_TURN * heel - person.carriage.toes_out)
    return Transform(sole + flat @ ball - turned @ ball, turned)


def _lean_on_rack(
    person: SimulatedPerson, trunk: Trunk, random: np.random.Generator
) -> tuple[Furniture, Transform]:
    """A low rack at the right, and the club leaning on its front edge, world_from_object.

    Varied people, whose weight may be on the right foot, have it clear of the arm that hangs there.
    """
    x, head = RACK_PLACE + random.normal(0.0, 0.015, 2)
    if person.varied:
        x = max(x, float(trunk.right_shoulder[[0, -1], 0].max()) + CLEAR_OF_ARM)
    rotation = rotation_about("x", LEAN) @ rotation_about("z", ROLL)
    lowest = (golf_club().vertices @ rotation.T)[:, 2].min()
    place = np.array([x, head, 0.0]) - rotation @ [0.0, 0.0, SOLE]
    place[2] = -lowest
    up_to_edge = (RACK_HEIGHT - place[2]) / np.cos(LEAN)
    edge = float(place[1] - up_to_edge * np.sin(LEAN)) - 0.008
    centre = (float(x), edge - 0.5 * RACK_DEPTH, 0.5 * RACK_HEIGHT)
    return (Cuboid(centre, (RACK_DEPTH, RACK_DEPTH, RACK_HEIGHT), WOOD),), Transform(
        place, rotation
    )


def _grips(script: Script) -> tuple[Transform, Transform]:
    """The right and the left hand, object_from_hand (T): thumbs down the shaft, left hand above."""
    down = np.diag([1.0, -1.0, -1.0])
    in_hands = IN_FINGERS if script.person.varied else BAR_IN_PALM, BAR_IN_PALM
    right, left = (
        hold_bar(script, np.array([0.0, 0.0, along]), down @ rotation_about("x", oblique), in_hand)
        for along, oblique, in_hand in zip(
            (-0.5 * HANDS_APART, 0.5 * HANDS_APART), OBLIQUE, in_hands, strict=True
        )
    )
    return right, left.mirrored()


def _swing_club(person: SimulatedPerson, trunk: Trunk, swing: Swing, address: int) -> Transform:
    """The club, world_from_object (T), its face turning with the left forearm.

    The club's plane is as steep as brings the head to the floor in the frame of the address.
    """
    body = person.proportions
    arm = body.upper_arm + body.forearm + body.palm
    shoulders = trunk.world_from_chest.translation
    hands = shoulders + arm * (
        swing.reach[:, None] * _in_plane(swing.arms, 0.5 * np.pi - ARM_PLANE)
        + swing.inside[:, None] * np.array([0.0, -np.cos(ARM_PLANE), -np.sin(ARM_PLANE)])
    )
    lowest = hands[address, 2]
    steep = np.clip(np.arcsin(np.clip(lowest / -SOLE, -1.0, 1.0)), 0.0, STEEPEST)
    shaft = _in_plane(swing.club, float(steep))
    below = np.array([0.0, -np.sin(steep), -np.cos(steep)])
    arm_way = normalised(hands - trunk.left_shoulder) + SQUARE * below
    across = normalised(arm_way - shaft * np.sum(arm_way * shaft, axis=1, keepdims=True))
    return Transform(hands, np.stack([np.cross(across, shaft), -across, -shaft], axis=2))


def _in_plane(angle: Array, steepness: float) -> Array:
    """Directions (T, 3) in a plane that rises towards the player, from down to the right."""
    up = np.array([0.0, -np.cos(steepness), np.sin(steepness)])
    return np.sin(angle)[:, None] * np.array([1.0, 0.0, 0.0]) - np.cos(angle)[:, None] * up


def _above_floor(club: Transform) -> Transform:
    """The club lifted where it would go into the floor."""
    heights = np.einsum("tj,vj->tv", club.rotation[:, 2], golf_club().vertices).min(axis=1)
    lift = np.clip(0.003 - heights - club.translation[:, 2], 0.0, None)
    return Transform(club.translation + lift[:, None] * [0.0, 0.0, 1.0], club.rotation)
