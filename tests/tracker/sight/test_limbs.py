import numpy as np
import pytest
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.sight.limbs import limb_mask
from people import STANDING

CAMERA = Intrinsics(525.0, 525.0, 319.5, 239.5, 640, 480)
WRIST, HAND = 10, 11


def pixel_of(point: np.ndarray) -> tuple[int, int]:
    column, row = np.rint(CAMERA.project(point)).astype(int)
    return row, column


def test_hands_and_forearms_are_covered_and_the_head_is_not() -> None:
    mask = limb_mask(STANDING, CAMERA, None)
    for joint in (6, 7, WRIST, HAND):
        assert mask[pixel_of(STANDING[joint])] == 1
    assert mask[pixel_of(STANDING[3])] == 0
    assert 0.001 < mask.mean() < 0.1


def test_what_is_far_behind_a_hand_or_far_before_it_is_no_hand() -> None:
    place = pixel_of(STANDING[HAND])
    depth = np.full((480, 640), float(STANDING[HAND, 2]), np.float32)
    assert limb_mask(STANDING, CAMERA, depth)[place] == 1
    for away in (-0.5, 0.8):
        assert limb_mask(STANDING, CAMERA, depth + np.float32(away))[place] == 0
    assert limb_mask(STANDING, CAMERA, np.zeros_like(depth))[place] == 1


@pytest.mark.parametrize("place", [np.nan, -1.0, 0.0])
def test_joints_that_are_missing_or_behind_the_camera_hide_nothing(place: float) -> None:
    joints = STANDING.copy()
    joints[8:12, 2] = place
    joints[4:8] = np.nan
    assert limb_mask(joints, CAMERA, None).sum() == 0


def test_without_a_person_nothing_is_hidden() -> None:
    assert limb_mask(None, CAMERA, None).sum() == 0
