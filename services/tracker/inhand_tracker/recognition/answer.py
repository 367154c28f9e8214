"""What is said of a frame when the object is not given: which one, how surely, and where."""

from dataclasses import dataclass

import numpy as np

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.estimate import LOST, Estimate

KNOWN = 0.5
"""An action is known that holds this share of the probability (Darby et al. 2012, section 5)."""


@dataclass(frozen=True)
class Recognition:
    """``probabilities`` (K,) of the actions: what is missing from 1 is that of none of them.

    ``known`` is the number of the action that is known, whose object's pose ``estimate`` is; while
    none is known that is lost. ``box`` is where an object would be in the image, known or not:
    left, top, right and bottom in pixels, (4,); None where that is not known.
    """

    probabilities: Array
    known: int | None = None
    estimate: Estimate = LOST
    box: Array | None = None


def known_action(probabilities: Array) -> int | None:
    """The number of the action that is known, of probabilities (K,)."""
    likeliest = int(np.argmax(probabilities))
    return likeliest if probabilities[likeliest] >= KNOWN else None


def boxes_around(outlines: Array) -> Array:
    """Boxes (P, 4), left, top, right and bottom, of the finite ones of pixels (P, B, 2).

    NaN where none is: behind the camera.
    """
    known = np.where(np.isfinite(outlines), outlines, np.nan)
    return np.concatenate((np.fmin.reduce(known, axis=1), np.fmax.reduce(known, axis=1)), axis=1)
