"""How a camera sees a printed board: drawn through its lens, blurred, lit, with its noise."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property

import cv2
import numpy as np
from inhand_calibration.from_board.board import CharucoBoard
from inhand_calibration.from_board.lens import Lens
from inhand_tracker.geometry.arrays import Array, Bytes

TEXELS_IN_CELL = 12
"""Texels along a marker's cell where the board is drawn largest."""
CELLS_IN_MARKER = 6
"""Cells along a marker of 4 × 4 bits with its border."""
MARGIN_M = 0.015
"""White paper around a board, metres."""
WAYPOINTS_PX = 2.0
"""Distance between one averaged picture of a movement and the next, pixels."""
MOST_WAYPOINTS = 12


@dataclass(frozen=True)
class BoardLight:
    """How a board is lit and a picture is taken."""

    white: float = 205.0
    """Level of the paper, of 255."""
    black: float = 28.0
    """Level of the ink."""
    wall: float = 120.0
    """Mean level of what is behind the board."""
    gradient: float = 0.25
    """By what share the light differs from one side of the picture to the other."""
    blur_px: float = 0.6
    """Deviation of the lens's blur, pixels."""
    noise: float = 3.0
    """Deviation of a pixel's noise, levels."""
    samples: int = 3
    """Samples along a pixel."""


DEFAULT_LIGHT = BoardLight()


@dataclass(frozen=True)
class BoardPrint:
    """A board on white paper as levels of white from 0 to 1."""

    board: CharucoBoard

    @cached_property
    def texels_in_m(self) -> float:
        """Texels to a metre."""
        return TEXELS_IN_CELL * CELLS_IN_MARKER / self.board.marker_m

    @cached_property
    def texture(self) -> Bytes:
        """Levels (H, W) from 0, black, to 255, with a margin around the board."""
        scale, margin = self.texels_in_m, round(MARGIN_M * self.texels_in_m)
        width, height = (round(side * scale) + 2 * margin for side in self.board.size_m)
        texture = np.full((height, width), 255, np.uint8)
        for x, y, across, down in self.board.black_rectangles() * scale + [margin, margin, 0, 0]:
            texture[round(y) : round(y + down), round(x) : round(x + across)] = 0
        return texture

    def reduced(self, texels_in_m: float) -> tuple[Bytes, float, float]:
        """Return the texture at about a resolution, that one, and its margin in texels."""
        share = min(texels_in_m / self.texels_in_m, 1.0)
        full = self.texture
        size = (max(round(full.shape[1] * share), 8), max(round(full.shape[0] * share), 8))
        reduced = cv2.resize(full, size, interpolation=cv2.INTER_AREA)
        scale = self.texels_in_m * size[0] / full.shape[1]
        margin = round(MARGIN_M * self.texels_in_m) * size[0] / full.shape[1]
        return np.asarray(reduced, np.uint8), scale, margin

    @property
    def sheet(self) -> Array:
        """The paper's corners (4, 3) in the board's frame, metres."""
        width, height = self.board.size_m
        low, right, bottom = -MARGIN_M, width + MARGIN_M, height + MARGIN_M
        return np.array([(low, low, 0), (right, low, 0), (right, bottom, 0), (low, bottom, 0)])


def view_of_boards(
    prints: list[tuple[BoardPrint, Array]],
    lens: Lens,
    random: np.random.Generator,
    light: BoardLight = DEFAULT_LIGHT,
) -> Bytes:
    """Take a picture (H, W) of boards, each with the poses (P, 4, 4) that it passes through while
    the shutter is open, ``camera_from_board``; a single one stands still."""
    rows = np.linspace(-0.5, 0.5, lens.height)[:, None]
    columns = np.linspace(-0.5, 0.5, lens.width)
    shade = 1.0 + light.gradient * (0.7 * columns + 0.3 * rows)
    coarse = random.uniform(0.5, 1.5, (9, 16)).astype(np.float32)
    wall = cv2.resize(coarse, (lens.width, lens.height), interpolation=cv2.INTER_CUBIC)
    picture: Array = (light.wall * wall).astype(float)
    for one, poses in prints:
        _draw(picture, one, poses, lens, light)
    if light.blur_px > 0.0:
        picture = cv2.GaussianBlur(picture, (0, 0), light.blur_px).astype(float)
    noise = light.noise * random.standard_normal(picture.shape, np.float32)
    return np.clip(np.rint(picture * shade + noise), 0, 255).astype(np.uint8)


