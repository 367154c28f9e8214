"""People as the cameras of a rig see them, made without the code under test."""

from collections.abc import Sequence

import numpy as np
from inhand_schemas.messages import Person
from inhand_tracker.geometry.placement import Placement
from people import STANDING
from scipy.spatial.transform import Rotation

MIDDLE = np.array([0.0, 0.0, 2.5])
"""Where the person of ``STANDING`` is, in the first camera's frame."""


def camera_at(degrees: float) -> Placement:
    """Where a camera is in the frame of the first one, which it stands ``degrees`` aside of, as
    far from the person: rig_from_camera."""
    turn = Rotation.from_euler("y", degrees, degrees=True)
    return Placement(MIDDLE - turn.apply(MIDDLE), turn.as_quat(scalar_first=True))


PLACES = {"front": camera_at(0.0), "left": camera_at(80.0), "right": camera_at(-80.0)}


def seen_from(place: Placement, joints: np.ndarray) -> np.ndarray:
    """Joints (20, 3) of the rig's frame as a camera has them."""
    turn = Rotation.from_quat(place.rotation, scalar_first=True)
    return np.asarray(turn.inv().apply(joints - place.translation))


def person_seen(
    joints: np.ndarray,
    place: Placement = PLACES["front"],
    camera_id: int = 0,
    states: Sequence[str] = ("tracked",) * 20,
    confidence: float = 0.9,
) -> Person:
    """A person with joints (20, 3) of the rig's frame as a camera reports them."""
    return Person(
        id=camera_id,
        joints=tuple(map(tuple, seen_from(place, joints).tolist())),
        states=tuple(states),
        confidences=(confidence,) * 20,
    )


def standing_at(x: float, z: float = 0.0) -> np.ndarray:
    """A standing person's joints (20, 3), some way aside and farther off."""
    return np.asarray(STANDING + np.array([x, 0.0, z]))
