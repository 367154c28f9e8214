"""A rig of three cameras that see a board carried about; corners are projected, not drawn."""

from dataclasses import dataclass, replace

import numpy as np
from inhand_calibration.from_board.board import CharucoBoard, printed_board
from inhand_calibration.from_board.lens import Lens
from inhand_calibration.from_board.rig import RigSolution
from inhand_calibration.from_board.sights import CameraSights, Sight
from inhand_calibration.rigid import angle, inverse
from inhand_lab.sensing.board_walk import (
    BoardWalk,
    RigCamera,
    WalkParameters,
    board_walk,
    looking_at,
    projected_sights,
)
from numpy.typing import NDArray

WIDE = Lens(1000.0, 1000.0, 639.5, 359.5, 1280, 720, (0.08, -0.15, 0.001, -0.0005, 0.02))
PLAIN = Lens(525.0, 525.0, 319.5, 239.5, 640, 480)
WALK = WalkParameters(holds=10, hold_s=0.5, move_s=0.5)


def three_cameras(looked_at_m: float = 1.0) -> tuple[RigCamera, ...]:
    """One upside down whose clock is two seconds late, one of half the rate: all hard at once.

    They look at a place of that height.
    """
    middle = np.array([0.0, 0.0, looked_at_m])
    return (
        RigCamera("front", WIDE, looking_at(np.array([2.2, 0.0, 1.6]), middle), 30.0),
        RigCamera(
            "left", WIDE, looking_at(np.array([1.2, -1.9, 1.3]), middle, 180.0), 30.0, -2.0, 0.011
        ),
        RigCamera("right", PLAIN, looking_at(np.array([1.1, 1.7, 1.9]), middle), 15.0, 0.03, 0.02),
    )


@dataclass(frozen=True)
class SeenBoard:
    """What cameras saw of a board, and the truth."""

    cameras: tuple[RigCamera, ...]
    walk: BoardWalk
    sights: tuple[CameraSights, ...]

    def with_lens(self, camera: int, lens: Lens) -> "SeenBoard":
        """Let a camera say that it has another lens."""
        return self.with_sights(camera, self.sights[camera].sights, lens)

    def with_sights(
        self, camera: int, sights: tuple[Sight, ...], lens: Lens | None = None
    ) -> "SeenBoard":
        """Let a camera have seen something else."""
        one = self.sights[camera]
        changed = list(self.sights)
        changed[camera] = replace(one, sights=sights, lens=lens or one.lens)
        return replace(self, sights=tuple(changed))

    def errors(self, solution: RigSolution) -> dict[str, tuple[float, float, float]]:
        """How far cameras are off the truth, metres, radians and, of clocks, seconds."""
        by_name = {camera.name: camera for camera in self.cameras}
        reference = by_name[solution.names[0]]
        errors = {}
        for index, name in enumerate(solution.names[1:], 1):
            camera, seen = by_name[name], solution.reference_from_camera[index]
            true = inverse(reference.room_from_camera) @ camera.room_from_camera
            clock = solution.offsets_s[index] - (camera.offset_s - reference.offset_s)
            errors[name] = (
                float(np.linalg.norm(seen[:3, 3] - true[:3, 3])),
                angle(seen[:3, :3] @ true[:3, :3].T),
                abs(float(clock)),
            )
        return errors


def seen_board(
    seed: int,
    walk: WalkParameters = WALK,
    deviation_px: float = 0.1,
    cameras: tuple[RigCamera, ...] | None = None,
    board: CharucoBoard | None = None,
) -> SeenBoard:
    """Let three cameras see a board."""
    cameras, board = cameras or three_cameras(), board or printed_board("a3")
    random = np.random.default_rng(seed)
    way = board_walk(board, cameras, random, walk)
    sights = tuple(
        CameraSights(
            camera.name, camera.lens, board, projected_sights(way, camera, random, deviation_px)
        )
        for camera in cameras
    )
    return SeenBoard(cameras, way, sights)


def disturbed(
    sights: tuple[Sight, ...], share: float, by_px: float, random: np.random.Generator
) -> tuple[Sight, ...]:
    """Let a share of all corners be false, somewhere else in the picture."""

    def one(sight: Sight) -> Sight:
        false = random.random(len(sight.numbers)) < share
        pixels: NDArray[np.float64] = sight.pixels.copy()
        pixels[false] += by_px * random.standard_normal((int(false.sum()), 2))
        return replace(sight, pixels=pixels)

    return tuple(one(sight) for sight in sights)
