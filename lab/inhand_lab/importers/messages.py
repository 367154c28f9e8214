"""Arrays of an import as messages."""

import numpy as np
from inhand_schemas.messages import ObjectPose, Person, Skeletons
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.wire.poses import pose_message

from inhand_lab.datasets.dataset import CAMERA

PERSON = 0


def imported_skeletons(sequence: int, time_ns: int, joints: Array) -> Skeletons:
    """One person's joints (20, 3) in the camera frame; those that are not finite are missing."""
    seen = np.asarray(np.isfinite(joints).all(axis=1))
    if not seen.any():
        return Skeletons(sequence=sequence, time_ns=time_ns)
    positions = np.where(seen[:, None], joints, 0.0).tolist()
    person = Person(
        id=PERSON,
        joints=tuple((x, y, z) for x, y, z in positions),
        states=tuple("tracked" if there else "missing" for there in seen),
        confidences=tuple(seen.astype(float).tolist()),
    )
    return Skeletons(sequence=sequence, time_ns=time_ns, people=(person,))


def imported_label(
    sequence: int,
    time_ns: int,
    name: str,
    translation: Array,
    rotation: Array,
    person: int | None = None,
) -> ObjectPose:
    """The true camera_from_object: (3,) and (4,)."""
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
