"""Noise drawn once and looked up ever after: sensors are too large for a fresh draw a frame."""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from inhand_tracker.geometry.arrays import Array, Singles
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter
from scipy.special import ndtr

FIELD = 1024
"""Width and height of the fields, which repeat; a power of two."""

SEED = 0x5E4502
"""Seed of all fields."""

Place = tuple[int, int]
"""Row and column of a field that an image begins at."""


class NoiseFields(NamedTuple):
    """Fields (FIELD, FIELD) of noise, which compiled code reads.

    ``axial`` is of unit deviation and correlated, ``lateral`` (..., 2) are whole pixels, ``loss``
    is uniform in [0, 1) and ``patches`` so too but correlated over many pixels.
    """

    axial: Singles
    lateral: NDArray[np.int8]
    loss: Singles
    patches: Singles


@cache
def noise_fields(grain: float, lateral_deviation: float, patch: float) -> NoiseFields:
    """The fields for these sizes in pixels, always the same.

    ``grain`` is the distance over which depth noise is correlated, ``patch`` the size of patches.
    """
    random = np.random.default_rng(SEED)

    def correlated(pixels: float) -> Array:
        field = gaussian_filter(random.normal(size=(FIELD, FIELD)), pixels, mode="wrap")
        return np.asarray(field / field.std())

    axial = correlated(grain).astype(np.float32)
    lateral = np.empty((FIELD, FIELD, 2), np.int8)
    for axis in range(2):
        lateral[..., axis] = np.rint(lateral_deviation * correlated(0.8 * grain))
    return NoiseFields(
        axial,
        lateral,
        random.random((FIELD, FIELD)).astype(np.float32),
        ndtr(correlated(patch)).astype(np.float32),
    )


@cache
def colour_noise() -> Singles:
    """A field (FIELD, FIELD) of noise of unit deviation for colours, always the same."""
    random, shape = np.random.default_rng(SEED), (FIELD, FIELD)
    # It follows what ``noise_fields`` draws, as it did when it was one of them: pictures stay.
    for draw in (random.normal, random.normal, random.normal, random.random, random.normal):
        draw(size=shape)
    return random.normal(size=shape).astype(np.float32)


def any_place(random: np.random.Generator) -> Place:
    """A random place in a field."""
    row, column = random.integers(FIELD, size=2).tolist()
    return row, column
