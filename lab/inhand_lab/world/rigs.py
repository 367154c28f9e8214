"""Rigs of one to four simulated cameras that see the very same performance.

rig = simulate_rig("drinkFromMug", participant=0, seed=1, cameras=3)
rig.names                          # front, left, right
rig.cameras[1].joints_in_camera    # what the left camera's skeleton tracker says
rig.rig_from_camera[1]             # where that camera stands
rig.stamps_ns(1)                   # what that camera's clock says of its frames
rig.times_s(1)                     # when they truly were taken, by the rig's time
rig.dropped[1]                     # which of them are lost

The rig's frame is the person's world: z up, its origin on the floor where the person stands at
first. The rig's time is the first camera's, which is what ``simulate`` makes.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass, replace

import numpy as np
from inhand_tracker.geometry.arrays import Array, Flags
from numpy.typing import NDArray

from inhand_lab.geometry.transforms import Transform
from inhand_lab.sensing.cameras import KINECT, Camera
from inhand_lab.sensing.skeleton_noise import MISSING, SkeletonReading
from inhand_lab.world.enactment import Enactment
from inhand_lab.world.other_moments import enactment_at
from inhand_lab.world.parameters import (
    CAMERA_PLACINGS,
    RIG_CAMERAS,
    ROAMING_VIEWS,
    USUAL_RIG,
    USUAL_VIEWS,
    RigParameters,
)
from inhand_lab.world.random_streams import random_stream
from inhand_lab.world.room import RoomPlan, in_the_open, wall_place
from inhand_lab.world.simulation import Casting, Simulation, Viewpoint, enact, film
from inhand_lab.world.viewpoint import hidden, place_beside, place_camera


@dataclass(frozen=True)
class CameraClock:
    """A camera's clock against the rig's time.

    The rig's time of what the clock says, in seconds from the beginning of a performance, is
    ``(1 + drift) * said + offset_s``: the offset is what to add to the camera's times to have the
    rig's, as in a rig's calibration. The camera takes frames regularly by its own clock, the first
    at ``first_s`` of it.
    """

    offset_s: float = 0.0
    drift: float = 0.0
    first_s: float = 0.0

    def said(self, frames: int, frame_rate: float) -> Array:
        """What the clock says of frames (T,), seconds."""
        return self.first_s + np.arange(frames) / frame_rate

    def rig_times(self, said: Array) -> Array:
        """The rig's times (T,) of what the clock says (T,), seconds."""
        return (1.0 + self.drift) * said + self.offset_s


@dataclass(frozen=True)
class RigView:
    """What one camera of a rig sees; ``dropped`` (T,) is which of its frames are lost.

    Lost frames are simulated, so that whoever wants to compare can, but are not sent or written.
    """

    name: str
    simulation: Simulation
    rig_from_camera: Transform
    clock: CameraClock
    dropped: Flags

    def times_s(self) -> Array:
        """The rig's times (T,) of its frames, seconds from the performance's beginning."""
        return self.clock.rig_times(self._said())

    def stamps_ns(self) -> NDArray[np.int64]:
        """What its clock says of its frames (T,), nanoseconds; it may begin below 0."""
        return np.rint(1e9 * self._said()).astype(np.int64)

    def _said(self) -> Array:
        return self.clock.said(self.simulation.frames, self.simulation.frame_rate)


