"""Gauss-Newton steps of several poses, each drawn towards a prior of its own."""

from typing import NamedTuple

import numpy as np
from inhand_runtime.compiled import njit

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.kernels.matrices import find_root, solve
from inhand_tracker.geometry.kernels.pose_normals import set_deviated, set_deviation
from inhand_tracker.sight.kernels.equations import Equations
from inhand_tracker.sight.kernels.gather import GatherSettings, gather
from inhand_tracker.sight.kernels.inputs import Outlines, ScoredPixels


class Priors(NamedTuple):
    """The Gaussians that K poses are drawn to, by their means (K, 3) and (K, 4), and their
    ``information`` (K, 6, 6)."""

    translations: Array
    rotations: Array
    information: Array


class Steps(NamedTuple):
    """The ``shares`` (S,) of the ``reaches`` (K, 2) that poses may be off by at each step, and the
    ``damping`` (6,), information that keeps a pose in place."""

    shares: Array
    reaches: Array
    damping: Array


@njit(cache=True, nogil=True)
def refine(
    poses: tuple[Array, Array],
    priors: Priors,
    steps: Steps,
    outlines: Outlines,
    pixels: ScoredPixels,
    settings: GatherSettings,
    information: Array,
) -> None:
    """Move ``poses``, (K, 3) and (K, 4), by all steps, and fill ``information`` (K, 6, 6) with
    what the frame said of each at the last of them."""
    translations, orientations = poses
    gradients = np.zeros((len(translations), 6))
    for share in steps.shares:
        information[:] = 0.0
        gradients[:] = 0.0
        equations = Equations(information, gradients)
        reaches = share * steps.reaches
        gather(translations, orientations, reaches, outlines, pixels, settings, equations)
        step_poses(poses, priors, steps.damping, information, gradients)


@njit(cache=True, nogil=True)
def step_poses(
    poses: tuple[Array, Array],
    priors: Priors,
    damping: Array,
    information: Array,
    gradients: Array,
) -> None:
    """Move poses by one step, by ``information`` (K, 6, 6) and ``gradients`` (K, 6), which are
    used up, and by their priors."""
    translations, orientations = poses
    root, off = np.empty((6, 6)), np.empty(6)
    for pose in range(len(translations)):
        gradient = gradients[pose]
        set_deviation(
            translations[pose],
            orientations[pose],
            priors.translations[pose],
            priors.rotations[pose],
            off,
        )
        for row in range(6):
            for column in range(6):
                gradient[row] += priors.information[pose, row, column] * off[column]
                root[row, column] = (
                    information[pose, row, column] + priors.information[pose, row, column]
                )
            root[row, row] += damping[row]
        if find_root(root, root):
            solve(root, gradient)
            _move(translations[pose], orientations[pose], gradient)


@njit(cache=True, nogil=True)
def _move(translation: Array, orientation: Array, step: Array) -> None:
    """Move a pose by a step (6,)."""
    set_deviated(translation.copy(), orientation.copy(), step, translation, orientation)
    orientation /= np.sqrt((orientation * orientation).sum())
