"""How well a rig is calibrated by a board: three cameras, rendered views, truth known."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime

import numpy as np
from inhand_calibration.from_board.board import printed_board
from inhand_calibration.from_board.calibration import BoardCalibration, calibrate_from_board
from inhand_calibration.from_board.collecting import BoardSights
from inhand_calibration.from_board.lens import Lens
from inhand_calibration.rigid import angle, inverse
from inhand_runtime.pixels import encode_colour
from inhand_schemas.messages import CameraInfo, RgbdFrame
from inhand_tracker.geometry.arrays import Array, Bytes
from scipy.spatial.transform import Rotation
from scipy.stats import chi2

from inhand_lab.sensing.board_view import BoardPrint, view_of_boards
from inhand_lab.sensing.board_walk import (
    START_NS,
    BoardWalk,
    RigCamera,
    WalkParameters,
    board_walk,
    is_seen,
    looking_at,
)

EXPOSURE_S = 0.010
"""Time for which shutters are open."""
EXPOSED = 7
"""Poses of the board in the course of it."""
SEEN_FROM_M = 4.0
"""Distance within which boards are drawn."""


@dataclass(frozen=True)
class BoardBenchmark:
    """A rig, and somebody who shows it a board."""

    seeds: tuple[int, ...] = (8101, 8102, 8103, 8104)
    """Seeds of rigs and of boards' ways, none of which anything was tuned on."""
    paper: str = "a3"
    """Paper of the board."""
    rate_hz: float = 15.0
    """Pictures a second."""
    walk: WalkParameters = field(
        default_factory=lambda: WalkParameters(holds=18, hold_s=0.3, move_s=0.2)
    )
    """How the board is shown: in a hurry, since each picture is drawn."""


DEFAULT_BOARD_BENCHMARK = BoardBenchmark()

LENSES = {
    "wide": Lens(1000.0, 1000.0, 639.5, 359.5, 1280, 720, (0.08, -0.15, 0.001, -0.0005, 0.02)),
    "plain": Lens(525.0, 525.0, 319.5, 239.5, 640, 480),
}
"""Lenses such as an OAK-D's colour camera and Kinect's have."""


@dataclass(frozen=True)
class CameraTrial:
    """How far one camera of one seed is off, against the rig's reference."""

    seed: int
    camera: str
    place_mm: float
    turn_deg: float
    clock_ms: float
    deviation_mm: float
    inside: bool
    """Whether the truth lies in the region of 90 % that was said."""


def measure_board_calibration(
    advance: Callable[[], None], benchmark: BoardBenchmark = DEFAULT_BOARD_BENCHMARK
) -> list[CameraTrial]:
    """Calibrate a rig of each seed, and compare."""
    trials = []
    for seed in benchmark.seeds:
        random = np.random.default_rng(seed)
        cameras = random_rig(random, benchmark.rate_hz)
        board = printed_board(benchmark.paper)
        walk = board_walk(board, cameras, random, benchmark.walk)
        sights = BoardSights([board])
        for camera in cameras:
            look(sights, walk, camera, random)
        found = calibrate_from_board(sights.sights(), datetime.now(UTC))
        trials += compared(seed, found, cameras)
        advance()
    return trials


def random_rig(random: np.random.Generator, rate_hz: float) -> tuple[RigCamera, ...]:
    """Three cameras about a room: two sharp ones and a coarse, nearer one; one hangs upside down,
    and their clocks differ."""
    angles = np.radians(np.array([0.0, -50.0, 45.0]) + random.uniform(-8.0, 8.0, 3))
    distances = np.array([2.2, 2.3, 1.5]) + random.uniform(-0.15, 0.15, 3)
    heights = random.uniform(1.0, 1.9, 3)
    target = np.array([0.0, 0.0, 1.1])
    cameras = []
    for index, name in enumerate(("front", "left", "right")):
        place = np.array(
            [
                distances[index] * np.cos(angles[index]),
                distances[index] * np.sin(angles[index]),
                heights[index],
            ]
        )
        lens = LENSES["plain" if name == "right" else "wide"]
        pose = looking_at(place, target, 180.0 if name == "left" else 0.0)
        offset = 0.0 if name == "front" else float(random.uniform(-0.2, 0.2))
        phase = float(random.uniform(0.0, 1.0 / rate_hz))
        cameras.append(RigCamera(name, lens, pose, rate_hz, offset, phase))
    return tuple(cameras)


def look(
    sights: BoardSights, walk: BoardWalk, camera: RigCamera, random: np.random.Generator
) -> None:
    """Let a camera look at a board's way, as a rig's messages have it."""
    lens = camera.lens
    sights.introduce(camera.name, info_of(lens))
    for time in camera.true_times(walk.seconds):
        if not is_seen(walk.board, _in_camera(camera, walk, np.array([time]))[0], SEEN_FROM_M):
            continue
        grey = view_at(walk, camera, float(time), random)
        sights.add(camera.name, frame_of(grey, round((time - camera.offset_s) * 1e9) + START_NS))


def view_at(walk: BoardWalk, camera: RigCamera, time: float, random: np.random.Generator) -> Bytes:
    """Take a picture (H, W) at a time of a board's way."""
    times = time + EXPOSURE_S * (np.arange(EXPOSED) / (EXPOSED - 1) - 0.5)
    poses = _in_camera(camera, walk, times)
    return view_of_boards([(BoardPrint(walk.board), poses)], camera.lens, random)


def info_of(lens: Lens) -> CameraInfo:
    """How a camera of a lens says that it sees."""
    return CameraInfo(
        sequence=0,
        time_ns=START_NS,
        width=lens.width,
        height=lens.height,
        fx=lens.fx,
        fy=lens.fy,
        cx=lens.cx,
        cy=lens.cy,
        distortion=lens.distortion,
    )


def frame_of(grey: Bytes, time_ns: int, sequence: int = 0) -> RgbdFrame:
    """A picture (H, W) as a camera's message."""
    colour = encode_colour(np.repeat(grey[..., None], 3, axis=2))
    return RgbdFrame(sequence=sequence, time_ns=time_ns, colour=colour)


def compared(seed: int, found: BoardCalibration, cameras: Sequence[RigCamera]) -> list[CameraTrial]:
    """Compare all cameras but the reference with the truth, in the reference's frame."""
    solution = found.solution
    by_name = {camera.name: camera for camera in cameras}
    reference = by_name[solution.names[0]]
    trials = []
    for index, name in enumerate(solution.names[1:], 1):
        camera = by_name[name]
        true = inverse(reference.room_from_camera) @ camera.room_from_camera
        seen = solution.reference_from_camera[index]
        turn = seen[:3, :3] @ true[:3, :3].T
        error = np.concatenate([seen[:3, 3] - true[:3, 3], Rotation.from_matrix(turn).as_rotvec()])
        covariance = solution.covariances[index]
        clock = solution.offsets_s[index] - (camera.offset_s - reference.offset_s)
        trials.append(
            CameraTrial(
                seed,
                name,
                1e3 * float(np.linalg.norm(error[:3])),
                float(np.degrees(angle(turn))),
                1e3 * float(clock),
                1e3 * float(np.sqrt(np.trace(covariance[:3, :3]))),
                bool(error @ np.linalg.solve(covariance, error) < chi2(6).ppf(0.9)),
            )
        )
    return trials


def _in_camera(camera: RigCamera, walk: BoardWalk, times: Array) -> Array:
    """Poses (T, 4, 4) of the board in a camera's frame."""
    return inverse(camera.room_from_camera) @ walk.at(times)
