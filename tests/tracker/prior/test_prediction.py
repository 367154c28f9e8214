"""What lies between two predictions."""

import numpy as np
import pytest
from inhand_tracker.prior.prediction import Prediction, between
from scipy.spatial.transform import Rotation


def prediction(seed: int) -> Prediction:
    random = np.random.default_rng(seed)
    root = random.normal(size=(6, 6))
    rotation = Rotation.from_rotvec(random.normal(size=3)).as_matrix()
    return Prediction(random.normal(size=3), rotation, root @ root.T)


def plainly_between(one: Prediction, other: Prediction, share: float, doubt: float) -> Prediction:
    moved = other.centre - one.centre
    start = Rotation.from_matrix(one.rotation)
    turned = (Rotation.from_matrix(other.rotation) * start.inv()).as_rotvec()
    apart = np.square([moved, turned]).sum(axis=1)
    unsure = share * (1.0 - share) + share * doubt
    return Prediction(
        one.centre + share * moved,
        (Rotation.from_rotvec(share * turned) * start).as_matrix(),
        (1.0 - share) * one.covariance
        + share * other.covariance
        + unsure * np.diag(np.repeat(apart, 3)),
    )


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_poses_go_straight_and_what_they_differ_by_adds_to_the_covariance(share: float) -> None:
    one, other = prediction(1), prediction(2)
    found, expected = between(one, other, share, 0.5), plainly_between(one, other, share, 0.5)
    np.testing.assert_allclose(found.centre, expected.centre, atol=1e-9)
    np.testing.assert_allclose(found.rotation, expected.rotation, atol=1e-9)
    np.testing.assert_allclose(found.covariance, expected.covariance, atol=1e-9)
