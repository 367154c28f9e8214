"""Somebody carries a calibration board through a room, holding it still here and there.

The room's frame has z up and its origin on the floor.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from inhand_calibration.from_board.board import CharucoBoard
from inhand_calibration.from_board.lens import Lens
from inhand_calibration.from_board.sights import Sight
from inhand_calibration.rigid import inverse, moved, rigid
from inhand_tracker.geometry.arrays import Array
from scipy.spatial.transform import Rotation, Slerp

STEEPEST_DEG = 68.0
"""Angle between a board's normal and the way to the camera from which on it is not found."""


@dataclass(frozen=True)
class RigCamera:
    """A camera of a rig: its name, lens and place, ``room_from_camera`` (4, 4), and its clock.

    ``offset_s`` is what to add to its times to have true ones.
    """

    name: str
    lens: Lens
    room_from_camera: Array
    rate_hz: float = 30.0
    offset_s: float = 0.0
    phase_s: float = 0.0
    """When its first picture is taken."""

    def true_times(self, seconds: float) -> Array:
        """When it takes its pictures, seconds of true time."""
        return np.arange(self.phase_s, seconds, 1.0 / self.rate_hz)


@dataclass(frozen=True)
class WalkParameters:
    """How somebody walks about with a board."""

    holds: int = 24
    """Number of places where the board is held still."""
    hold_s: float = 0.9
    """Time for which it is."""
    move_s: float = 0.7
    """Time from one place to the next."""
    centre: tuple[float, float, float] = (0.0, 0.0, 1.1)
    """Middle of the room in which it is held, metres."""
    reach: tuple[float, float, float] = (0.35, 0.5, 0.3)
    """How far from there, along each axis, metres."""
    tilt_deg: float = 35.0
    """Angle, at most, by which it leans away from who looks at it."""
    shake_m: float = 0.001
    """How far a hand shakes, metres."""
    on_floor: bool = False
    """Whether it lies on the floor at last, face up."""


@dataclass(frozen=True)
class BoardWalk:
    """The way of a board's frame through the room: where it is held (H, 4, 4) and when (H,)."""

    parameters: WalkParameters
    board: CharucoBoard
    places: Array

    @property
    def seconds(self) -> float:
        """How long it takes."""
        return len(self.places) * (self.parameters.hold_s + self.parameters.move_s)

    @cached_property
    def _turns(self) -> Slerp:
        return Slerp(self._keys, Rotation.from_matrix(np.repeat(self.places[:, :3, :3], 2, axis=0)))

    @cached_property
    def _keys(self) -> Array:
        starts = np.arange(len(self.places)) * (self.parameters.hold_s + self.parameters.move_s)
        return np.stack([starts, starts + self.parameters.hold_s], axis=1).ravel()

    def at(self, times: Array) -> Array:
        """Return ``room_from_board`` (T, 4, 4) at times (T,), seconds."""
        keys = self._keys
        times = np.clip(times, keys[0], keys[-1])
        index = np.clip(np.searchsorted(keys, times, side="right") - 1, 0, len(keys) - 2)
        share = (times - keys[index]) / (keys[index + 1] - keys[index])
        eased = share * share * (3.0 - 2.0 * share)
        middles = self.places[:, :3, 3] + self.places[:, :3, :3] @ self._centre
        ends = np.repeat(middles, 2, axis=0)
        turns = self._turns(keys[index] + eased * (keys[index + 1] - keys[index])).as_matrix()
        middle = ends[index] + eased[:, None] * (ends[index + 1] - ends[index])
        phase = 2.0 * np.pi * np.array([1.3, 1.7, 2.1]) * times[:, None]
        middle = middle + self.parameters.shake_m * np.sin(phase)
        return rigid(turns, middle - turns @ self._centre)

    @property
    def _centre(self) -> Array:
        return self.board.outline.mean(axis=0)


