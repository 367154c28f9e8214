"""Two people who meet, hand over a mug and pass each other, before the cameras of a rig.

handover = simulate_handover(seed=1, cameras=3)
handover.rig.cameras[0].render(200)     # both people and the mug
handover.people(0, 200)                 # whom the first camera's skeleton tracker follows
handover.holder(0, 200)                 # the number that it gives to who has the mug

The giver comes from the left camera's side with the mug in the right hand, the taker from the right
one's; they stop, the mug changes hands between them, and they walk on past each other. Before those
cameras one hides the other.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from inhand_schemas.messages import Person
from inhand_tracker.geometry.arrays import Array, Bytes, Flags, Indices

from inhand_lab.geometry.transforms import Transform, rotation_about
from inhand_lab.motions.performance import (
    ContactKind,
    Performance,
    Stance,
    feet_apart,
    hanging_hands,
    stand,
)
from inhand_lab.motions.timeline import Key, move_through
from inhand_lab.people.body_motion import BodyMotion
from inhand_lab.people.kinematics import place_body, place_trunk
from inhand_lab.people.person import SimulatedPerson
from inhand_lab.sensing.cameras import KINECT, Camera
from inhand_lab.sensing.skeleton_noise import (
    MISSING,
    SkeletonReading,
    joints_behind,
    read_skeleton,
)
from inhand_lab.world.enactment import Enactment
from inhand_lab.world.interactions import INTERACTIONS
from inhand_lab.world.messages import read_person
from inhand_lab.world.other_moments import enactment_at
from inhand_lab.world.parameters import DEFAULT_HANDOVER, ROAMING_VIEWS
from inhand_lab.world.rigs import RigSimulation, RigView, simulate_enacted
from inhand_lab.world.roaming import WayPoint, walk_along
from inhand_lab.world.simulation import Casting, Companion, Simulation, enact, purpose_of_view

HANDOVER = "handOver"
"""Name of what the two do, in simulations of it."""
_USE = "drinkFromMug"
"""The interaction of which both have their grips."""
GIVER, TAKER = 0, 1


@dataclass(frozen=True)
class HandoverSimulation:
    """The rig's cameras, in each of which the giver is the person and the taker the companion.

    By camera: ``holders`` (T,), GIVER or TAKER, is who truly has the mug, and ``numbers`` (T, 2)
    those of giver and taker in that camera's skeletons, -1 where it does not see them: cameras
    number people by themselves, and anew where they come back.
    """

    rig: RigSimulation
    holders: tuple[Bytes, ...]
    numbers: tuple[Indices, ...]

    def people(self, camera: int, frame: int) -> tuple[Person, ...]:
        """Whom a camera's skeleton tracker follows in a frame, in the order of their numbers."""
        seen = self.rig.cameras[camera]
        readings = (seen.reading, seen.others[0].reading)
        known = zip(self.numbers[camera][frame].tolist(), readings, strict=True)
        return tuple(
            read_person(reading, frame, number)
            for number, reading in sorted(known, key=lambda one: one[0])
            if number >= 0
        )

    def holder(self, camera: int, frame: int) -> int | None:
        """The number that a camera gives to who has the mug; None where it does not see them."""
        number = int(self.numbers[camera][frame, self.holders[camera][frame]])
        return number if number >= 0 else None


def simulate_handover(
    seed: int, cameras: int = 3, frames: int = 450, camera: Camera = KINECT
) -> HandoverSimulation:
    """Simulate two people of a seed who hand over a mug, in 15 s, before one to four cameras.

    Fewer frames are the beginning of more. Raises ValueError for another number of cameras, or
    under two frames.
    """
    casts = _two_right_handed(seed)
    times = np.arange(frames) / camera.frame_rate
    bodies, world_from_object, holders = _enact(casts, times)
    contact = np.full(frames, ContactKind.RIGHT_HAND, np.uint8)
    giving, taking = (Enactment(body, world_from_object, contact) for body in bodies)
    rig = simulate_enacted(casts[GIVER], giving, camera, cameras)
    views = tuple(_with_taker(view, casts, taking, camera) for view in rig.views)
    moments = [np.rint(view.times_s() * camera.frame_rate).astype(np.int64) for view in views]
    return HandoverSimulation(
        RigSimulation(views),
        tuple(holders[moment] for moment in moments),
        tuple(_numbers(casts[GIVER], view.simulation) for view in views),
    )


