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


def plainly_between(
    one: Prediction, other: Prediction, share: float, doubt: float, around: float
) -> Prediction:
    moved = other.centre - one.centre
    start = Rotation.from_matrix(one.rotation)
    turned = (Rotation.from_matrix(other.rotation) * start.inv()).as_rotvec()
    still = 1.0 - share + share * doubt
    apart = np.concatenate((moved, turned))
    square = np.repeat([moved @ moved, turned @ turned], 3)
    return Prediction(
        one.centre + share * moved,
        (Rotation.from_rotvec(share * turned) * start).as_matrix(),
        still * one.covariance
        + (1.0 - still) * other.covariance
        + (still * share**2 + (1.0 - still) * (1.0 - share) ** 2) * np.outer(apart, apart)
        + around * np.diag(square),
    )


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_poses_go_straight_and_what_they_differ_by_adds_to_the_covariance(share: float) -> None:
    one, other = prediction(1), prediction(2)
    found = between(one, other, share, doubt=0.5, around=0.2)
    expected = plainly_between(one, other, share, 0.5, 0.2)
    np.testing.assert_allclose(found.centre, expected.centre, atol=1e-9)
    np.testing.assert_allclose(found.rotation, expected.rotation, atol=1e-9)
    np.testing.assert_allclose(found.covariance, expected.covariance, atol=1e-9)
