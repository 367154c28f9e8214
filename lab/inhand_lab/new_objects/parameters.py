"""Every number of new objects that can be tuned.

`inhand object new` uses them all; `inhand bench objects` shows what those of measuring by a camera
make. Where nothing else is said a number was set by hand with these figures in view.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class ProposalParameters:
    """How a mesh is compared with its own image, turned or mirrored."""

    samples: int = 60_000
    """Number of points, evenly spread on a surface, by which the nearest triangles are found."""
    compared: int = 2_000
    """Number of points of the image that are compared with the surface."""
    screened: int = 100
    """Number of these that are compared first: most images miss by far."""
    screened_share: float = 0.9
    """Share of these that must be near enough for the others to be compared."""
    neighbours: int = 8
    """Number of nearest points whose triangles are tried for the nearest one."""
    tolerance_m: float = 0.001
    """Distance in metres by which an image may miss the surface: labels are no more exact."""
    tolerance_share: float = 0.005
    """That distance as a share of the second longest side of the box around the object, where that
    is more: 32 flat sides miss as much of a round thing."""
    compared_share: float = 0.99
    """Share of the points that must be within that distance: a handle has a tenth or more of a
    mug's surface."""
    orders: tuple[int, ...] = (12, 10, 8, 6, 5, 4, 3, 2)
    """Numbers of equal turns to the whole one that are tried, the largest first."""
    any_angle: tuple[float, ...] = (0.37, 1.13, 2.03, 2.71)
    """Turns in radians, of which none is a part of a whole one, that a round thing must bear."""
    normals: int = 8
    """Number of directions that most of the surface faces, in which axes are looked for."""
    parallel: float = 0.01
    """Sine of the angle up to which two axes are one."""
    same_centre_m: float = 0.0002
    """Distance in metres up to which the centroid and the middle of the box count as one."""
    most_axes: int = 3
    """Number of axes that are kept, those of the most turns first: the turns about three axes make
    all others of a cube."""
    farthest_mark_m: float = 0.02
    """Distance in metres of a mark that was asked for from the surface, at the most; it is moved
    there."""


@dataclass(frozen=True)
class MeshParameters:
    """How a mesh file is read."""

    smallest_m: float = 0.01
    """Size in metres of the smallest object that a unit is guessed by."""
    largest_m: float = 2.5
    """Size in metres of the largest object that a unit is guessed by: `inhand train` takes more,
    and a mesh that is as large must be given its unit."""
    most_faces: int = 10_000
    """Number of faces to which a mesh is reduced: training draws it from 642 sides, and no depth
    camera sees what is finer."""


DEFAULT_PROPOSAL = ProposalParameters()
DEFAULT_MESH = MeshParameters()