def board_walk(
    board: CharucoBoard,
    cameras: tuple[RigCamera, ...],
    random: np.random.Generator,
    parameters: WalkParameters | None = None,
) -> BoardWalk:
    """Let a board be shown between two cameras at a time, here and there."""
    parameters = parameters or WalkParameters()
    places = []
    for index in range(parameters.holds):
        middle = np.array(parameters.centre) + random.uniform(-1, 1, 3) * parameters.reach
        pair = [cameras[(index + one) % len(cameras)] for one in (0, 1)]
        ways = [camera.room_from_camera[:3, 3] - middle for camera in pair]
        share = random.uniform(0.35, 0.65)
        one, two = (way / np.linalg.norm(way) for way in ways)
        towards = share * one + (1.0 - share) * two
        places.append(facing(board, middle, towards, random, parameters.tilt_deg))
    if parameters.on_floor:
        x, y, _ = parameters.centre
        lying = Rotation.from_euler("z", random.uniform(-np.pi, np.pi)).as_matrix()
        turn = lying @ np.diag([1.0, -1.0, -1.0])
        middle = np.array([x, y, 0.0])
        places[-1] = rigid(turn, middle - turn @ board.outline.mean(axis=0))
    return BoardWalk(parameters, board, np.array(places))


def facing(
    board: CharucoBoard, middle: Array, towards: Array, random: np.random.Generator, tilt: float
) -> Array:
    """Return a board's pose (4, 4) with its face about towards a direction (3,), at any roll."""
    away = -towards / np.linalg.norm(towards)
    side = np.cross([0.0, 0.0, 1.0], away)
    side /= np.linalg.norm(side)
    upright = np.column_stack([side, np.cross(away, side), away])
    roll = Rotation.from_euler("z", random.uniform(-np.pi, np.pi))
    lean = Rotation.from_rotvec(
        np.radians(random.uniform(0.3, 1.0) * tilt) * _level_axis(random.uniform(-np.pi, np.pi))
    )
    turn = upright @ lean.as_matrix() @ roll.as_matrix()
    return rigid(turn, middle - turn @ board.outline.mean(axis=0))


def _level_axis(angle: float) -> Array:
    return np.array([np.cos(angle), np.sin(angle), 0.0])


def looking_at(place: Array, target: Array, roll_deg: float = 0.0) -> Array:
    """Return ``room_from_camera`` (4, 4) of a camera at a place that looks at a target (3,)."""
    forward = np.asarray(target, float) - place
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    turn = np.column_stack([right, np.cross(forward, right), forward])
    turn = turn @ Rotation.from_euler("z", roll_deg, degrees=True).as_matrix()
    return rigid(turn, np.asarray(place, float))


def projected_sights(
    walk: BoardWalk,
    camera: RigCamera,
    random: np.random.Generator,
    deviation_px: float = 0.1,
    seen_from_m: float = 4.0,
) -> tuple[Sight, ...]:
    """Sights of a walk without pictures: corners projected, with noise, where all are in view."""
    sights = []
    times = camera.true_times(walk.seconds)
    for time, pose in zip(times, walk.at(times), strict=True):
        camera_from_board = inverse(camera.room_from_camera) @ pose
        if not is_seen(walk.board, camera_from_board, seen_from_m):
            continue
        pixels = camera.lens.project(moved(camera_from_board, walk.board.corners))
        pixels = pixels + deviation_px * random.standard_normal(pixels.shape)
        size = [camera.lens.width - 1, camera.lens.height - 1]
        inside = ((pixels > 0) & (pixels < size)).all(axis=1)
        if inside.sum() >= len(pixels) // 2:
            time_ns = round((time - camera.offset_s) * 1e9) + START_NS
            sights.append(Sight(time_ns, np.flatnonzero(inside), pixels[inside]))
    return tuple(sights)


START_NS = 1_700_000_000_000_000_000
"""When a walk begins, nanoseconds since the epoch."""


def is_seen(board: CharucoBoard, camera_from_board: Array, furthest_m: float) -> bool:
    """Whether a board has its face to a camera, not too slanted, and is near enough."""
    middle = moved(camera_from_board, board.outline).mean(axis=0)
    distance = float(np.linalg.norm(middle))
    facing = float(camera_from_board[:3, 2] @ middle) / distance
    return middle[2] > 0.2 and distance < furthest_m and facing > np.cos(np.radians(STEEPEST_DEG))
