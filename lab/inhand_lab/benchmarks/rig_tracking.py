"""Tracks an object through a simulated rig's frames: by each camera alone, by all, and with one
camera that fails."""

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.estimate import Estimate
from inhand_tracker.geometry.image import Image
from inhand_tracker.geometry.placement import Placement
from inhand_tracker.methods.object_tracker import ObjectTracker
from inhand_tracker.methods.registry import new_tracker
from inhand_tracker.model.model import Model
from inhand_tracker.prior.calibration import CHI_SQUARE_90
from inhand_tracker.rig.parameters import DEFAULT_RIG, RigParameters
from inhand_tracker.rig.placing import PlaceDeviation
from inhand_tracker.rig.rig_frames import Capture, RigFrames
from inhand_tracker.wire.conversion import joints_of

from inhand_lab.benchmarks.rendered_images import rendered_image
from inhand_lab.geometry.transforms import Transform, quaternions
from inhand_lab.world.messages import person_message
from inhand_lab.world.rigs import RigSimulation

JUMP_S = 1.0
"""Seconds after a camera has failed within which poses may leap by that."""

NOT_OFF = PlaceDeviation(0.0, 0.0)
"""Cameras that are where they are said to be."""
PLACED_SEED = 7
"""Seed of the errors of cameras' places."""

CLOCK_READINGS = 50
"""Number of readings of the processor's time by which it is known what one takes."""


@dataclass(frozen=True)
class Errors:
    """Errors of T frames by one tracker: ``vertex_m`` (T,), the mean distance of the marked
    vertices, and ``changes_m`` (T,), that of the ways by which they are off from where they were
    off by a frame before; NaN where there is no pose. ``region_share`` is that of the poses whose
    90 % region holds the truth, and ``frame_ms`` the median of the processor time that a frame
    took."""

    vertex_m: Array
    changes_m: Array
    region_share: float
    frame_ms: float

    @property
    def mean_m(self) -> float:
        """Mean vertex error of the frames with a pose, in metres."""
        return float(np.nanmean(self.vertex_m)) if np.isfinite(self.vertex_m).any() else np.nan

    @property
    def without_pose(self) -> int:
        """Number of frames without a pose."""
        return int(np.isnan(self.vertex_m).sum())


@dataclass(frozen=True)
class RigErrors:
    """Errors of a rig's ``single`` cameras by name, of all ``fused``, and, where a camera failed at
    some time, of the rig with that one, ``killed``; ``jump_m`` is by how much it leapt then, and
    ``usual_jump_m`` by how much the whole rig did at that time."""

    single: dict[str, Errors]
    fused: Errors
    killed: Errors | None = None
    jump_m: float = 0.0
    usual_jump_m: float = 0.0


@dataclass
class _Follower:
    """A tracker by some of the cameras, and where it has the marked vertices, (T, M, 3) off the
    truth."""

    tracker: ObjectTracker
    cameras: tuple[int, ...]
    frames: RigFrames
    off: Array
    until_s: dict[int, float]
    within: list[bool] = field(default_factory=list)
    took_ms: list[float] = field(default_factory=list)


