"""The vertex error, by which Darby et al. 2014, section 6.2, compare poses."""

import numpy as np
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array


def vertex_error(
    estimate: tuple[Array, Array], truth: tuple[Array, Array], marked_vertices: Array
) -> Array:
    """Mean distance in metres between corresponding vertices (M, 3) of an object in two poses.

    Both poses are translations (..., 3) and rotations (..., 4); the result is (...).
    """
    placed = [
        rotations.rotate(orientation[..., None, :], marked_vertices) + translation[..., None, :]
        for translation, orientation in (estimate, truth)
    ]
    return np.asarray(np.linalg.norm(placed[0] - placed[1], axis=-1).mean(axis=-1))
