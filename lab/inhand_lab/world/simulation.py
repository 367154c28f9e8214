"""A simulated recording: somebody does something with an object before a camera.

simulation = simulate("drinkFromMug", participant=0, seed=1)
simulation.joints_in_camera            # what a skeleton tracker says
simulation.camera_from_object[100]     # where the mug truly is
frame = simulation.render(100)         # what the camera sees
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from inhand_tracker.geometry.arrays import Array, Bytes
from inhand_tracker.geometry.camera import Intrinsics
from numpy.typing import NDArray

from inhand_lab.geometry.transforms import Transform, quaternions
from inhand_lab.motions.furniture import Furniture
from inhand_lab.motions.timeline import Stage
from inhand_lab.objects.model import ObjectModel
from inhand_lab.people.body_motion import BodyMotion
from inhand_lab.people.kinematics import place_body
from inhand_lab.people.person import USUAL_PEOPLE, People, SimulatedPerson, sample_person
from inhand_lab.people.person_surface import build_person_surface
from inhand_lab.sensing.cameras import KINECT, Camera
from inhand_lab.sensing.motion_blur import blurred, surfaces_in_motion
from inhand_lab.sensing.moving_scene import MovingScene
from inhand_lab.sensing.noise_fields import Place, any_place
from inhand_lab.sensing.render import (
    OBJECT,
    Drawing,
    draw_frame,
    draw_room,
    object_surface,
    visible_fraction,
)
from inhand_lab.sensing.sensor import FrameConditions, brightness, read_still, sense
from inhand_lab.sensing.skeleton_noise import SkeletonReading, read_skeleton
from inhand_lab.sensing.structured_light import StillRoom
from inhand_lab.world.enactment import Enactment
from inhand_lab.world.interactions import INTERACTIONS
from inhand_lab.world.parameters import DEFAULT_ROAMING, USUAL_VIEWS
from inhand_lab.world.random_streams import random_stream
from inhand_lab.world.roaming import ROAMING_INTERACTIONS, roam
from inhand_lab.world.room import RoomPlan, build_room
from inhand_lab.world.viewpoint import place_camera

USUAL_SECONDS = 12.0
"""Time that a performance takes, unless more frames are asked for, seconds."""


@dataclass(frozen=True)
class SensedFrame:
    """The sensor's picture: colour (H, W, 3) RGB, depth (H, W) in millimetres (0 is nothing).

    ``visible_fraction`` is the share of the object's pixels that nothing hides.
    """

    colour: Bytes
    depth: NDArray[np.uint16]
    visible_fraction: float


@dataclass(frozen=True)
class Companion:
    """Somebody else in a simulation of T frames, in the camera's frame, as the tracker reads them
    and as they truly are."""

    person: SimulatedPerson
    body_in_camera: BodyMotion
    reading: SkeletonReading


@dataclass(frozen=True)
class Simulation:
    """A recording of T frames with its truth, everything in the camera's frame, in metres.

    ``reading`` is the skeleton tracker's; body, camera_from_object and ``contact`` (T,), as values
    of ContactKind, are the truth. ``stages`` are what is done when, in seconds; the last may lie
    beyond the last frame. ``view`` is the camera's number in a rig (inhand_lab.world.rigs), 0 where
    it is alone: each has errors of its own in the same room. ``others`` are there besides.
    """

    interaction: str
    participant: int
    seed: int
    performance: int
    person: SimulatedPerson
    object_model: ObjectModel
    camera: Camera
    reading: SkeletonReading
    body_in_camera: BodyMotion
    camera_from_object: Transform
    contact: Bytes
    camera_from_world: Transform
    room: RoomPlan
    furniture: Furniture = ()
    stages: Sequence[Stage] = ()
    view: int = 0
    others: tuple[Companion, ...] = ()

    @property
    def intrinsics(self) -> Intrinsics:
        """The camera's intrinsics."""
        return self.camera.intrinsics

    @property
    def frame_rate(self) -> float:
        """Frames a second."""
        return self.camera.frame_rate

    @property
    def frames(self) -> int:
        """Number of frames T."""
        return len(self.joints_in_camera)

    @property
    def joints_in_camera(self) -> Array:
        """The tracker's joints (T, 20, 3)."""
        return self.reading.joints

    @property
    def joint_states(self) -> Bytes:
        """The tracker's states (T, 20): 0 missing, 1 inferred, 2 tracked."""
        return self.reading.states

    @property
    def joint_confidences(self) -> Array:
        """The tracker's confidences (T, 20)."""
        return self.reading.confidences

    @property
    def true_joints_in_camera(self) -> Array:
        """The true joints (T, 20, 3)."""
        return self.body_in_camera.joints

    @property
    def translations(self) -> Array:
        """Translations (T, 3) of camera_from_object."""
        return self.camera_from_object.translation

    @cached_property
    def rotations(self) -> Array:
        """Rotations (T, 4) of camera_from_object, (w, x, y, z), of continuous sign."""
        return quaternions(self.camera_from_object.rotation)

    def prepare(self) -> None:
        """Draw what stands still, which the first frame would otherwise wait for."""
        self.render(0)

    def draw(self, frame: int) -> Drawing:
        """The frame as a perfect sensor would see it."""
        return draw_frame(self._scene, frame)

    def visible_fraction(self, frame: int) -> float:
        """Share of the object's pixels that nothing hides, quicker than by drawing it all."""
        return visible_fraction(self._scene, frame)

    def render(self, frame: int) -> SensedFrame:
        """The frame as the sensor sees it; the same whenever and however often it is asked for."""
        drawing, scene = self.draw(frame), self._scene
        exposure = self.camera.exposure * self.frame_rate
        moving = surfaces_in_motion(scene, frame, exposure)
        colour = blurred(drawing.canvas, scene.room, self.intrinsics, moving)
        conditions = FrameConditions(
            self._gains[frame],
            0 if self.object_model.returns_depth else OBJECT,
            self._lasting,
            self._still,
            drawing.drawn.area,
        )
        random = self._random_of_view("pixels", self.performance, frame)
        canvas = replace(drawing.canvas, colour=colour)
        return SensedFrame(
            *sense(canvas, self.camera, random, conditions), drawing.visible_fraction
        )

    def _random(self, purpose: str, *more: int) -> np.random.Generator:
        return random_stream(self.seed, self.participant, self.interaction, purpose, *more)

    def _random_of_view(self, purpose: str, *more: int) -> np.random.Generator:
        return self._random(purpose_of_view(purpose, self.view), *more)

    @cached_property
    def _gains(self) -> Array:
        times = np.arange(self.frames) / self.frame_rate
        return brightness(times, self._random_of_view("brightness", self.performance))

    @cached_property
    def _lasting(self) -> Place:
        return any_place(self._random_of_view("sensor"))

    @cached_property
    def _still(self) -> StillRoom | None:
        return read_still(self._scene.room, self.camera, self._lasting)

    @cached_property
    def _scene(self) -> MovingScene:
        room = build_room(self._random("room"), self.room, self.furniture)
        return MovingScene(
            draw_room(self.intrinsics, self.camera_from_world, room),
            self.intrinsics,
            tuple(
                (build_person_surface(person, body.joints[0]), body)
                for person, body in (
                    (self.person, self.body_in_camera),
                    *((one.person, one.body_in_camera) for one in self.others),
                )
            ),
            object_surface(self.object_model),
            self.camera_from_object,
        )


