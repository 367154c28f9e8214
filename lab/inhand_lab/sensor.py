"""What a Kinect makes of a perfect frame: noisy colour, and depth as structured light measures it.

Depth is a disparity in steps of one eighth of a pixel with a baseline of 7.5 cm and a focal length
of 580 pixels (Khoshelham & Elberink, Sensors 2012), so that the step grows with the square of the
distance: 18 mm at 2.5 m. Its noise has an axial deviation of 1.2 mm + 1.9 mm/m^2 (z - 0.4 m)^2 and
a lateral one of 0.8 pixels (Nguyen, Izadi & Lovell, 3DIMPVT 2012), both correlated between
neighbours as block matching makes them. Nothing is measured where the projector, to the right of
the camera, casts the shadow of a nearer surface, on some of the pixels at an edge, and outside
0.5 to 8 m.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numba
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from inhand_lab.rasteriser import Canvas, Intrinsics

BASELINE = 0.075
STEPS_PER_PIXEL = 8.0
NEAREST, FURTHEST = 0.5, 8.0
LATERAL_DEVIATION = 0.8
EDGE_JUMP = 0.04
"""A relative change of depth between neighbours that counts as an edge."""
EDGE_LOSS = 0.45
"""Share of the pixels at an edge that return nothing."""

READ_NOISE = 1.6
SHOT_NOISE = 0.16
"""Variance of colour: READ_NOISE^2 + SHOT_NOISE * value, in squared levels of 256."""

FIELD = 1024
"""Width and height of the noise fields, which repeat; a power of two."""


@dataclass(frozen=True)
class NoiseFields:
    """Fields (FIELD, FIELD) of noise drawn once; every frame starts at another place in them.

    axial is of unit deviation and correlated, lateral (..., 2) are whole pixels, loss is uniform
    in [0, 1), colour is of unit deviation.
    """

    axial: NDArray[np.float32]
    lateral: NDArray[np.int8]
    loss: NDArray[np.float32]
    colour: NDArray[np.float32]


@cache
def noise_fields() -> NoiseFields:
    """The fields, always the same."""
    random = np.random.default_rng(0x5E4502)

    def correlated(pixels: float) -> NDArray[np.float64]:
        field = gaussian_filter(random.normal(size=(FIELD, FIELD)), pixels, mode="wrap")
        return np.asarray(field / field.std())

    axial = correlated(1.2)
    lateral = np.stack([correlated(1.0), correlated(1.0)], axis=-1)
    return NoiseFields(
        axial.astype(np.float32),
        np.rint(LATERAL_DEVIATION * lateral).astype(np.int8),
        random.random((FIELD, FIELD)).astype(np.float32),
        random.normal(size=(FIELD, FIELD)).astype(np.float32),
    )


def sense(
    canvas: Canvas, intrinsics: Intrinsics, random: np.random.Generator
) -> tuple[NDArray[np.uint8], NDArray[np.uint16]]:
    """Colour (H, W, 3) RGB and depth (H, W) in millimetres, 0 where nothing was measured."""
    fields = noise_fields()
    start = random.integers(FIELD, size=2)
    deviations = np.sqrt(READ_NOISE**2 + SHOT_NOISE * np.arange(256)).astype(np.float32)
    colour = _sense_colour(canvas.colour, fields.colour, deviations, start[0], start[1])
    depth = _sense_depth(
        canvas.inverse_depth,
        intrinsics.fx,
        fields.axial,
        fields.lateral,
        fields.loss,
        start[0],
        start[1],
    )
    return np.asarray(colour), np.asarray(depth)


@numba.njit(cache=True, nogil=True)
def _sense_colour(colour, field, deviations, row, column):  # type: ignore[no-untyped-def]
    height, width, _ = colour.shape
    noisy = np.empty_like(colour)
    for v in range(height):
        for u in range(width):
            for channel in range(3):
                value = colour[v, u, channel]
                noise = field[(v + row + 331 * channel) & (FIELD - 1), (u + column) & (FIELD - 1)]
                level = value + deviations[value] * noise + np.float32(0.5)
                noisy[v, u, channel] = np.uint8(min(max(level, np.float32(0)), np.float32(255)))
    return noisy


@numba.njit(cache=True, nogil=True)
def _sense_depth(inverse_depth, focal, axial, lateral, loss, row, column):  # type: ignore[no-untyped-def]
    height, width = inverse_depth.shape
    depth = np.zeros((height, width), np.uint16)
    steps = np.float32(580.0 * BASELINE * STEPS_PER_PIXEL)
    parallax = np.float32(focal * BASELINE)
    for v in range(height):
        noise_v = (v + row) & (FIELD - 1)
        lit_from = np.float32(1e9)
        for u in range(width - 1, -1, -1):
            own = inverse_depth[v, u]
            from_projector = u - parallax * own
            shadowed = from_projector > lit_from + np.float32(1.0)
            lit_from = min(lit_from, from_projector)
            noise_u = (u + column) & (FIELD - 1)
            near_v = min(max(v + lateral[noise_v, noise_u, 0], 0), height - 1)
            near_u = min(max(u + lateral[noise_v, noise_u, 1], 0), width - 1)
            inverse = inverse_depth[near_v, near_u]
            if shadowed or inverse < 1.0 / FURTHEST or inverse > 1.0 / NEAREST:
                continue
            beside = inverse_depth[near_v, max(near_u - 1, 0)]
            above = inverse_depth[max(near_v - 1, 0), near_u]
            jump = max(abs(beside - inverse), abs(above - inverse))
            if jump > EDGE_JUMP * inverse and loss[noise_v, noise_u] < EDGE_LOSS:
                continue
            beyond = np.float32(1.0) / inverse - np.float32(0.4)
            deviation = np.float32(0.0012) + np.float32(0.0019) * beyond * beyond
            disparity = steps * inverse * (1 + deviation * inverse * axial[noise_v, noise_u])
            depth[v, u] = np.uint16(np.float32(1000.0) * steps / np.rint(disparity))
    return depth
