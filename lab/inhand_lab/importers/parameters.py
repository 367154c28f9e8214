"""Every number of the imports that can be tuned.

`inhand import FORMAT SRC OUT` applies them, and `inhand bench likelihood SOURCE` those of shapes.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class ImportParameters:
    """The assumptions of an import where the data say nothing."""

    frame_rate: float = 30.0
    """Rate of frames that are kept, in Hz, where none is asked for: that of a Kinect."""

    # Motion archives, seen by a camera that was not there.
    distance_m: float = 3.0
    """Distance in metres of the imagined camera from the person, who is in view from there."""
    image_width: int = 640
    """Width of the imagined camera's image, in pixels, as of a Kinect."""
    image_height: int = 480
    """Height of the imagined camera's image, in pixels, as of a Kinect."""
    focal_length: float = 525.0
    """Focal length of the imagined camera in pixels, as of a Kinect."""
    same_point_m: float = 0.01
    """Distance in metres up to which two archives mark the same point of an object."""
    longest_part_m: float = 0.75
    """Length in metres beyond which a part of the body is warned of: longer than anybody's shank,
    thigh or trunk."""
    unit_tolerance: float = 1e-3
    """Deviation from 1 up to which a quaternion counts as a unit, and a matrix as a rotation."""

    # Shapes from what is measured of an object.
    thinnest_m: float = 0.01
    """Extent in metres below which points are made into a body of that thickness."""
    fewest_points: int = 100
    """Number of points of a surface below which a frame shows too little of it."""

    # BOP data sets.
    symmetry_tolerance: float = 0.02
    """Radians by which a turn of models_info.json may miss a part of a whole one, and deviation of
    its matrix from a rotation: such matrices have been written with three decimals."""
    most_symmetry_shift_mm: float = 5.0
    """Millimetres along its axis by which a turn of models_info.json may shift an object: what is
    annotated of near-symmetric objects is no more exact."""
    highest_order: int = 36
    """Order up to which a turn is looked for: 10° a step."""
    most_skew: float = 0.1
    """Difference in pixels of a camera matrix from a pinhole camera's, up to which it is one."""
    nearest_mm: float = 10.0
    """Distance in millimetres of an object from the camera below which the unit is another."""

    # Shapes completed from a part of their surface.
    cup_sections: int = 48
    """Number of flat sides of a cup's mesh: within 0.1 mm of the round one."""
    lip_m: float = 0.003
    """Height in metres of a cup's lip."""
    wall_m: float = 0.0005
    """Thickness in metres of a cup's wall."""
    bottom_m: float = 0.002
    """Thickness in metres of a cup's bottom."""
    circle_tolerance_m: float = 0.0015
    """Distance in metres from a cup's circle at which a point weighs half."""
    circle_steps: int = 30
    """Number of times that the circle is fitted with new weights."""


DEFAULT_IMPORT = ImportParameters()