def _two_right_handed(seed: int) -> tuple[Casting, Casting]:
    """Giver and taker: the first two right-handed people of a seed."""
    casts = (
        Casting(_USE, participant, seed, views=ROAMING_VIEWS, roaming=True)
        for participant in range(seed + 1000)
    )
    right = (cast for cast in casts if cast.person().handedness == "right")
    return next(right), next(right)


@dataclass(frozen=True)
class _Grip:
    """How a person has the mug: chest_from_hand while it is carried, and hand_from_object."""

    chest_from_hand: Transform
    hand_from_object: Transform
    world_from_object: Transform


def _grip(cast: Casting) -> _Grip:
    """The grip of who holds the mug between two sips."""
    enacted = enact(replace(cast, roaming=False), 360, KINECT.frame_rate)
    held = next(stage for stage in enacted.stages if stage.name == "hold")
    frame = round(held.at(0.5) * KINECT.frame_rate)
    hand, mug = enacted.body.from_right_hand[frame], enacted.world_from_object[frame]
    return _Grip(enacted.body.from_chest[frame].inverse() @ hand, hand.inverse() @ mug, mug)


def _enact(
    casts: tuple[Casting, Casting], times: Array
) -> tuple[tuple[BodyMotion, BodyMotion], Transform, Bytes]:
    """Both bodies and the mug in the rig's frame, and who has it (T,)."""
    grips = (_grip(casts[GIVER]), _grip(casts[TAKER]))
    height = DEFAULT_HANDOVER.height * np.mean([cast.person().height for cast in casts])
    # The taker's hand is about the mug from the other side.
    opposite = Transform(np.zeros(3), rotation_about("z", np.pi))
    hands_from_object = (
        grips[GIVER].hand_from_object,
        grips[TAKER].hand_from_object @ opposite.inverse(),
    )
    places = [_meeting_place(role) for role in (GIVER, TAKER)]
    handed = Transform(
        np.array([0.0, 0.0, height]),
        places[GIVER].rotation @ grips[GIVER].world_from_object.rotation,
    )
    bodies = tuple(
        _walk_and_hand(
            casts[role],
            role,
            times,
            grips[role].chest_from_hand,
            places[role].inverse() @ handed @ hands_from_object[role].inverse(),
        ).seen_from(places[role])
        for role in (GIVER, TAKER)
    )
    holders = (times >= DEFAULT_HANDOVER.handed_s).astype(np.uint8)
    in_hand = [
        body.from_right_hand @ hand for body, hand in zip(bodies, hands_from_object, strict=True)
    ]
    given = holders == GIVER
    mug = Transform(
        np.where(given[:, None], in_hand[GIVER].translation, in_hand[TAKER].translation),
        np.where(given[:, None, None], in_hand[GIVER].rotation, in_hand[TAKER].rotation),
    )
    return (bodies[GIVER], bodies[TAKER]), mug, holders


def _meeting_place(role: int) -> Transform:
    """Where somebody stands while the mug changes hands, world_from_place: it does over the origin,
    a little to the right of both."""
    turn = rotation_about("z", -0.5 * np.pi if role == GIVER else 0.5 * np.pi)
    return Transform(turn @ np.array([-DEFAULT_HANDOVER.aside, -DEFAULT_HANDOVER.ahead, 0.0]), turn)


def _walk_and_hand(
    cast: Casting, role: int, times: Array, chest_from_hand: Transform, handing: Transform
) -> BodyMotion:
    """Come, hand over or take, and pass, in a frame whose origin is the meeting place."""
    person, random = cast.person(), cast.random("handover")
    usual = DEFAULT_HANDOVER
    posture = stand(person, times, random, _upright(person, len(times)))
    trunk = place_trunk(person, posture)
    hanging, left = hanging_hands(person, trunk, random)
    carrying = trunk.world_from_chest @ chest_from_hand
    first, last = (carrying, hanging) if role == GIVER else (hanging, carrying)
    offered = handing.repeated(len(times))
    begun, over = usual.offered_s if role == GIVER else usual.reached_s
    right = move_through(
        times,
        [
            Key(0.0, first),
            Key(begun, first),
            Key(over, offered),
            Key(usual.handed_s + usual.lingering_s, offered),
            Key(usual.handed_s + usual.lingering_s + usual.way_s, last),
        ],
    )
    contact = np.full(len(times), ContactKind.RIGHT_HAND, np.uint8)
    done = Performance(posture, right, left, right, contact, (), ())
    vertices = INTERACTIONS[_USE].object_model().vertices
    moved = walk_along(person, done, vertices, times, _way())
    return place_body(person, moved.posture, moved.right_hand, moved.left_hand)


