"""How far tracks are from the truth, frame by frame."""

from dataclasses import dataclass

import numpy as np
from inhand_lab.datasets.tracks import Track
from inhand_lab.evaluation.vertex_error import vertex_error
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.shape.shape import ObjectShape

from inhand_studio.review_page.parameters import ReviewParameters
from inhand_studio.scene_parts import Colour


@dataclass(frozen=True)
class Estimate:
    """A track of one object that is compared with its labels, and how it is called and drawn.

    ``errors`` (T,) are its vertex errors in metres, NaN in frames without a pose or a label; None
    where nothing is known of them.
    """

    name: str
    object: str
    colour: Colour
    track: Track
    errors: Array | None

    def summary(self) -> str:
        """Say how large its errors are."""
        if self.errors is None or not np.isfinite(self.errors).any():
            return "no labels to compare with"
        whole = self.errors[np.isfinite(self.errors)]
        median_cm, worst_cm = 100.0 * np.median(whole), 100.0 * whole.max()
        return f"median {median_cm:.1f} cm, mean {100.0 * whole.mean():.1f}, worst {worst_cm:.1f}"


def errors_of(
    track: Track, truth: Track, shape: ObjectShape, parameters: ReviewParameters
) -> Array:
    """Return the vertex errors (T,) in metres of a track, NaN where it or the truth has no pose."""
    errors = np.full(len(track.translations), np.nan)
    step = parameters.frames_at_once
    for first in range(0, len(errors), step):
        part = slice(first, first + step)
        errors[part] = vertex_error(
            (track.translations[part], track.rotations[part]),
            (truth.translations[part], truth.rotations[part]),
            shape.marked_vertices,
        )
    return errors
