"""Says what is recognised in a frame: which action, how surely, and where its object is."""

from dataclasses import dataclass

import numpy as np

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.estimate import LOST, Estimate
from inhand_tracker.recognition.parameters import DEFAULT_RECOGNITION


@dataclass(frozen=True)
class Recognition:
    """``probabilities`` (K,) of the actions: what is missing from 1 is that of none of them.

    ``known`` is the number of the recognised action, None while none is; ``doubted`` that of the
    one that was recognised last and may well go on, None while another is or it is unlikely.
    ``estimate`` is the pose of the object of either, lost while there is neither. ``box`` (4,) is
    where an object would be in the image, recognised or not: left, top, right and bottom in pixels;
    None where there is none.
    """

    probabilities: Array
    known: int | None = None
    estimate: Estimate = LOST
    box: Array | None = None
    doubted: int | None = None

    @property
    def used(self) -> int | None:
        """The number of the action whose object has the estimate: it is known, or doubted."""
        return self.doubted if self.known is None else self.known


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