def _upright(person: SimulatedPerson, frames: int) -> Stance:
    right, left = feet_apart(person, frames)
    still = np.zeros((frames, 3))
    return Stance(right, left, np.zeros(frames), still, still, still)


def _way() -> list[WayPoint]:
    """From behind to the meeting place, to the own left and past the other."""
    return [
        WayPoint(time, time, time, 0.0, place)
        for time, place in (
            (DEFAULT_HANDOVER.comes_s[0], (0.0, -DEFAULT_HANDOVER.from_m)),
            (DEFAULT_HANDOVER.comes_s[1], (0.0, 0.0)),
            (DEFAULT_HANDOVER.passes_s[0], (0.0, 0.0)),
            (DEFAULT_HANDOVER.passes_s[1], DEFAULT_HANDOVER.evades_m),
            (DEFAULT_HANDOVER.passes_s[2], DEFAULT_HANDOVER.leaves_m),
        )
    ]


def _with_taker(
    view: RigView, casts: tuple[Casting, Casting], taking: Enactment, camera: Camera
) -> RigView:
    """The view with the taker in it, and what of both skeletons is read where one hides the
    other."""
    seen = view.simulation
    at_moments = enactment_at(taking, camera.frame_rate, view.times_s())
    taker = at_moments.body.seen_from(seen.camera_from_world)
    giver = seen.body_in_camera
    readings = [
        _read(cast, view, own, other, of)
        for cast, own, other, of in (
            (casts[GIVER], giver, taker, casts[TAKER].person()),
            (casts[TAKER], taker, giver, casts[GIVER].person()),
        )
    ]
    companion = Companion(casts[TAKER].person(), taker, readings[TAKER])
    both = replace(
        seen, interaction=HANDOVER, reading=readings[GIVER], others=(companion,), stages=()
    )
    return replace(view, simulation=both)


def _read(
    cast: Casting, view: RigView, own: BodyMotion, other: BodyMotion, of: SimulatedPerson
) -> SkeletonReading:
    """A skeleton of who may be behind somebody; nobody is followed who is hidden for the most."""
    covered = joints_behind(of, other.joints, own.joints)
    random = cast.random(purpose_of_view("handover skeleton", view.simulation.view))
    rate = view.simulation.frame_rate
    reading = read_skeleton(cast.person(), own.joints, rate, random, covered=covered)
    lost: Flags = covered.mean(axis=1) > DEFAULT_HANDOVER.most_covered
    return SkeletonReading(
        reading.joints,
        np.where(lost[:, None], MISSING, reading.states).astype(np.uint8),
        np.where(lost[:, None], 0.0, reading.confidences),
    )


def _numbers(cast: Casting, seen: Simulation) -> Indices:
    """Numbers (T, 2) of giver and taker in a camera, -1 where it does not follow them."""
    random = cast.random(f"numbers/{seen.view}")
    following = [int(random.integers(0, 2)), 0]
    following[1] = 1 - following[0]
    readings = (seen.reading, seen.others[0].reading)
    followed = np.stack([(one.states != MISSING).any(axis=1) for one in readings], axis=1)
    numbers = np.full(followed.shape, -1, np.int64)
    longest = round(DEFAULT_HANDOVER.forgotten_s * seen.frame_rate)
    away, following_next = [0, 0], 2
    for frame in range(len(numbers)):
        for role in (GIVER, TAKER):
            if not followed[frame, role]:
                away[role] += 1
                continue
            if away[role] > longest:
                following[role], following_next = following_next, following_next + 1
            away[role] = 0
            numbers[frame, role] = following[role]
    return numbers
