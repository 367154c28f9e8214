"""What a camera makes of a perfect frame: noisy colour of its own brightness, and its depth."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from inhand_runtime.compiled import njit
from inhand_tracker.geometry.arrays import Array, Bytes, Singles
from numpy.typing import NDArray

from inhand_lab.geometry.canvas import Canvas
from inhand_lab.motions.timeline import drift
from inhand_lab.sensing.cameras import Camera
from inhand_lab.sensing.depth_scene import DepthScene
from inhand_lab.sensing.disparities import Area
from inhand_lab.sensing.noise_fields import FIELD, Place, any_place, colour_noise
from inhand_lab.sensing.noise_parameters import DEFAULT_NOISE, ColourNoise, NoiseParameters
from inhand_lab.sensing.stereo import measure_stereo_depth
from inhand_lab.sensing.structured_light import (
    StillRoom,
    measure_structured_light_depth,
    read_still_room,
)

GREEN_ROWS, BLUE_ROWS = 331, 662
"""Rows of the field of noise between what red is given and what green and blue are."""


def brightness(
    times: Array, random: np.random.Generator, noise: ColourNoise = DEFAULT_NOISE.colour
) -> Array:
    """Gains (T, 3) of red, green and blue at times (T,) in seconds."""
    exposure = drift(times, random, noise.exposure_drift, noise.exposure_period)
    exposure = exposure + noise.flicker * random.normal(size=len(times))
    balance = [drift(times, random, noise.balance_drift, noise.exposure_period) for _ in range(3)]
    return np.exp(exposure[:, None] + np.stack(balance, axis=1))


@dataclass(frozen=True)
class FrameConditions:
    """What one frame is sensed under.

    ``gains`` (3,) brighten the colours; ``unseen`` is the label of what depth does not see, 0 if
    it sees all; ``lasting`` is where the noise that stays from frame to frame is looked up. Outside
    the area ``drawn`` the frame is the ``still`` room, where these are given.
    """

    gains: Array = field(default_factory=lambda: np.ones(3))
    unseen: int = 0
    lasting: Place = (0, 0)
    still: StillRoom | None = None
    drawn: Area | None = None


def sense(
    canvas: Canvas,
    camera: Camera,
    random: np.random.Generator,
    conditions: FrameConditions | None = None,
    noise: NoiseParameters = DEFAULT_NOISE,
) -> tuple[Bytes, NDArray[np.uint16]]:
    """Sense colour (H, W, 3) RGB and depth (H, W) in millimetres, 0 where nothing was measured."""
    conditions = conditions or FrameConditions()
    fresh = any_place(random)
    means, deviations = _levels(conditions.gains, noise.colour)
    colour = _sense_colour(canvas.colour, colour_noise(), means, deviations, *fresh)
    scene = _scene(canvas, camera, conditions, fresh)
    if camera.depth_from == "structured light":
        depth = measure_structured_light_depth(
            scene, noise.structured_light, conditions.still, conditions.drawn
        )
    else:
        depth = measure_stereo_depth(scene, noise.stereo)
    return np.asarray(colour), depth


def read_still(
    room: Canvas, camera: Camera, lasting: Place, noise: NoiseParameters = DEFAULT_NOISE
) -> StillRoom | None:
    """Read a still room once for all frames; None of stereo, which keeps nothing of it."""
    if camera.depth_from != "structured light":
        return None
    scene = _scene(room, camera, FrameConditions(lasting=lasting), (0, 0))
    return read_still_room(scene, noise.structured_light)


def _scene(canvas: Canvas, camera: Camera, conditions: FrameConditions, fresh: Place) -> DepthScene:
    return DepthScene(
        canvas.colour,
        canvas.inverse_depth,
        canvas.labels,
        camera.intrinsics.fx,
        conditions.unseen,
        conditions.lasting,
        fresh,
    )


def _levels(gains: Array, noise: ColourNoise) -> tuple[Singles, Singles]:
    """Mean and deviation (256, 3) of what is read where a perfect sensor reads 0 to 255."""
    means = np.arange(256)[:, None] * gains
    deviations = np.sqrt(noise.read_noise**2 + noise.shot_noise * means)
    return (means + 0.5).astype(np.float32), deviations.astype(np.float32)


@njit(cache=True, nogil=True)
def _sense_colour(colour, unit_noise, means, deviations, row, column):  # type: ignore[no-untyped-def]
    height, width, _ = colour.shape
    noisy, levels = np.empty_like(colour), np.empty(3 * width, np.float32)
    for v in range(height):
        u = 0
        # The field repeats, so that a row is one stretch of it or several.
        while u < width:
            first = (u + column) & (FIELD - 1)
            until = min(u + FIELD - first, width)
            after = first + until - u
            _sense_stretch(
                colour[v, u:until].ravel(),
                unit_noise[(v + row) & (FIELD - 1), first:after],
                unit_noise[(v + row + GREEN_ROWS) & (FIELD - 1), first:after],
                unit_noise[(v + row + BLUE_ROWS) & (FIELD - 1), first:after],
                means,
                deviations,
                levels,
                noisy[v, u:until].ravel(),
            )
            u = until
    return noisy


@njit(cache=True, nogil=True)
def _sense_stretch(colour, red, green, blue, means, deviations, levels, noisy):  # type: ignore[no-untyped-def]
    """Sense N pixels by the noise (N,) of each colour; ``colour`` and ``noisy`` are (3 N,)."""
    for u in range(len(red)):
        r, g, b = colour[3 * u], colour[3 * u + 1], colour[3 * u + 2]
        levels[3 * u] = means[r, 0] + deviations[r, 0] * red[u]
        levels[3 * u + 1] = means[g, 1] + deviations[g, 1] * green[u]
        levels[3 * u + 2] = means[b, 2] + deviations[b, 2] * blue[u]
    least, most = np.float32(0), np.float32(255)
    # A loop of its own, for without look-ups it is done for several levels at once.
    for index in range(len(colour)):
        level = levels[index]
        level = level if level > least else least
        level = level if level < most else most
        noisy[index] = np.uint8(np.int32(level))
