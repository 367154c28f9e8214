"""Says what is recognised in a frame: which action, how surely, and where its object is."""

from dataclasses import dataclass

import numpy as np

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.estimate import LOST, Estimate
from inhand_tracker.recognition.parameters import DEFAULT_RECOGNITION


@dataclass(frozen=True)
class Recognition:
    """``probabilities`` (K,) of the actions: what is missing from 1 is that of none of them.

    ``known`` is the number of the recognised action, None while none is; ``estimate`` is the pose
    of its object, lost while none is. ``box`` (4,) is where an object would be in the image,
    recognised or not: left, top, right and bottom in pixels; None where there is none.
    """

    probabilities: Array
    known: int | None = None
    estimate: Estimate = LOST
    box: Array | None = None


def recognised_action(
    probabilities: Array, least: float = DEFAULT_RECOGNITION.recognised_probability
) -> int | None:
    """Give the number of the recognised action, of probabilities (K,); None where none is."""
    likeliest = int(np.argmax(probabilities))
    return likeliest if probabilities[likeliest] >= least else None


def outline_boxes(outlines: Array) -> Array:
    """Give the boxes (P, 4), left, top, right and bottom, of outlines' pixels (P, B, 2).

    Pixels that are not finite (points behind the camera) do not count; where none is, NaN.
    """
    finite = np.where(np.isfinite(outlines), outlines, np.nan)
    return np.concatenate((np.fmin.reduce(finite, axis=1), np.fmax.reduce(finite, axis=1)), axis=1)
