"""Simulated people who use nothing: they stand about, or walk, before the same skeleton tracker.

Those who fidget move their hands anywhere: recognition learns from them, and from people who walk,
what using nothing looks like. Those who gesture touch their faces, cross their arms and so on; of
them nobody learns.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Literal, get_args

import numpy as np

from inhand_lab.geometry.transforms import Transform, normalised
from inhand_lab.motions.performance import ContactKind
from inhand_lab.people.joint_sequence import JointSequence
from inhand_lab.people.person import sample_person
from inhand_lab.sensing.cameras import KINECT
from inhand_lab.sensing.skeleton_noise import MISSING, read_skeleton
from inhand_lab.world.idle_hands import (
    MoveHands,
    fidgeting_hands,
    gesturing_hands,
    stand_about,
    still_hands,
)
from inhand_lab.world.interactions import INTERACTIONS
from inhand_lab.world.parameters import IDLE_CAMERA_PLACING
from inhand_lab.world.room import RoomPlan
from inhand_lab.world.simulation import Simulation
from inhand_lab.world.viewpoint import facing_of, looking
from inhand_lab.world.walking import walk

Idleness = Literal["stand", "gesture", "walkOnSpot", "walkAbout", "fidget"]
IDLENESS: tuple[Idleness, ...] = get_args(Idleness)

HANDS_OF: dict[str, MoveHands] = {
    "stand": still_hands,
    "gesture": gesturing_hands,
    "fidget": fidgeting_hands,
}
"""What the hands do of those who stand; the others walk."""
CIRCLE = 0.9
"""Radius of the way of who walks about, metres."""
SPACE_TO_WALK = 0.5
"""Distance by which the wall is farther back in a room to walk about in, metres."""
UNUSED = INTERACTIONS["drinkFromMug"]
"""A simulation has an object: that of these people is behind the camera."""


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
    """Simulate somebody idle before the camera, for as many frames; the object is out of sight."""
    person = sample_person(seed, participant)
    random = np.random.default_rng([seed, participant, IDLENESS.index(idleness), 0x1D7E])
    times = np.arange(frames) / frame_rate
    if idleness in HANDS_OF:
        body = stand_about(person, times, random, HANDS_OF[idleness])
    else:
        body = walk(person, times, random, 0.0 if idleness == "walkOnSpot" else CIRCLE)
    camera_from_world = _place_camera(random)
    seen = body.seen_from(camera_from_world)
    viewpoint = camera_from_world.inverse().translation
    space = SPACE_TO_WALK if idleness == "walkAbout" else 0.0
    further = -space * normalised(viewpoint * [1.0, 1.0, 0.0])
    return Simulation(
        interaction=idleness,
        participant=participant,
        seed=seed,
        performance=0,
        person=person,
        object_model=UNUSED.object_model(),
        camera=replace(KINECT, frame_rate=frame_rate),
        reading=read_skeleton(person, seen.joints, frame_rate, random),
        body_in_camera=seen,
        camera_from_object=Transform(np.array([0.0, 0.0, -9.0]), np.eye(3)).repeated(frames),
        contact=np.full(frames, ContactKind.RESTING, np.uint8),
        camera_from_world=camera_from_world @ Transform(further, np.eye(3)),
        room=RoomPlan(facing_of(camera_from_world)),
    )


def _place_camera(random: np.random.Generator) -> Transform:
    """camera_from_world of a camera that looks at the world's origin."""
    placing = IDLE_CAMERA_PLACING
    aside = random.uniform(-placing.aside, placing.aside)
    distance = random.uniform(*placing.distance)
    height = random.uniform(*placing.height)
    position = np.array([np.sin(aside) * distance, np.cos(aside) * distance, height])
    return looking(position, np.array([0.0, 0.0, 0.8]))
