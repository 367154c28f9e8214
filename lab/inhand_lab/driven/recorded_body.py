"""Real movement, with its real tracking noise, drives the world in place of a synthetic person.

The measured joints are what a tracker is given. The truth is built upon the body that denoising
finds behind them: the object is held as that participant would hold it in the simulated
interaction, in a wrist that turns as no skeleton shows. So the object's pose is known exactly,
while the body that carries it is only near the one that was recorded.
"""

from __future__ import annotations

import zlib
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from inhand_schemas.joints import Joint
from inhand_tracker.body.skeleton import mirror_joints
from inhand_tracker.geometry.arrays import Array, Bytes

from inhand_lab.driven.denoising import bone_lengths, denoise
from inhand_lab.driven.holds import attach, rehearse
from inhand_lab.driven.parameters import DEFAULT_HOLD
from inhand_lab.driven.seen_frames import SeenFrames, seen_frames
from inhand_lab.geometry.transforms import (
    Transform,
    normalised,
    rotation_about,
    rotation_from_axes,
)
from inhand_lab.motions.timeline import drift
from inhand_lab.people.body_motion import BodyMotion
from inhand_lab.people.person import Proportions, SimulatedPerson, sample_person, stature_of
from inhand_lab.sensing.cameras import KINECT, Camera
from inhand_lab.sensing.skeleton_noise import SkeletonReading
from inhand_lab.world.enactment import Enactment
from inhand_lab.world.interactions import INTERACTIONS
from inhand_lab.world.random_streams import PEOPLE_VERSION
from inhand_lab.world.room import RoomPlan
from inhand_lab.world.simulation import Simulation
from inhand_lab.world.viewpoint import facing_of


@dataclass(frozen=True)
class RecordedBody:
    """What a tracker saw of one person over T frames, in the camera's frame.

    ``joints`` (T, 20, 3) are in metres, NaN where one is missing, ``states`` (T, 20) as in
    Simulation, ``confidences`` (T, 20); ``participant`` is the person's number, ``recording`` that
    of one of the person's takes; ``convention`` names whose joints they are, if that is known.
    """

    joints: Array
    states: Bytes
    confidences: Array
    frame_rate: float
    handedness: Literal["left", "right"]
    participant: int
    recording: int
    convention: str | None = None


def drive(
    recorded: RecordedBody, interaction: str, seed: int, camera: Camera = KINECT
) -> Simulation:
    """Simulate an interaction's object, held or worn all the time, in a recorded movement."""
    camera_joints = denoise(recorded.joints, recorded.frame_rate)
    camera_from_world = _world_of(camera_joints)
    joints = camera_from_world.inverse().apply(camera_joints)
    left_handed = recorded.handedness == "left"
    if left_handed:
        joints = mirror_joints(joints)
    person = _person_of(joints, recorded, seed)
    times = np.arange(len(joints)) / recorded.frame_rate
    random = _random_stream_of(recorded, interaction, seed)
    hold = rehearse(interaction, sample_person(seed, recorded.participant), seed)
    seen = seen_frames(joints, recorded.frame_rate)
    body = _turn_unseen(joints, seen, hold.right_wrist, hold.left_wrist, times, random)
    world_from_object = attach(hold, body, seen, times, random)
    enacted = Enactment(body, world_from_object, np.full(len(joints), hold.contact, np.uint8))
    if left_handed:
        enacted = enacted.mirrored()
    return Simulation(
        interaction=interaction,
        participant=recorded.participant,
        seed=seed,
        performance=recorded.recording,
        person=person,
        object_model=INTERACTIONS[interaction].object_model(),
        camera=replace(camera, frame_rate=recorded.frame_rate),
        reading=SkeletonReading(recorded.joints, recorded.states, recorded.confidences),
        body_in_camera=enacted.body.seen_from(camera_from_world),
        camera_from_object=camera_from_world @ enacted.world_from_object,
        contact=enacted.contact,
        camera_from_world=camera_from_world,
        room=RoomPlan(facing_of(camera_from_world)),
    )