def track_rig(
    rig: RigSimulation,
    model: Model,
    *,
    tracker_seed: int = 0,
    killed: int | None = None,
    parameters: RigParameters = DEFAULT_RIG,
    on_frame: Callable[[], None] = lambda: None,
    images: Callable[[int, int], Image] | None = None,
    singles: bool = True,
    placed_off: PlaceDeviation = NOT_OFF,
) -> RigErrors:
    """Track through a rig; the camera ``killed``, a number, fails in the middle of it.

    Each camera's clock is known, but not its drift. ``images`` gives a camera's frame, where it is
    not rendered anew. Cameras are ``placed_off`` from where they are, by chance, by about that
    along and about each axis, as the calibration says.
    """
    show = images or (lambda camera, frame: rendered_image(rig.cameras[camera], frame))
    # The others take their last frame before the first one does.
    count, every = rig.cameras[0].frames - 1, tuple(range(len(rig.cameras)))
    middle_s = rig.times_s(0)[count // 2]
    left_handed = rig.cameras[0].person.handedness == "left"
    places = places_of(rig, placed_off)

    def follower(cameras: tuple[int, ...], until_s: dict[int, float]) -> _Follower:
        tracker = new_tracker(
            model, left_handed=left_handed, seed=tracker_seed, several_cameras=len(cameras) > 1
        )
        chosen = {rig.names[camera]: places[rig.names[camera]] for camera in cameras}
        off = np.full((count, len(model.shape.marked_vertices), 3), np.nan)
        frames = RigFrames(chosen, parameters)
        for camera, place in chosen.items():
            frames.place(camera, place, placed_off)
        return _Follower(tracker, cameras, frames, off, until_s)

    alone = [follower((camera,), {}) for camera in every] if singles else []
    fused = follower(every, {})
    failing = [] if killed is None else [follower(every, {killed: middle_s})]
    for frame in range(count):
        captures = dict(_captures(rig, frame, show))
        for one in (*alone, fused, *failing):
            _follow(one, rig, frame, captures, model)
        on_frame()
    result = [_errors(one) for one in (*alone, fused, *failing)]
    single = dict(zip(rig.names, result, strict=False)) if singles else {}
    if killed is None:
        return RigErrors(single, result[-1])
    after = slice(count // 2, count // 2 + round(JUMP_S * rig.cameras[0].frame_rate))
    jumps = [_largest(one.changes_m[after]) for one in result[-2:]]
    return RigErrors(single, result[-2], result[-1], jumps[1], jumps[0])


def nearest_frames(rig: RigSimulation, tick: int) -> Iterator[tuple[int, int, int]]:
    """Give what each camera captured nearest to a frame of the first one, within half a period and
    but for what was lost: the camera's number, its frame's, and its time by the rig's clock, drift
    excepted, in nanoseconds."""
    now_s = rig.times_s(0)[tick]
    period_s = 1.0 / rig.cameras[0].frame_rate
    for number in range(len(rig.cameras)):
        times_s = rig.times_s(number)
        frame = int(np.argmin(np.abs(times_s - now_s)))
        if abs(times_s[frame] - now_s) > period_s / 2.0 or rig.dropped[number][frame]:
            continue
        said_ns = int(rig.stamps_ns(number)[frame])
        yield number, frame, said_ns + round(1e9 * (1.0 + rig.clocks[number].offset_s))


def _captures(
    rig: RigSimulation, tick: int, show: Callable[[int, int], Image]
) -> Iterator[tuple[int, tuple[int, Capture]]]:
    """Give what each camera, by its number, captured, with the number of its frame."""
    for number, frame, time_ns in nearest_frames(rig, tick):
        people = [person_message(rig.cameras[number], frame)]
        yield number, (frame, Capture(rig.names[number], time_ns, people, show(number, frame)))


def _follow(
    one: _Follower,
    rig: RigSimulation,
    tick: int,
    captures: dict[int, tuple[int, Capture]],
    model: Model,
) -> None:
    """Let a tracker take what its cameras captured."""
    there = [
        camera
        for camera in one.cameras
        if camera in captures
        and rig.times_s(camera)[captures[camera][0]] < one.until_s.get(camera, np.inf)
    ]
    if not there:
        return
    began = time.process_time_ns()
    estimate = _step(one, [captures[camera][1] for camera in there], alone=len(one.cameras) == 1)
    one.took_ms.append((time.process_time_ns() - began) / 1e6)
    if estimate.translation is None or estimate.rotation is None:
        return
    first = there[0]
    # Poses are in the frame of the first of its cameras.
    home_from_first = rig.rig_from_camera[one.cameras[0]].inverse() @ rig.rig_from_camera[first]
    true = home_from_first @ rig.cameras[first].camera_from_object[captures[first][0]]
    vertices = model.shape.marked_vertices
    estimated = rotations.rotate(estimate.rotation, vertices) + estimate.translation
    one.off[tick] = estimated - true.apply(vertices)
    one.within.append(_holds(estimate, true))


def _step(one: _Follower, captures: Sequence[Capture], *, alone: bool) -> Estimate:
    """Take what cameras captured about the same time; one that is alone goes without a rig."""
    first = captures[0]
    if alone:
        (person,) = first.people
        return one.tracker.step(joints_of(person), first.time_ns, first.image)
    frame = one.frames.join(captures)
    joints = frame.people[0].joints if frame.people else None
    return one.tracker.step(joints, frame.time_ns, frame.image)


def _holds(estimate: Estimate, true: Transform) -> bool:
    """Whether the 90 % region that an estimate states holds the true pose."""
    assert estimate.translation is not None
    assert estimate.rotation is not None
    assert estimate.covariance is not None
    true_rotation = quaternions(true.rotation[None])[0]
    turn = rotations.multiply(estimate.rotation, rotations.conjugate(true_rotation))
    off = np.concatenate((estimate.translation - true.translation, rotations.to_vector(turn)))
    return bool(off @ np.linalg.solve(estimate.covariance, off) <= CHI_SQUARE_90)


def _errors(one: _Follower) -> Errors:
    changes = np.diff(one.off, axis=0, prepend=one.off[:1])
    vertex, change = (np.linalg.norm(off, axis=2).mean(axis=1) for off in (one.off, changes))
    took_ms = float(np.median(one.took_ms)) - _clock_ms() if one.took_ms else np.nan
    share = float(np.mean(one.within)) if one.within else np.nan
    return Errors(vertex, change, share, took_ms)


def _clock_ms() -> float:
    """Milliseconds of processor time that asking for it takes: on some machines, a lot."""
    asked = [time.process_time_ns() for _ in range(CLOCK_READINGS)]
    return float(np.median(np.diff(asked))) / 1e6


def _largest(values: Array) -> float:
    return float(np.nanmax(values)) if np.isfinite(values).any() else np.nan


def places_of(rig: RigSimulation, off: PlaceDeviation) -> dict[str, Placement]:
    """Say where cameras are, ``rig_from_camera``, each ``off`` by chance along and about each
    axis."""
    random = np.random.default_rng(PLACED_SEED)
    wrong = {}
    for number, name in enumerate(rig.names):
        place = placement_of(rig.rig_from_camera[number])
        shift = random.normal(0.0, off.translation_m, 3)
        turn = rotations.from_vector(random.normal(0.0, off.rotation_rad, 3))
        wrong[name] = Placement(place.translation + shift, rotations.multiply(turn, place.rotation))
    return wrong


def placement_of(rig_from_camera: Transform) -> Placement:
    """Return where a camera is as the tracker takes it."""
    return Placement(rig_from_camera.translation, quaternions(rig_from_camera.rotation[None])[0])
