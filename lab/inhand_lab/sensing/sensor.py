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
from inhand_lab.sensing.noise_fields import FIELD, Place, any_place, colour_noise
from inhand_lab.sensing.noise_parameters import DEFAULT_NOISE, ColourNoise, NoiseParameters
from inhand_lab.sensing.stereo import measure_stereo_depth
from inhand_lab.sensing.structured_light import measure_structured_light_depth


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
    it sees all; ``lasting`` is where the noise that stays from frame to frame is looked up.
    """

    gains: Array = field(default_factory=lambda: np.ones(3))
    unseen: int = 0
    lasting: Place = (0, 0)


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
    scene = DepthScene(
        canvas.colour,
        canvas.inverse_depth,
        canvas.labels,
        camera.intrinsics.fx,
        conditions.unseen,
        conditions.lasting,
        fresh,
    )
    if camera.depth_from == "structured light":
        depth = measure_structured_light_depth(scene, noise.structured_light)
    else:
        depth = measure_stereo_depth(scene, noise.stereo)
    return np.asarray(colour), depth


def _levels(gains: Array, noise: ColourNoise) -> tuple[Singles, Singles]:
    """Mean and deviation (256, 3) of what is read where a perfect sensor reads 0 to 255."""
    means = np.arange(256)[:, None] * gains
    deviations = np.sqrt(noise.read_noise**2 + noise.shot_noise * means)
    return (means + 0.5).astype(np.float32), deviations.astype(np.float32)


@njit(cache=True, nogil=True)
def _sense_colour(colour, unit_noise, means, deviations, row, column):  # type: ignore[no-untyped-def]
    height, width, _ = colour.shape
    noisy = np.empty_like(colour)
    for v in range(height):
        for u in range(width):
            for channel in range(3):
                value = colour[v, u, channel]
                at = (v + row + 331 * channel) & (FIELD - 1), (u + column) & (FIELD - 1)
                level = means[value, channel] + deviations[value, channel] * unit_noise[at]
                noisy[v, u, channel] = np.uint8(min(max(level, np.float32(0)), np.float32(255)))
    return noisy
