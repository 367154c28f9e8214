"""How well hypotheses agree with an image: a sum of terms that can be chosen."""

from collections.abc import Collection
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from inhand_tracker.depths import depth_log_weights
from inhand_tracker.edges import edge_log_weights
from inhand_tracker.image import Image
from inhand_tracker.model_file import Model
from inhand_tracker.viewpoints import VisiblePoints, find_surfaces

Array = NDArray[np.float64]

Term = Literal["edges", "depth"]

TERMS: tuple[Term, ...] = get_args(Term)
DEFAULT_TERMS: tuple[Term, ...] = ("edges",)
"""What Darby et al. 2014 publish figures for."""


class Likelihood:
    """Weighs poses of one object by the chosen terms."""

    def __init__(self, model: Model, terms: Collection[Term] = DEFAULT_TERMS) -> None:
        seen = model.viewpoints
        self._boundary = self._surface = None
        if "edges" in terms:
            self._boundary = VisiblePoints(seen.directions, seen.boundaries)
        if "depth" in terms:
            surfaces = seen.surfaces
            if surfaces is None:
                surfaces = find_surfaces(model.shape, seen.directions)
            self._surface = VisiblePoints(seen.directions, surfaces)

    def log_weights(self, translations: Array, orientations: Array, image: Image) -> Array:
        """The log-likelihoods (P,), up to a constant, of poses (P, 3) and (P, 4).

        A term of which the image holds nothing is left out.
        """
        total = np.zeros(len(translations))
        if self._boundary is not None and image.chamfer is not None:
            pixels = image.camera.project(self._boundary.place(translations, orientations))
            total += edge_log_weights(image.chamfer, pixels)
        if self._surface is not None and image.surfaces is not None:
            points = self._surface.place(translations, orientations)
            total += depth_log_weights(image.surfaces.distances(points))
        return total