@dataclass(frozen=True)
class RigSimulation:
    """One performance as every camera of a rig sees it.

    Cameras but the first take their last frame before the first does, so that they may have one
    less.
    """

    views: tuple[RigView, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """Names: front, left and right (of the person, who faces the front), and high."""
        return tuple(view.name for view in self.views)

    @property
    def cameras(self) -> tuple[Simulation, ...]:
        """What each camera sees."""
        return tuple(view.simulation for view in self.views)

    @property
    def rig_from_camera(self) -> tuple[Transform, ...]:
        """Where each camera stands."""
        return tuple(view.rig_from_camera for view in self.views)

    @property
    def clocks(self) -> tuple[CameraClock, ...]:
        """The clock of each camera."""
        return tuple(view.clock for view in self.views)

    @property
    def dropped(self) -> tuple[Flags, ...]:
        """Which frames (T,) each camera loses."""
        return tuple(view.dropped for view in self.views)

    def times_s(self, camera: int) -> Array:
        """The rig's times (T,) of a camera's frames, seconds from the performance's beginning."""
        return self.views[camera].times_s()

    def stamps_ns(self, camera: int) -> NDArray[np.int64]:
        """What a camera's clock says of its frames (T,), nanoseconds; it may begin below 0."""
        return self.views[camera].stamps_ns()


def simulate_rig(
    interaction: str,
    participant: int,
    seed: int,
    frames: int = 360,
    cameras: int = 3,
    camera: Camera = KINECT,
    performance: int = 0,
    *,
    roaming: bool = False,
    upside_down: Collection[str] = (),
) -> RigSimulation:
    """Simulate somebody who does something before so many cameras, one to four, of one kind.

    The first camera's simulation is what ``simulate`` makes, but for the room's walls behind it,
    which it does not see. The rig is the same in every performance of a participant's interaction.
    Whoever is ``roaming`` walks about and turns while using the thing; the cameras stand farther
    away. Cameras ``upside_down``, by name, hang that way where they would stand, and follow nobody,
    as skeleton trackers do that know upright people only. Raises ValueError for an interaction that
    is unknown or not done on the way, another number of cameras, a name of none of them, or under
    two frames.
    """
    views = ROAMING_VIEWS if roaming else USUAL_VIEWS
    cast = Casting(interaction, participant, seed, performance, views, roaming=roaming)
    rig = simulate_rig_cast(cast, frames, camera, cameras)
    if unknown := sorted(set(upside_down) - set(rig.names)):
        raise ValueError(f"there is no camera {unknown[0]}; there are: {', '.join(rig.names)}")
    return RigSimulation(
        tuple(_turned(view) if view.name in upside_down else view for view in rig.views)
    )


def simulate_rig_cast(cast: Casting, frames: int, camera: Camera, cameras: int) -> RigSimulation:
    """Simulate as ``simulate_rig`` does, and raise what it raises."""
    return RigSimulation(simulate_views(cast, frames, camera, cameras, range(cameras)))


def simulate_views(
    cast: Casting, frames: int, camera: Camera, cameras: int, chosen: Iterable[int]
) -> tuple[RigView, ...]:
    """Simulate some of a rig's cameras, by number, for whoever needs no others.

    Raises what ``simulate_rig`` raises.
    """
    _check_size(cameras, frames)
    enacted = enact(cast, frames, camera.frame_rate)
    return _views(cast, enacted, camera, cameras, chosen)


def simulate_enacted(
    cast: Casting, enacted: Enactment, camera: Camera, cameras: int
) -> RigSimulation:
    """Simulate a rig before something that is enacted by whoever is cast.

    Raises ValueError for another number of cameras, or under two frames.
    """
    _check_size(cameras, len(enacted.contact))
    return RigSimulation(_views(cast, enacted, camera, cameras, range(cameras)))


def _check_size(cameras: int, frames: int) -> None:
    if not 1 <= cameras <= len(RIG_CAMERAS):
        raise ValueError(f"a rig has 1 to {len(RIG_CAMERAS)} cameras, not {cameras}")
    if frames < 2:
        raise ValueError(f"a rig takes 2 frames at the least, not {frames}")


def _views(
    cast: Casting, enacted: Enactment, camera: Camera, cameras: int, chosen: Iterable[int]
) -> tuple[RigView, ...]:
    viewpoints = _place_rig(cast, camera, enacted, cameras)
    return tuple(_view(cast, camera, enacted, viewpoints[number]) for number in chosen)


def _view(cast: Casting, camera: Camera, enacted: Enactment, viewpoint: Viewpoint) -> RigView:
    clock = _clock(cast, camera.frame_rate, viewpoint.number)
    seen = film(cast, _as_taken(enacted, clock, camera.frame_rate), camera, viewpoint)
    return RigView(
        RIG_CAMERAS[viewpoint.number].name,
        seen,
        viewpoint.camera_from_world.inverse(),
        clock,
        _dropped(cast, seen),
    )


def _place_rig(
    cast: Casting, camera: Camera, enacted: Enactment, cameras: int
) -> tuple[Viewpoint, ...]:
    """Where the cameras stand: the first as it would alone, the others about the person.

    They are before all walls, and where no furniture of the first performance hides the person,
    unless it does from everywhere that is tried.
    """
    facing, camera_from_world = place_camera(
        cast.person(), camera.intrinsics, cast.random("camera"), enacted.furniture, cast.views
    )
    room = replace(cast.room(facing), enclosed=cameras > 1)
    first = Viewpoint(camera_from_world, room)
    if cameras > 1 and cast.performance:
        enacted = enact(replace(cast, performance=0), 2, camera.frame_rate)
    others = (_place_beside(cast, camera, enacted, room, number) for number in range(1, cameras))
    return (first, *others)


def _place_beside(
    cast: Casting, camera: Camera, enacted: Enactment, room: RoomPlan, number: int
) -> Viewpoint:
    person, named = cast.person(), RIG_CAMERAS[number]
    random, wall = cast.random(f"camera/{number}"), wall_place(cast.random("room"), room)
    placing = replace(CAMERA_PLACINGS[cast.views], height=named.height)
    tried = [
        place_beside(
            person, camera.intrinsics, random, placing, (room.turn + least, room.turn + largest)
        )
        for least, largest in (named.around, named.around_if_hidden)
        for _ in range(USUAL_RIG.tries)
    ]
    before = [place for place in tried if in_the_open(room, wall, _position(place))]
    clear = [place for place in before if not hidden(person, _position(place), enacted.furniture)]
    return Viewpoint((clear or before)[0], room, number)


def _position(camera_from_world: Transform) -> Array:
    return camera_from_world.inverse().translation


def _turned(view: RigView) -> RigView:
    """A view by the camera upside down, which follows nobody; the light, which is each camera's
    own, turns with it and comes from below."""
    seen, turn = view.simulation, Transform(np.zeros(3), np.diag([-1.0, -1.0, 1.0]))
    body = seen.body_in_camera.seen_from(turn)
    reading = SkeletonReading(
        turn.apply(seen.reading.joints),
        np.full_like(seen.reading.states, MISSING),
        np.zeros_like(seen.reading.confidences),
    )
    turned = replace(
        seen,
        camera_from_world=turn @ seen.camera_from_world,
        camera_from_object=turn @ seen.camera_from_object,
        body_in_camera=body,
        reading=reading,
    )
    return replace(view, simulation=turned, rig_from_camera=view.rig_from_camera @ turn.inverse())


def _clock(
    cast: Casting, frame_rate: float, number: int, rig: RigParameters = USUAL_RIG
) -> CameraClock:
    """The clock of a camera: the rig's own for the first, else one that nobody has set."""
    if number == 0:
        return CameraClock()
    random = cast.random(f"clock/{number}")
    offset = random.uniform(-rig.clock_offset_s, rig.clock_offset_s)
    drift = 1e-6 * random.uniform(-rig.clock_drift_ppm, rig.clock_drift_ppm)
    first = random.uniform(0.0, 1.0) / frame_rate
    return CameraClock(offset, drift, (first - offset) / (1.0 + drift))


def _as_taken(enacted: Enactment, clock: CameraClock, frame_rate: float) -> Enactment:
    """What is enacted at the moments in which a camera takes frames."""
    if clock == CameraClock():
        return enacted
    frames = len(enacted.contact)
    times = clock.rig_times(clock.said(frames, frame_rate))
    return enactment_at(enacted, frame_rate, times[times <= (frames - 1) / frame_rate])


def _dropped(cast: Casting, seen: Simulation, rig: RigParameters = USUAL_RIG) -> Flags:
    """Which frames (T,) a camera loses; how large a share is a matter of the camera."""
    share = cast.random(f"drops/{seen.view}").uniform(*rig.dropped_share)
    random = random_stream(
        cast.seed, cast.participant, cast.interaction, f"dropped/{seen.view}", cast.performance
    )
    return np.asarray(random.random(seen.frames) < share)