def _random_stream_of(recorded: RecordedBody, interaction: str, seed: int) -> np.random.Generator:
    """A stream of its own for every take and interaction."""
    take = recorded.participant, recorded.recording
    named = zlib.crc32(interaction.encode())
    return np.random.default_rng([PEOPLE_VERSION, seed, *take, named])


def _world_of(joints: Array) -> Transform:
    """The person's world, camera_from_world: the floor under the feet, up along the body."""
    ankles = 0.5 * (joints[:, Joint.ANKLE_LEFT] + joints[:, Joint.ANKLE_RIGHT])
    up = normalised(np.median(joints[:, Joint.SHOULDER_CENTER] - ankles, axis=0))
    right = np.median(joints[:, Joint.HIP_RIGHT] - joints[:, Joint.HIP_LEFT], axis=0)
    forward = np.cross(up, right)
    soles = _stature(joints) * Proportions().ankle
    origin = np.median(ankles, axis=0) - soles * up
    return Transform(origin, rotation_from_axes(forward, up))


def _stature(joints: Array) -> float:
    """Height in metres of a person whose bones are as long as those of joints (T, 20, 3)."""
    average = Proportions()
    bones = bone_lengths(joints)
    measured = sum(
        bones[joint - 1]
        for joint in (
            Joint.ANKLE_RIGHT,
            Joint.KNEE_RIGHT,
            Joint.SPINE,
            Joint.SHOULDER_CENTER,
            Joint.HEAD,
        )
    )
    usual = average.shank + average.thigh + average.spine + average.chest + average.neck
    return float(measured * stature_of(average) / usual)


def _person_of(joints: Array, recorded: RecordedBody, seed: int) -> SimulatedPerson:
    """The recorded body with the manner of the seed's participant of that number."""
    manner = sample_person(seed, recorded.participant)
    height = _stature(joints)
    usual = {name: fraction * height for name, fraction in vars(Proportions()).items()}
    bones = bone_lengths(joints)
    measured = {
        "upper_arm": bones[Joint.ELBOW_RIGHT - 1],
        "forearm": bones[Joint.WRIST_RIGHT - 1],
        "thigh": bones[Joint.KNEE_RIGHT - 1],
        "shank": bones[Joint.ANKLE_RIGHT - 1],
        "spine": bones[Joint.SPINE - 1],
        "chest": bones[Joint.SHOULDER_CENTER - 1],
        "neck": bones[Joint.HEAD - 1],
    }
    proportions = Proportions(**{**usual, **{name: float(m) for name, m in measured.items()}})
    return replace(manner, height=height, handedness=recorded.handedness, proportions=proportions)


def _turn_unseen(
    joints: Array,
    seen: SeenFrames,
    right_wrist: Array,
    left_wrist: Array,
    times: Array,
    random: np.random.Generator,
) -> BodyMotion:
    """The body with its hands and head turned by what no skeleton shows."""

    def turned(hand: Transform, wrist: Array, joint: Joint) -> Transform:
        twist = rotation_about(
            "y", drift(times, random, DEFAULT_HOLD.unseen_twist, DEFAULT_HOLD.twist_period)
        )
        rotation = hand.rotation @ twist @ wrist
        root = joints[:, joint]
        palm = np.linalg.norm(hand.translation - root, axis=1, keepdims=True)
        return Transform(root + palm * rotation[:, :, 1], rotation)

    right_hand = turned(seen.right_hand, right_wrist, Joint.WRIST_RIGHT)
    left_hand = turned(seen.left_hand, left_wrist, Joint.WRIST_LEFT)
    look = rotation_about(
        "z", drift(times, random, DEFAULT_HOLD.unseen_look, DEFAULT_HOLD.look_period)
    )
    moved = joints.copy()
    moved[:, Joint.HAND_RIGHT] = right_hand.translation
    moved[:, Joint.HAND_LEFT] = left_hand.translation
    head = Transform(seen.head.translation, seen.head.rotation @ look)
    return BodyMotion(moved, seen.pelvis, seen.chest, head, right_hand, left_hand)
