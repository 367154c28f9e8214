"""Directions and symmetries of an object in words."""

import numpy as np
from inhand_tracker.shape.shape import Symmetry


def describe_symmetry(symmetry: Symmetry) -> str:
    """Say about which axis an object may be turned, and by how much, to look the same."""
    turn = "any angle" if symmetry.order == 0 else f"{360 / symmetry.order:g}°"
    return f"turned about {axis_name(symmetry.axis)} by {turn}"


def axis_name(direction: tuple[float, float, float] | np.ndarray) -> str:
    """Name a direction (3,): x, y or z, or its numbers."""
    for name, axis in zip("xyz", np.eye(3), strict=True):
        if abs(float(np.dot(direction, axis))) > 1.0 - 1e-6:
            return name
    return f"({', '.join(f'{value:.2f}' for value in direction)})"
