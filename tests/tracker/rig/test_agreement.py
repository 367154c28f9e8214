"""Whether cameras agree, by what they see of the same people."""

import numpy as np
import pytest
from inhand_tracker.rig.agreement import _medians


@pytest.mark.parametrize("cameras", [1, 2, 3])
def test_a_median_is_that_of_the_cameras_that_see_a_joint(cameras: int) -> None:
    random = np.random.default_rng(cameras)
    joints = random.normal(size=(cameras, 200, 3))
    joints[random.random((cameras, 200)) < 0.4] = np.nan
    joints = joints[:, np.isfinite(joints).all(axis=2).any(axis=0)]
    np.testing.assert_array_equal(_medians(joints), np.nanmedian(joints, axis=0))
