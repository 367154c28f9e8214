"""Gauss-Newton steps of several poses by what several cameras see of them at once."""

from typing import NamedTuple

import numpy as np
from inhand_runtime.compiled import njit

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.kernels.quaternions import (
    product,
    quaternion_in,
    set_matrix,
    set_quaternion,
    turned,
    vector_in,
)
from inhand_tracker.geometry.kernels.vectors import set_vector
from inhand_tracker.sight.kernels.equations import Equations
from inhand_tracker.sight.kernels.gather import GatherSettings, gather
from inhand_tracker.sight.kernels.inputs import Outlines, ScoredPixels
from inhand_tracker.sight.kernels.refine import Priors, Steps, step_poses

FourPixels = tuple[ScoredPixels, ScoredPixels, ScoredPixels, ScoredPixels]
FourSettings = tuple[GatherSettings, GatherSettings, GatherSettings, GatherSettings]


class Views(NamedTuple):
    """The first ``number`` of four views (``MOST_VIEWS``); the others have no meaning, and are
    there so that this is compiled once, however many cameras see a thing. They have their
    ``pixels`` and ``settings``, and cameras at ``translations`` (4, 3) and ``rotations`` (4, 4) of
    view_from_reference."""

    number: int
    pixels: FourPixels
    settings: FourSettings
    translations: Array
    rotations: Array


@njit(cache=True, nogil=True)
def refine_together(
    poses: tuple[Array, Array],
    priors: Priors,
    steps: Steps,
    outlines: Outlines,
    views: Views,
    information: Array,
) -> None:
    """Move ``poses``, (K, 3) and (K, 4), by all steps, and fill ``information`` (K, 6, 6) with
    what all views said of each at the last of them."""
    translations, orientations = poses
    count = len(translations)
    gradients = np.zeros((count, 6))
    for share in steps.shares:
        information[:] = 0.0
        gradients[:] = 0.0
        for view in range(views.number):
            _add_view(
                (translations, orientations),
                share * steps.reaches,
                outlines,
                views.pixels[view],
                views.settings[view],
                (views.translations[view], views.rotations[view]),
                (information, gradients),
            )
        step_poses(poses, priors, steps.damping, information, gradients)


@njit(cache=True, nogil=True)
def _add_view(
    poses: tuple[Array, Array],
    reaches: Array,
    outlines: Outlines,
    pixels: ScoredPixels,
    settings: GatherSettings,
    place: tuple[Array, Array],
    sums: tuple[Array, Array],
) -> None:
    """Add to ``sums``, information (K, 6, 6) and gradients (K, 6) in the frame of reference, what
    one view says of poses."""
    count = len(poses[0])
    seen = np.empty((count, 3)), np.empty((count, 4))
    shift, rotation = vector_in(place[0]), quaternion_in(place[1])
    for pose in range(count):
        x, y, z = turned(rotation, vector_in(poses[0][pose]))
        set_vector(seen[0][pose], (x + shift[0], y + shift[1], z + shift[2]))
        set_quaternion(seen[1][pose], product(rotation, quaternion_in(poses[1][pose])))
    information, gradients = np.zeros((count, 6, 6)), np.zeros((count, 6))
    equations = Equations(information, gradients)
    gather(seen[0], seen[1], reaches, outlines, pixels, settings, equations)
    turn = np.empty((3, 3))
    set_matrix(turn, rotation)
    half = np.empty((6, 6))
    for pose in range(count):
        # Both blocks of a deviation are turned to the view: I = Bᵀ I_view B.
        for row in range(6):
            for column in range(6):
                block = 3 * (column // 3)
                half[row, column] = 0.0
                for k in range(3):
                    half[row, column] += information[pose, row, block + k] * turn[k, column - block]
        for row in range(6):
            block = 3 * (row // 3)
            for k in range(3):
                sums[1][pose, row] += turn[k, row - block] * gradients[pose, block + k]
                for column in range(6):
                    sums[0][pose, row, column] += turn[k, row - block] * half[block + k, column]
