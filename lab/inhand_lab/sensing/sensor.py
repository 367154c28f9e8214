"""What a camera makes of a perfect frame: noisy colour of its own brightness, and its depth."""

from __future__ import annotations

import numba
import numpy as np
from inhand_tracker.geometry.arrays import Array, Bytes, Singles
from numpy.typing import NDArray

from inhand_lab.geometry.rasteriser import Canvas
from inhand_lab.motions.timeline import drift
from inhand_lab.sensing import stereo, structured_light
from inhand_lab.sensing.cameras import Camera
from inhand_lab.sensing.noise_fields import FIELD, Place, any_place, noise_fields

READ_NOISE = 1.6
SHOT_NOISE = 0.16
"""Variance of colour: READ_NOISE^2 + SHOT_NOISE * value, in squared levels of 256."""

EXPOSURE_DRIFT, EXPOSURE_PERIOD = 0.05, 5.0
"""Deviation of the logarithm of brightness as exposure and daylight change, and how slowly that
goes, in seconds."""
BALANCE_DRIFT = 0.012
"""The same of each colour, as the white balance changes."""
FLICKER = 0.006
"""The same from frame to frame, as mains light beats with the exposure."""


def brightness(times: Array, random: np.random.Generator) -> Array:
    """Gains (T, 3) of red, green and blue at times (T,) in seconds."""
    exposure = drift(times, random, EXPOSURE_DRIFT, EXPOSURE_PERIOD)
    exposure = exposure + FLICKER * random.normal(size=len(times))
    balance = [drift(times, random, BALANCE_DRIFT, EXPOSURE_PERIOD) for _ in range(3)]
    return np.exp(exposure[:, None] + np.stack(balance, axis=1))


def sense(
    canvas: Canvas,
    camera: Camera,
    random: np.random.Generator,
    *,
    gains: Array | None = None,
    unseen: int = 0,
    lasting: Place = (0, 0),
) -> tuple[Bytes, NDArray[np.uint16]]:
    """Colour (H, W, 3) RGB and depth (H, W) in millimetres, 0 where nothing was measured.

    gains (3,) brighten the colours; unseen is the label of what depth does not see, 0 if it sees
    all; lasting is where the noise that stays from frame to frame is looked up.
    """
    place = any_place(random)
    means, deviations = _levels(np.ones(3) if gains is None else gains)
    fields = noise_fields(1.0, 0.0, 1.0)
    colour = _sense_colour(canvas.colour, fields.colour, means, deviations, *place)
    by = structured_light if camera.depth_from == "structured light" else stereo
    depth = by.measure(canvas, camera.intrinsics, unseen, lasting, place)
    return np.asarray(colour), depth


def _levels(gains: Array) -> tuple[Singles, Singles]:
    """Mean and deviation (256, 3) of what is read where a perfect sensor reads 0 to 255."""
    means = np.arange(256)[:, None] * gains
    deviations = np.sqrt(READ_NOISE**2 + SHOT_NOISE * means)
    return (means + 0.5).astype(np.float32), deviations.astype(np.float32)


@numba.njit(cache=True, nogil=True)
def _sense_colour(colour, field, means, deviations, row, column):  # type: ignore[no-untyped-def]
    height, width, _ = colour.shape
    noisy = np.empty_like(colour)
    for v in range(height):
        for u in range(width):
            for channel in range(3):
                value = colour[v, u, channel]
                noise = field[(v + row + 331 * channel) & (FIELD - 1), (u + column) & (FIELD - 1)]
                level = means[value, channel] + deviations[value, channel] * noise
                noisy[v, u, channel] = np.uint8(min(max(level, np.float32(0)), np.float32(255)))
    return noisy
