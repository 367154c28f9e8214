"""The likelihood of hypotheses by an image: a sum of terms that can be chosen."""

from collections.abc import Collection

import numpy as np

from inhand_tracker.geometry.arrays import Array, Singles
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.image import Image
from inhand_tracker.methods.darby2014.depths import depth_log_weights, surfaces_of
from inhand_tracker.methods.darby2014.edges import chamfer_of, weigh_by_edges
from inhand_tracker.methods.darby2014.terms import DEFAULT_TERMS, Term
from inhand_tracker.model.model import Model
from inhand_tracker.shape.view_grid import view_grid
from inhand_tracker.shape.viewpoints import Viewpoints, find_surfaces
from inhand_tracker.shape.visible_points import VisiblePoints


class Likelihood:
    """Weighs poses of one object by the chosen terms."""

    def __init__(self, model: Model, terms: Collection[Term] = DEFAULT_TERMS) -> None:
        seen = model.viewpoints
        self._boundary: _Boundaries | None = None
        self._surface: VisiblePoints | None = None
        if "edges" in terms:
            self._boundary = _Boundaries(seen)
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
        chamfer = None if self._boundary is None else image.once(chamfer_of)
        if self._boundary is not None and chamfer is not None:
            total += self._boundary.log_weights(translations, orientations, chamfer, image.camera)
        surfaces = None if self._surface is None else image.once(surfaces_of)
        if self._surface is not None and surfaces is not None:
            points = self._surface.place(translations, orientations)
            total += depth_log_weights(surfaces.distances(points))
        return total


class _Boundaries:
    """An object's boundaries, laid out for weighing."""

    def __init__(self, seen: Viewpoints) -> None:
        self._grid = view_grid(seen.directions)
        self._directions = np.ascontiguousarray(seen.directions, float)
        self._points = np.ascontiguousarray(np.swapaxes(seen.boundaries, 1, 2), float)

    def log_weights(
        self,
        translations: Array,
        orientations: Array,
        chamfer: Singles,
        camera: Intrinsics,
    ) -> Array:
        log_weights = np.empty(len(translations))
        weigh_by_edges(
            np.ascontiguousarray(translations, float),
            np.ascontiguousarray(orientations, float),
            self._grid,
            self._directions,
            self._points,
            np.array([camera.fx, camera.fy, camera.cx, camera.cy]),
            chamfer,
            log_weights,
        )
        return log_weights
