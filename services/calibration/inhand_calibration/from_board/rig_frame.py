"""The rig's frame: where its origin is, and where its axes go."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inhand_calibration.arrays import Array
from inhand_calibration.errors import CalibrationError
from inhand_calibration.floor import frame_on
from inhand_calibration.from_board.depth_floor import find_depth_floor
from inhand_calibration.from_board.moments import DEFAULT_MOMENTS
from inhand_calibration.from_board.rig import RigSolution
from inhand_calibration.rigid import inverse, moved, rigid

BOARD = "board"
"""Origin that is the board, where it stood still at last."""
BELOW_FLOOR_M = 0.05
"""How far below the floor the board may seem to have been."""


@dataclass(frozen=True)
class RigFrame:
    """A frame ``rig_from_reference`` (4, 4), in words, and whether its z axis is up."""

    rig_from_reference: Array
    words: str
    z_is_up: bool


def choose_frame(
    solution: RigSolution, points: Sequence[Array], origin: str | None, *, board_on_floor: bool
) -> RigFrame:
    """Choose the rig's frame.

    ``origin`` is a camera's name, or ``board``, or None for the floor, which is under the board at
    last with ``board_on_floor``, and else looked for in depth ``points`` (N, 3) of each camera.
    Raises CalibrationError where what was asked for was not seen.
    """
    if origin is not None and origin != BOARD:
        index = solution.names.index(origin)
        rig = inverse(solution.reference_from_camera[index])
        return RigFrame(
            rig, f"axes as {origin}'s (x right, y down, z forward), origin in it", False
        )
    if origin == BOARD or board_on_floor:
        rig = _of_board(solution)
        if board_on_floor:
            _require_lowest(solution, rig)
        lies = "on the floor" if board_on_floor else "where it stood still at last"
        up = "up" if board_on_floor else "out of its face"
        words = f"z {up}, origin in the middle of the board {lies}, x along its upper edge"
        return RigFrame(rig, words, board_on_floor)
    name = solution.names[0]
    floor = find_depth_floor(points, solution.reference_from_camera) if len(points) else None
    if floor is None:
        words = f"axes as {name}'s (x right, y down, z forward), origin in it: no floor was seen"
        return RigFrame(np.eye(4), words, False)
    words = f"z up, x the way {name} looks, origin on the floor below {name}"
    return RigFrame(frame_on(floor, np.zeros(3)), words, True)


def _of_board(solution: RigSolution) -> Array:
    """The frame of the board at the last moment in which it stood still, seen from above it."""
    still = [
        index
        for index, moment in enumerate(solution.moments)
        if moment.speed_px_s <= DEFAULT_MOMENTS.still_px_s
    ]
    if not still:
        raise CalibrationError(
            "the board never stood still where two cameras saw it: lay it down, and wait a moment"
        )
    board = solution.boards[still[-1]]
    turn = board[:3, :3] @ np.diag([1.0, -1.0, -1.0])  # out of the paper, not into it
    middle = moved(board, solution.cameras[0].board.outline).mean(axis=0)
    rig = inverse(rigid(turn, middle))
    eyes = moved(rig, solution.reference_from_camera[:, :3, 3])
    if (eyes[:, 2] < 0.0).any():
        raise CalibrationError(
            "a camera would be behind the board's face when it stood still at last, so that it "
            "cannot lie on the floor: lay it down face up at last"
        )
    return rig


def _require_lowest(solution: RigSolution, rig_from_reference: Array) -> None:
    """Raise CalibrationError where the board was below what is said to be the floor."""
    outline = solution.cameras[0].board.outline
    heights = moved(rig_from_reference @ solution.boards, outline)[..., 2]
    if float(heights.min()) < -BELOW_FLOOR_M:
        raise CalibrationError(
            f"the board was {-float(heights.min()):.2f} m lower before than where two cameras saw "
            "it stand still at last, so that it did not lie on the floor there: lay it face up "
            "where two cameras see it, at last"
        )
