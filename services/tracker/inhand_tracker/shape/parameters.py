"""Every number of shapes that can be tuned: how finely objects are seen from all directions.

They hold for training; a model keeps what was found with them. `inhand bench tracker` shows what
the number of points costs, and `inhand bench likelihood SOURCE` what the outlines are worth.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class ShapeParameters:
    """From how many directions an object is seen, and how many of its points are kept."""

    subdivisions: int = 3
    """Number of times that an icosahedron is divided into directions: 642, at most 6 degrees
    off."""
    boundary_points: int = 50
    """Number of points along a visible boundary: those of Darby et al. 2014, section 5.6."""
    surface_points: int = 50
    """Number of points over a visible surface."""
    boundary_raster: int = 160
    """Pixels along a side of the raster that boundaries are found on."""
    boundary_margin: int = 4
    """Pixels of that raster that stay free on each side."""

    # Contours of sight.
    contour_points: int = 50
    """Number of points along an outline."""
    contour_raster: int = 256
    """Pixels along a side of the raster that outlines are found on."""
    contour_margin: int = 8
    """Pixels of that raster that stay free on each side."""
    chord_pixels: int = 4
    """Pixels of an outline on either side of a point that give its normal."""
    endless_m: float = 10.0
    """Metres that stand for no end of a silhouette's absence: more than any object is wide."""
    small_hole: float = 0.08
    """Side of the largest hole that counts as no part of the outline, in sizes of the object: finer
    ones, as a racket's net, are not seen in an image."""


DEFAULT_SHAPE = ShapeParameters()
