"""A simulated recording: somebody does something with an object before a camera.

simulation = simulate("drinkFromMug", participant=0, seed=1)
simulation.joints_in_camera            # what a skeleton tracker says
simulation.camera_from_object[100]     # where the mug truly is
frame = simulation.render(100)         # what the camera sees
"""

from __future__ import annotations

import zlib
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from inhand_tracker.geometry.arrays import Array, Bytes
from inhand_tracker.geometry.camera import Intrinsics
from numpy.typing import NDArray

from inhand_lab.geometry.rasteriser import Canvas
from inhand_lab.geometry.surfaces import Surface
from inhand_lab.geometry.transforms import Transform, normalised, quaternions, rotation_about
from inhand_lab.motions.furniture import Furniture
from inhand_lab.motions.performance import ContactKind
from inhand_lab.objects.model import ObjectModel
from inhand_lab.people.body_motion import BodyMotion
from inhand_lab.people.kinematics import place_body
from inhand_lab.people.person import SimulatedPerson, sample_person
from inhand_lab.people.person_surface import PersonSurface, build_person_surface
from inhand_lab.sensing.cameras import KINECT, Camera
from inhand_lab.sensing.motion_blur import blurred, scene_in_motion
from inhand_lab.sensing.noise_fields import any_place
from inhand_lab.sensing.render import (
    OBJECT,
    Drawing,
    draw_frame,
    draw_room,
    object_surface,
    visible_fraction,
)
from inhand_lab.sensing.sensor import FrameConditions, brightness, sense
from inhand_lab.sensing.skeleton_noise import read_skeleton
from inhand_lab.world.interactions import INTERACTIONS as PERFORMED
from inhand_lab.world.room import build_room

INTERACTIONS: tuple[str, ...] = tuple(PERFORMED)
"""Names of what people can do here."""

VERSION = 5
"""Of the generator: the same version and seed make the same bytes."""
PEOPLE = 4
"""The version whose people and movements these are: what a version leaves alone stays the same."""

USUAL_SECONDS = 12.0
CAMERA_HEIGHT = (1.0, 1.4)
CAMERA_DISTANCE = (2.2, 3.0)
CAMERA_ASIDE = np.radians(30.0)
HEADROOM = 0.60
"""How much more than the person, in metres, is in the image from top to bottom."""


@dataclass(frozen=True)
class SensedFrame:
    """What the sensor saw: colour (H, W, 3) RGB, depth (H, W) in millimetres (0 is nothing), and
    the share of the object's pixels that nothing hides."""

    colour: Bytes
    depth: NDArray[np.uint16]
    visible_fraction: float


@dataclass(frozen=True)
class Simulation:
    """A recording of T frames with its truth, everything in the camera's frame, in metres.

    joints_in_camera (T, 20, 3), joint_states (T, 20) as 0 missing, 1 inferred, 2 tracked, and
    joint_confidences (T, 20) are a skeleton tracker's. true_joints_in_camera (T, 20, 3),
    translations (T, 3) and rotations (T, 4) (w, x, y, z) of camera_from_object, and contact (T,)
    as values of ContactKind are the truth.
    """

    interaction: str
    participant: int
    seed: int
    performance: int
    frame_rate: float
    person: SimulatedPerson
    object_model: ObjectModel
    camera: Camera
    joints_in_camera: Array
    joint_states: Bytes
    joint_confidences: Array
    body_in_camera: BodyMotion
    camera_from_object: Transform
    contact: Bytes
    camera_from_world: Transform
    facing: float
    furniture: Furniture

    @property
    def intrinsics(self) -> Intrinsics:
        """The camera's."""
        return self.camera.intrinsics

    @property
    def frames(self) -> int:
        """T."""
        return len(self.joints_in_camera)

    @property
    def true_joints_in_camera(self) -> Array:
        """(T, 20, 3)."""
        return self.body_in_camera.joints

    @property
    def translations(self) -> Array:
        """(T, 3)."""
        return self.camera_from_object.translation

    @cached_property
    def rotations(self) -> Array:
        """(T, 4), (w, x, y, z), of continuous sign."""
        return quaternions(self.camera_from_object.rotation)

    def prepare(self) -> None:
        """Draw what stands still, which the first frame would otherwise wait for."""
        self.render(0)

    def draw(self, frame: int) -> Drawing:
        """The frame as a perfect sensor would see it."""
        return draw_frame(
            self._room,
            self.intrinsics,
            self._figure,
            self.body_in_camera,
            frame,
            self._object_surface,
            self.camera_from_object[frame],
        )

    def visible_fraction(self, frame: int) -> float:
        """The share of the object's pixels that nothing hides, quicker than by drawing it all."""
        return visible_fraction(
            self._room,
            self.intrinsics,
            self._figure,
            self.body_in_camera,
            frame,
            self._object_surface,
            self.camera_from_object[frame],
        )

    def render(self, frame: int) -> SensedFrame:
        """The frame as the sensor sees it; the same whenever and however often it is asked for."""
        drawing = self.draw(frame)
        random = self._random("pixels", self.performance, frame)
        scene = scene_in_motion(
            self._figure,
            self.body_in_camera,
            self._object_surface,
            self.camera_from_object,
            frame,
            self.camera.exposure * self.frame_rate,
        )
        colour, depth = sense(
            replace(
                drawing.canvas,
                colour=blurred(drawing.canvas, self._room, self.intrinsics, scene),
            ),
            self.camera,
            random,
            FrameConditions(
                self._gains[frame],
                0 if self.object_model.returns_depth else OBJECT,
                any_place(self._random("sensor")),
            ),
        )
        return SensedFrame(colour, depth, drawing.visible_fraction)

    def _random(self, purpose: str, *more: int) -> np.random.Generator:
        return _random(self.seed, self.participant, self.interaction, purpose, *more)

    @cached_property
    def _gains(self) -> Array:
        times = np.arange(self.frames) / self.frame_rate
        return brightness(times, self._random("brightness", self.performance))

    @cached_property
    def _room(self) -> Canvas:
        room = build_room(self._random("room"), self.facing, self.furniture)
        return draw_room(self.intrinsics, self.camera_from_world, room)

    @cached_property
    def _figure(self) -> PersonSurface:
        return build_person_surface(self.person, self.true_joints_in_camera[0])

    @cached_property
    def _object_surface(self) -> Surface:
        return object_surface(self.object_model)