def _draw(picture: Array, one: BoardPrint, poses: Array, lens: Lens, light: BoardLight) -> None:
    """Draw a board in motion over a picture (H, W) of levels."""
    poses = _waypoints(one, poses, lens)
    outlines = [pose[:3, :3] @ one.sheet.T + pose[:3, 3:] for pose in poses]
    if any((outline[2] < 0.05).any() for outline in outlines):
        return
    pixels = np.concatenate([lens.project(outline.T) for outline in outlines])
    low = np.maximum(np.floor(pixels.min(axis=0)).astype(int) - 2, 0)
    high = np.minimum(np.ceil(pixels.max(axis=0)).astype(int) + 3, [lens.width, lens.height])
    if (low >= high).any():
        return
    rays = _rays(lens, low, high, light.samples)
    covered = np.zeros((high[1] - low[1], high[0] - low[0]), np.float32)
    levels = np.zeros_like(covered)
    for pose in poses:
        white, inside = _seen(one, pose, rays, lens.fx, light)
        size = (covered.shape[1], covered.shape[0])
        covered += cv2.resize(inside, size, interpolation=cv2.INTER_AREA) / len(poses)
        levels += cv2.resize(white, size, interpolation=cv2.INTER_AREA) / len(poses)
    window = picture[low[1] : high[1], low[0] : high[0]]
    window *= 1.0 - covered
    window += light.black * covered + (light.white - light.black) * levels


def _waypoints(one: BoardPrint, poses: Array, lens: Lens) -> Array:
    """Poses (P, 4, 4) so close that a blur has no steps; one where nothing moves."""
    if len(poses) == 1:
        return poses
    ends = [lens.project(one.sheet @ pose[:3, :3].T + pose[:3, 3]) for pose in poses[[0, -1]]]
    way = float(np.linalg.norm(ends[1] - ends[0], axis=1).max())
    count = int(np.clip(np.ceil(way / WAYPOINTS_PX), 1, MOST_WAYPOINTS))
    chosen = np.rint((np.arange(count) + 0.5) / count * (len(poses) - 1)).astype(int)
    return poses[chosen]


def _rays(lens: Lens, low: Array, high: Array, samples: int) -> Array:
    """Directions (rows, columns, 2), at a depth of 1, of samples of pixels from low to high."""
    # Straight between the middles of pixels, which undistortion is as good as.
    margin = 1
    window = _rays_of_pixels(lens)[low[1] : high[1] + 2 * margin, low[0] : high[0] + 2 * margin]
    size = (window.shape[1] * samples, window.shape[0] * samples)
    cut = margin * samples
    enlarged = cv2.resize(window, size, interpolation=cv2.INTER_LINEAR)
    return enlarged[cut:-cut, cut:-cut].astype(float)


@cache
def _rays_of_pixels(lens: Lens) -> Array:
    """Directions (H + 2, W + 2, 2) of a lens's pixels and of one more on each side."""
    u, v = np.meshgrid(np.arange(-1.0, lens.width + 1), np.arange(-1.0, lens.height + 1))
    return lens.undistorted(np.stack([u.ravel(), v.ravel()], axis=1)).reshape(*u.shape, 2)


def _seen(
    one: BoardPrint, pose: Array, rays: Array, focal: float, light: BoardLight
) -> tuple[Array, Array]:
    """White (rows, columns) from 0 to 1 times whether the paper is there, and whether it is."""
    onto = np.linalg.inv(np.column_stack([pose[:3, 0], pose[:3, 1], pose[:3, 3]]))
    x, y, w = (
        onto[row, 0] * rays[..., 0] + onto[row, 1] * rays[..., 1] + onto[row, 2] for row in range(3)
    )
    resolution = 1.5 * light.samples * focal / max(float(pose[2, 3]), 0.1)
    texture, scale, margin = one.reduced(resolution)
    u = (x / w * scale + margin - 0.5).astype(np.float32)
    v = (y / w * scale + margin - 0.5).astype(np.float32)
    white = cv2.remap(texture, u, v, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    rows, columns = texture.shape
    inside = (u > -0.5) & (u < columns - 0.5) & (v > -0.5) & (v < rows - 0.5)
    inside &= pose[2, 2] > -2.0
    return (white / np.float32(255.0) * inside).astype(np.float32), inside.astype(np.float32)