@dataclass(frozen=True)
class Casting:
    """Who does what in which world, for which time, seen from where.

    ``views`` names one of CAMERA_PLACINGS, and ``people`` who lives there; who is ``roaming`` walks
    about and turns while using the thing.
    """

    interaction: str
    participant: int
    seed: int
    performance: int = 0
    views: str = USUAL_VIEWS
    people: People = USUAL_PEOPLE
    roaming: bool = False

    def person(self) -> SimulatedPerson:
        """The participant, who is the same in every interaction of a seed."""
        return sample_person(self.seed, self.participant, self.people)

    def room(self, facing: float) -> RoomPlan:
        """The room, seen from a direction: deeper for whoever walks about."""
        return RoomPlan(facing, DEFAULT_ROAMING.further if self.roaming else 0.0)

    def random(self, purpose: str, *more: int) -> np.random.Generator:
        """A stream of its own for a purpose."""
        return random_stream(self.seed, self.participant, self.interaction, purpose, *more)


def simulate(
    interaction: str,
    participant: int,
    seed: int,
    frames: int = 360,
    camera: Camera = KINECT,
    performance: int = 0,
) -> Simulation:
    """Simulate somebody who does something; raises ValueError for an unknown interaction.

    The participant is the same person in every interaction of a seed, and stands in the same room
    before the same camera in every performance of an interaction. A performance lasts 12 s or as
    long as the frames, whichever is longer; fewer frames are the beginning of more.
    """
    return simulate_cast(Casting(interaction, participant, seed, performance), frames, camera)