def simulate(
    interaction: str,
    participant: int,
    seed: int,
    frames: int = 360,
    frame_rate: float = 30.0,
    camera: Camera = KINECT,
    performance: int = 0,
) -> Simulation:
    """Somebody's performance of an interaction; raises ValueError for one nobody knows.

    The participant is the same person in every interaction of a seed, and stands in the same room
    before the same camera in every performance of an interaction. A performance lasts 12 s or as
    long as the frames, whichever is longer; fewer frames are the beginning of more.
    """
    if interaction not in PERFORMED:
        raise ValueError(f"no interaction {interaction!r}; there are {', '.join(INTERACTIONS)}")
    person = sample_person(seed, participant)
    left_handed = person.handedness == "left"
    seconds = max(USUAL_SECONDS, frames / frame_rate)
    times = np.arange(round(seconds * frame_rate)) / frame_rate
    doing = PERFORMED[interaction]
    motion = _random(seed, participant, interaction, "motion", performance)
    done = doing.perform(person, times, motion)
    body = place_body(person, done.posture, done.right_hand, done.left_hand)
    world_from_object, contact, furniture = done.world_from_object, done.contact, done.furniture
    if left_handed:
        body, world_from_object = body.mirrored(), world_from_object.mirrored()
        contact = MIRRORED_CONTACT[contact]
        furniture = tuple(box.mirrored() for box in furniture)
    facing, camera_from_world = _place_camera(
        person, camera.intrinsics, _random(seed, participant, interaction, "camera")
    )
    shown = slice(0, frames)
    body_in_camera = body[shown].seen_from(camera_from_world)
    reading = read_skeleton(
        person,
        body_in_camera.joints,
        frame_rate,
        _random(seed, participant, interaction, "skeleton", performance),
    )
    return Simulation(
        interaction,
        participant,
        seed,
        performance,
        frame_rate,
        person,
        doing.object_model(),
        camera,
        reading.joints,
        reading.states,
        reading.confidences,
        body_in_camera,
        camera_from_world @ world_from_object[shown],
        contact[shown],
        camera_from_world,
        facing,
        furniture,
    )


MIRRORED_CONTACT = np.array(
    [
        ContactKind.RESTING,
        ContactKind.LEFT_HAND,
        ContactKind.RIGHT_HAND,
        ContactKind.BOTH_HANDS,
        ContactKind.WORN,
    ],
    np.uint8,
)


def _random(
    seed: int, participant: int, interaction: str, purpose: str, *more: int
) -> np.random.Generator:
    """A stream of its own for every purpose, so that none depends on how much another draws."""
    named = zlib.crc32(f"{interaction}/{purpose}".encode())
    return np.random.default_rng([PEOPLE, seed, participant, named, *more])


def _place_camera(
    person: SimulatedPerson, intrinsics: Intrinsics, random: np.random.Generator
) -> tuple[float, Transform]:
    """The direction to the camera as a turn to the person's left, and camera_from_world."""
    facing = float(random.uniform(-CAMERA_ASIDE, CAMERA_ASIDE))
    fitting = (person.height + HEADROOM) * intrinsics.fy / intrinsics.height
    distance = max(random.uniform(*CAMERA_DISTANCE), fitting)
    ahead = rotation_about("z", facing)[:, 1]
    position = ahead * distance + np.array([0.0, 0.0, random.uniform(*CAMERA_HEIGHT)])
    target = np.array([0.0, 0.0, 0.43 * person.height + random.normal(0.0, 0.02)])
    forward = normalised(target - position)
    right = normalised(np.cross(forward, [0.0, 0.0, 1.0]))
    world_from_camera = np.stack([right, np.cross(forward, right), forward], axis=1)
    return facing, Transform(position, world_from_camera).inverse()
