"""From how far a board is found: views of boards that are held still, leaning, drawn and looked
at."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from inhand_calibration.from_board.board import CharucoBoard, printed_board
from inhand_calibration.from_board.collecting import BoardSights
from inhand_calibration.from_board.lens import Lens
from inhand_calibration.rigid import inverse
from inhand_tracker.geometry.arrays import Array

from inhand_lab.benchmarks.board_calibration import LENSES, frame_of, info_of
from inhand_lab.sensing.board_view import DEFAULT_LIGHT, BoardLight, BoardPrint, view_of_boards
from inhand_lab.sensing.board_walk import WalkParameters, facing, looking_at


@dataclass(frozen=True)
class BoardRangeParameters:
    """Which boards are shown to which lenses from where."""

    seed: int = 8201
    papers: tuple[str, ...] = ("a4", "letter", "a3")
    lenses: tuple[str, ...] = ("wide", "plain")
    lights: tuple[str, ...] = ("good", "poor")
    distances_m: tuple[float, ...] = tuple(round(4.4 - 0.2 * step, 1) for step in range(21))
    """Distances from which boards are looked for, from the farthest on."""
    views: int = 20
    """Number of views of each."""
    inner: float = 0.5
    """Share of the picture's width and height in which the board's middle is."""
    found: float = 0.9
    """Share of the views in which a board must be found to be within range."""
    least_px: float = 60.0
    """Width of the printed squares, in pixels, below which a board is not looked for."""
    in_a_row: int = 2
    """Number of distances, one after the other, at which it must be."""
    tilt_deg: float = WalkParameters().tilt_deg
    """Angle, at most, by which it leans."""


DEFAULT_BOARD_RANGE = BoardRangeParameters()


LIGHTS = {
    "good": DEFAULT_LIGHT,
    "poor": BoardLight(white=90.0, black=20.0, wall=60.0, blur_px=1.0, noise=6.0),
}
"""A lit room and a sharp picture; an evening's lamp and a lens that is a little out of focus."""


@dataclass(frozen=True)
class BoardRange:
    """In which share of the views a board of a ``paper`` is found by a lens in a light, by
    distances in metres; ``range_m`` is the largest from which it nearly always is, None where it is
    from none, and ``width_px`` how wide its printed squares are then, pixels."""

    paper: str
    lens: str
    light: str
    shares: dict[float, float]
    range_m: float | None
    width_px: float | None


def measure_board_ranges(
    advance: Callable[[], None], parameters: BoardRangeParameters = DEFAULT_BOARD_RANGE
) -> list[BoardRange]:
    """Measure each board, lens and light; ``advance`` is called after each."""
    ranges = []
    for case in cases(parameters):
        ranges.append(_range(*case, parameters))
        advance()
    return ranges


def cases(parameters: BoardRangeParameters = DEFAULT_BOARD_RANGE) -> list[tuple[str, str, str]]:
    """Return paper, lens and light of all that is measured."""
    return [
        (paper, lens, light)
        for lens in parameters.lenses
        for paper in parameters.papers
        for light in parameters.lights
    ]


def _range(paper: str, name: str, light: str, parameters: BoardRangeParameters) -> BoardRange:
    board, lens = printed_board(paper), LENSES[name]
    shares: dict[float, float] = {}
    reached: list[float] = []
    for distance_m in parameters.distances_m:
        if lens.fx * board.size_m[0] / distance_m < parameters.least_px:
            continue
        views = [parameters.seed, parameters.papers.index(paper), lens.width]
        random = np.random.default_rng([*views, round(1e3 * distance_m)])
        share = _share_found(board, lens, LIGHTS[light], distance_m, random, parameters)
        shares[distance_m] = share
        reached = [*reached, distance_m] if share >= parameters.found else []
        if len(reached) == parameters.in_a_row:
            break
    range_m = max(reached, default=None)
    width_px = None if range_m is None else lens.fx * board.size_m[0] / range_m
    return BoardRange(paper, name, light, shares, range_m, width_px)


def _share_found(
    board: CharucoBoard,
    lens: Lens,
    light: BoardLight,
    distance_m: float,
    random: np.random.Generator,
    parameters: BoardRangeParameters,
) -> float:
    found = 0
    for _ in range(parameters.views):
        pose = _held(board, lens, distance_m, random, parameters)
        grey = view_of_boards([(BoardPrint(board), pose[None])], lens, random, light)
        sights = BoardSights([printed_board(paper) for paper in parameters.papers])
        sights.introduce("camera", info_of(lens))
        found += sights.add("camera", frame_of(grey, 1)) is not None
    return found / parameters.views


def _held(
    board: CharucoBoard,
    lens: Lens,
    distance_m: float,
    random: np.random.Generator,
    parameters: BoardRangeParameters,
) -> Array:
    """A board's pose (4, 4) in the camera's frame, its face about towards the camera."""
    camera_from_room = inverse(looking_at(np.zeros(3), np.array([1.0, 0.0, 0.0])))
    size = np.array([lens.width, lens.height])
    pixel = size * (0.5 + parameters.inner * random.uniform(-0.5, 0.5, 2))
    (ray,) = lens.undistorted(pixel[None])
    middle = distance_m * np.append(ray, 1.0)
    in_room = inverse(camera_from_room)[:3, :3] @ middle
    return np.asarray(
        camera_from_room @ facing(board, in_room, -in_room, random, parameters.tilt_deg)
    )
