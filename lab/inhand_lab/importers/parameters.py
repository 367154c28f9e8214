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

    # Skeletons of other conventions.
    hip_centre_share: float = 0.147
    """Share of the way from the middle of the hips to ShoulderCenter at which HipCenter lies: the
    median of UTD-MHAD's Kinect (`pytest tests/lab/importers/test_joint_tables.py`)."""
    spine_share: float = 0.287
    """The share at which Spine lies, likewise."""
    tracked_from: float = 0.3
    """Confidence from which a joint counts as tracked where a format has confidences only: below it
    networks of COCO's key points are usually not drawn."""
    inferred_confidence: float = 0.5
    """Confidence of a joint of which a format says no more than that it is inferred."""
    closest_share: float = 0.75
    """Time after a kept frame, in periods of the rate asked for, within which frames are left out:
    all are kept of a recording at that rate whose times are a quarter of a period off."""
    slowest_s: float = 2.0
    """Time in seconds between frames, in the median, above which times are in another unit."""
    farthest_m: float = 1e6
    """Metres beyond which a joint is missing: joints in millimetres that are taken for metres are
    nearer."""
    nearest_body_m: float = 0.1
    """Distance in metres of the hips from the camera, in the median, below which joints are
    relative to the hips."""
    farthest_aside: float = 10.0
    """Number above which x or y is in pixels where no z is: neither in metres nor in millimetres is
    anybody more to the side of a camera, and less before it."""
    upright_share: float = 0.3
    """Mean of where trunks point, upwards in the image and in lengths of the trunk, in the median,
    below which it is warned of: people lie, or an axis is another."""

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