def simulate_cast(cast: Casting, frames: int, camera: Camera) -> Simulation:
    """Simulate as ``simulate`` does; raises ValueError for an unknown interaction."""
    enacted = enact(cast, frames, camera.frame_rate)
    facing, camera_from_world = place_camera(
        cast.person(), camera.intrinsics, cast.random("camera"), enacted.furniture, cast.views
    )
    return film(cast, enacted, camera, Viewpoint(camera_from_world, cast.room(facing)))


@dataclass(frozen=True)
class Viewpoint:
    """Where a camera stands in the person's world, in which room, and its number in a rig."""

    camera_from_world: Transform
    room: RoomPlan
    number: int = 0


def film(cast: Casting, enacted: Enactment, camera: Camera, viewpoint: Viewpoint) -> Simulation:
    """What one camera and its skeleton tracker see of what is enacted, a frame a moment."""
    person, performance = cast.person(), cast.performance
    body_in_camera = enacted.body.seen_from(viewpoint.camera_from_world)
    skeleton = cast.random(purpose_of_view("skeleton", viewpoint.number), performance)
    return Simulation(
        interaction=cast.interaction,
        participant=cast.participant,
        seed=cast.seed,
        performance=performance,
        person=person,
        object_model=INTERACTIONS[cast.interaction].object_model(),
        camera=camera,
        reading=read_skeleton(person, body_in_camera.joints, camera.frame_rate, skeleton),
        body_in_camera=body_in_camera,
        camera_from_object=viewpoint.camera_from_world @ enacted.world_from_object,
        contact=enacted.contact,
        camera_from_world=viewpoint.camera_from_world,
        room=viewpoint.room,
        furniture=enacted.furniture,
        stages=enacted.stages,
        view=viewpoint.number,
    )


def purpose_of_view(purpose: str, view: int) -> str:
    """Name of a camera's random numbers: those of a rig's first are a single camera's."""
    return f"{purpose}/{view}" if view else purpose


def enact(cast: Casting, frames: int, frame_rate: float) -> Enactment:
    """The first frames of a performance, mirrored for a left-handed person.

    Raises ValueError for an unknown interaction, and for one that is not done on the way, or by
    varied people, where somebody is to walk about.
    """
    if cast.interaction not in INTERACTIONS:
        known = ", ".join(INTERACTIONS)
        raise ValueError(f"no interaction {cast.interaction!r}; there are {known}")
    if cast.roaming and cast.interaction not in ROAMING_INTERACTIONS:
        able = ", ".join(ROAMING_INTERACTIONS)
        raise ValueError(f"nobody walks about in {cast.interaction!r}, but in {able}")
    if cast.roaming and cast.people != USUAL_PEOPLE:
        raise ValueError("only usual people walk about: some of the varied ones sit")
    person, random = cast.person(), cast.random("motion", cast.performance)
    seconds = max(USUAL_SECONDS, frames / frame_rate)
    times = np.arange(round(seconds * frame_rate)) / frame_rate
    done = INTERACTIONS[cast.interaction].perform(person, times, random)
    if cast.roaming:
        vertices = INTERACTIONS[cast.interaction].object_model().vertices
        done = roam(person, done, vertices, times, cast.random("roaming", cast.performance))
    body = place_body(person, done.posture, done.right_hand, done.left_hand)
    enacted = Enactment(body, done.world_from_object, done.contact, done.furniture, done.stages)[
        :frames
    ]
    return enacted.mirrored() if person.handedness == "left" else enacted
