"""The kernel beside its definition in NumPy."""

import numpy as np
import pytest
from inhand_tracker.rig.kernels.fuse import FuseSettings, fuse, mean_distance

SETTINGS = FuseSettings(1.5, 3.0, 4, 0.06)


def fused_by_definition(
    points: np.ndarray, covariances: np.ndarray, settings: FuseSettings = SETTINGS
) -> np.ndarray:
    """One joint of points (N, 3), each of a covariance (N, 3, 3): weighed anew from the median."""
    middle = np.median(points, axis=0)
    information = np.linalg.inv(covariances)
    for _ in range(settings.reweightings):
        off = points - middle
        squares = np.einsum("ni,nij,nj->n", off, information, off)
        weighed = ((settings.freedom + 3) / (settings.freedom + squares))[:, None, None]
        weighed = weighed * information
        middle = np.linalg.solve(weighed.sum(axis=0), np.einsum("nij,nj->i", weighed, points))
    return middle


def test_joints_are_fused_as_defined() -> None:
    random = np.random.default_rng(3)
    joints = random.normal(0.0, 0.05, (3, 20, 3))
    rays = random.normal(size=(3, 20, 3))
    rays /= np.linalg.norm(rays, axis=2, keepdims=True)
    deviations = random.uniform(0.01, 0.06, (3, 20))
    expected = random.normal(0.0, 0.05, (20, 3))
    joints[0, 4] = joints[1, 7] = joints[2, 7] = expected[9] = np.nan
    joints[:, 11] = np.nan
    fused, weights = np.empty((20, 3)), np.empty((3, 20))
    fuse(joints, deviations, rays, expected, SETTINGS, fused, weights)
    for joint in range(20):
        seen = np.isfinite(joints[:, joint]).all(axis=1)
        along = rays[seen, joint, :, None] * rays[seen, joint, None, :]
        squares = np.square(deviations[seen, joint])[:, None, None]
        covariances = squares * (np.eye(3) + (SETTINGS.along_factor**2 - 1.0) * along)
        points = joints[seen, joint]
        if seen.sum() > 1 and np.isfinite(expected[joint]).all():
            points = np.concatenate((points, expected[joint][None]))
            by_past = SETTINGS.expected_m**2 * np.eye(3)
            covariances = np.concatenate((covariances, by_past[None]))
        if not seen.any():
            assert np.isnan(fused[joint]).all()
            continue
        np.testing.assert_allclose(fused[joint], fused_by_definition(points, covariances))
        assert (weights[seen, joint] > 0.0).all()
        assert (weights[~seen, joint] == 0.0).all()


def test_the_mean_distance_is_that_of_joints_that_both_have() -> None:
    one, other = np.zeros((3, 3)), np.ones((3, 3))
    one[2], other[0, 1] = np.nan, np.nan
    assert mean_distance(one, other, np.arange(3)) == pytest.approx(np.sqrt(3.0))
    assert mean_distance(one, other, np.array([2, 2, 2])) == np.inf
