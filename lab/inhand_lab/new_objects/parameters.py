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


@dataclass(frozen=True)
class MeasuringParameters:
    """How a thing on a table is cut out of depth and measured.

    `inhand bench objects` shows what they make of simulated depth.
    """

    # What is read of a recording.
    frames: int = 15
    """Number of frames of which each pixel's median is taken: noise that changes is halved and
    halved again."""
    fewest_frames: int = 5
    """Number of these frames at the least."""
    least_frames_share: float = 0.5
    """Share of these frames in which a pixel must be measured."""
    moved_m: float = 0.02
    """Change of a pixel's depth in metres from the first frames to the last from which on
    something moves there, close to the camera."""
    moved_m_per_m2: float = 0.02
    """Growth of that change with the square of the distance: stereo errs so."""
    most_moved_share: float = 0.02
    """Share of the pixels that may change as much: edges flicker."""

    # The plane of the table.
    farthest_m: float = 2.0
    """Distance in metres beyond which depth is too coarse to measure by."""
    tried_points: int = 3000
    """Number of points by which planes are compared."""
    tried_planes: int = 400
    """Number of planes through three of them that are tried."""
    plane_m: float = 0.004
    """Distance in metres of a point from the plane it is of, at the most, close to the camera."""
    plane_m_per_m2: float = 0.005
    """Growth of that distance with the square of the distance from the camera, as depth errs."""
    least_rise: float = 0.2
    """Sine of the angle at which a camera that is held upright must look down at the table."""
    least_plane_share: float = 0.15
    """Share of the near points that the table has, at the least."""
    seed: int = 0
    """Seed of the draw of points: the same depth gives the same plane."""

    # What stands on it.
    least_height_m: float = 0.006
    """Height in metres above the plane, beyond its tolerance, from which a point stands on it."""
    most_height_m: float = 0.6
    """Height in metres above the plane up to which a thing is looked for."""
    cell_m: float = 0.008
    """Side in metres of the cells of the table in which points are counted; things whose cells
    touch are one."""
    cell_points: int = 3
    """Number of points of a cell that is taken: single ones are noise."""
    fewest_points: int = 250
    """Number of points of a thing, at the least."""
    fewest_part_points: int = 20
    """Number of points of a part that hangs together with nothing else, at the least."""
    most_part_share: float = 0.25
    """Number of points of such a part as a share of the largest part's, below which it is of it."""
    part_gap_m: float = 0.06
    """Distance in metres of such a part from the largest one, at the most."""
    border_pixels: int = 3
    """Distance in pixels from the image's edge within which a thing is cut off."""

    # The fit.
    fitted_points: int = 2500
    """Number of a thing's points, evenly chosen, by which it is fitted."""
    outermost: float = 0.005
    """Share of the points beyond each end that are left out where an extent is taken."""
    soft_m: float = 0.003
    """Distance in metres from which on a point weighs less in a fit."""
    smallest_radius_share: float = 0.05
    """Radius of a round thing as a share of half the extent that is seen, at the least."""
    largest_radius_share: float = 1.1
    """That share at the most."""
    height_shares: tuple[float, float] = (0.9, 1.03)
    """Height of a round thing as shares of that of its highest point, at the least and the most."""
    neck_shares: tuple[float, float] = (0.2, 0.9)
    """Radius of a bottle's neck as shares of the body's, at the least and the most."""
    highest_shoulder: float = 0.85
    """Height of a bottle's shoulder as a share of the bottle's, at the most."""
    yaw_steps: int = 180
    """Number of turns of a box, over a quarter turn, that are tried."""
    off_m: float = 0.006
    """Distance in metres from the surface beyond which a point is off it, close to the camera;
    ``plane_m_per_m2`` is added."""
    most_off_share: float = 0.12
    """Share of the points that may be off the fitted surface."""
    most_residual_m: float = 0.004
    """Mean distance in metres of the points that are on it, at the most."""
    least_overlap: float = 0.85
    """Share of the pixels of thing or model that are of both, at the least: a sensor loses some at
    every edge."""
    simpler: float = 0.85
    """Factor on the residual by which a shape must be better than a simpler one."""
    least_handle_share: float = 0.02
    """Share of the points that a handle has, at the least."""
    least_handle_m: float = 0.012
    """Length in metres by which a handle stands out, at the least."""
    handle_spread: float = 0.9
    """Mean resultant length of the directions of a handle's points from the axis, at the least."""


DEFAULT_MEASURING = MeasuringParameters()
