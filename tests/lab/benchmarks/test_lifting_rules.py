"""The rules beside which capture's lifting is measured, and what is said of distances."""

from pathlib import Path

import numpy as np
import pytest
from inhand_capture.estimation.lifting import DepthPicture
from inhand_lab.benchmarks.joint_distances import by_joint, summed_up
from inhand_lab.benchmarks.lifting_rules import RULES, centre_pixel, kinect_joints, window_median
from inhand_lab.benchmarks.real_depth_lifting import (
    OWN_RULE,
    check_real_lifting,
    real_recordings,
)
from inhand_lab.datasets.dataset import DatasetError
from inhand_schemas.joints import Joint
from posed_person import KNOWN, LENS, WALL_M, depth_of, picture, pixels_of, seen, standing
from real_data import DATA, needs_real_data

TRUTH = standing()


def test_rules_find_what_nothing_hides() -> None:
    for rule in RULES.values():
        found = rule(seen(TRUTH), picture(TRUTH), LENS)
        assert np.linalg.norm(found - TRUTH, axis=1)[KNOWN].max() < 0.08
        joints = kinect_joints(found)
        assert np.isfinite(joints).all()
        assert np.linalg.norm(joints[Joint.SPINE] - TRUTH[Joint.HIP_LEFT]) < 0.3


def test_a_hole_leaves_the_centre_pixel_without_a_value_and_a_window_with_the_wall_s() -> None:
    depth = depth_of(TRUTH)
    x, y = np.round(pixels_of(TRUTH)[Joint.WRIST_LEFT]).astype(int)
    depth[y - 1 : y + 2, x - 1 : x + 2] = 0
    depth[y - 4 : y + 5, x - 4 : x + 5][depth[y - 4 : y + 5, x - 4 : x + 5] > 0] = 1000 * WALL_M
    holed = DepthPicture(depth, 0.001)
    assert np.isnan(centre_pixel(seen(TRUTH), holed, LENS)[Joint.WRIST_LEFT, 2])
    assert window_median(seen(TRUTH), holed, LENS)[Joint.WRIST_LEFT, 2] > WALL_M


def test_distances_are_summed_up_over_what_was_found() -> None:
    distances = np.array([[0.01, 0.11, 0.21, np.nan]])
    said = summed_up(distances)
    assert (said.joints, said.missing) == (4, 0.25)
    assert (said.median_cm, said.over_10_cm, said.over_20_cm) == pytest.approx((11, 2 / 3, 1 / 3))
    assert summed_up(np.full(3, np.nan)).missing == 1.0
    one = np.full(20, np.nan)
    one[Joint.HEAD] = 0.05
    assert by_joint([one])["Head"].median_cm == pytest.approx(5.0)


def test_a_folder_without_depth_is_refused(tmp_path: Path) -> None:
    with pytest.raises(DatasetError, match=r"holds no \*_depth\.mat: name a folder of UTD-MHAD"):
        real_recordings(tmp_path)


@pytest.mark.long
@needs_real_data
def test_on_real_depth_fewer_joints_are_wrong_or_without_value_than_by_simple_rules() -> None:
    files = real_recordings(DATA / "utd-mhad")[::8]
    check = check_real_lifting(files, lambda: None)

    def wrong(rule: str) -> float:
        one = check.rules[rule]
        return one.missing + (1.0 - one.missing) * one.over_10_cm

    assert wrong(OWN_RULE) < min(wrong(rule) for rule in RULES)
    assert check.rules[OWN_RULE].median_cm < 3.0
