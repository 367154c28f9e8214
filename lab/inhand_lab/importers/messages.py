"""Makes messages of an import's arrays."""

import numpy as np
from inhand_schemas.messages import CameraInfo, ObjectPose, Person, Skeletons
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.wire.poses import pose_message

from inhand_lab.datasets.dataset import CAMERA
from inhand_lab.importers.parameters import DEFAULT_IMPORT

PERSON = 0


def imagined_camera(time_ns: int, description: str, frame_rate: float | None = None) -> CameraInfo:
    """Make the info of a camera that no file describes, and that gave no pixels.

    ``frame_rate`` is in Hz; where it is not known it is a Kinect's.
    """
    width, height = DEFAULT_IMPORT.image_width, DEFAULT_IMPORT.image_height
    return CameraInfo(
        sequence=0,
        time_ns=time_ns,
        width=width,
        height=height,
        fx=DEFAULT_IMPORT.focal_length,
        fy=DEFAULT_IMPORT.focal_length,
        cx=(width - 1) / 2.0,
        cy=(height - 1) / 2.0,
        frame_rate=frame_rate or DEFAULT_IMPORT.frame_rate,
        has_colour=False,
        has_depth=False,
        description=description,
    )


def imported_skeletons(
    sequence: int, time_ns: int, joints: Array, convention: str | None = None
) -> Skeletons:
    """Make skeletons of one person's joints (20, 3) in the camera frame, missing if not finite.

    ``convention`` names whose joints they are, if that is known.
    """
    seen = np.asarray(np.isfinite(joints).all(axis=1))
    if not seen.any():
        return Skeletons(sequence=sequence, time_ns=time_ns, convention=convention)
    positions = np.where(seen[:, None], joints, 0.0).tolist()
    person = Person(
        id=PERSON,
        joints=tuple((x, y, z) for x, y, z in positions),
        states=tuple("tracked" if finite else "missing" for finite in seen),
        confidences=tuple(seen.astype(float).tolist()),
    )
    return Skeletons(sequence=sequence, time_ns=time_ns, people=(person,), convention=convention)


def imported_label(
    sequence: int,
    time_ns: int,
    name: str,
    translation: Array,
    rotation: Array,
    person: int | None = None,
) -> ObjectPose:
    """Make a label of the true camera_from_object, (3,) and (4,)."""
    return ObjectPose(
        sequence=sequence,
        time_ns=time_ns,
        object=name,
        camera=CAMERA,
        state="tracked",
        confidence=1.0,
        person=person,
        camera_from_object=pose_message(translation, rotation),
    )
