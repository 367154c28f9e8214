"""Kernel ridge regression against dense solutions of what its sources define."""

from dataclasses import replace

import numpy as np
import pytest
from inhand_tracker.prior import kernel_ridge
from inhand_tracker.prior.kernel_ridge import fit, gaussian, squared_distances
from inhand_tracker.prior.parameters import DEFAULT_PRIOR_LEARNING
from scipy.spatial.distance import cdist

ONE_RIDGE = replace(DEFAULT_PRIOR_LEARNING, ridges=(0.1,))


def problem(samples: int = 60, groups: int = 4) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Inputs (N, 3), targets (N, 2) and groups (N,)."""
    random = np.random.default_rng(3)
    inputs = random.normal(size=(samples, 3)).astype(np.float32)
    clean = np.column_stack((np.sin(inputs[:, 0]), inputs[:, 1] * inputs[:, 2] + 5.0))
    targets = (clean + 0.05 * random.normal(size=clean.shape)).astype(np.float32)
    return inputs, targets, np.arange(samples) % groups


def dense(
    inputs: np.ndarray, targets: np.ndarray, landmarks: np.ndarray, offset: np.ndarray
) -> tuple[np.ndarray, float]:
    """Weights and kernel width of the subset of regressors, by its normal equations in double
    precision: (K_nm' K_nm + ridge (K_mm + jitter)) a = K_nm' y."""
    (ridge,), jitter = ONE_RIDGE.ridges, ONE_RIDGE.jitter
    between = cdist(landmarks, landmarks, "sqeuclidean")
    width = DEFAULT_PRIOR_LEARNING.kernel_width**2 * np.median(between)
    small = np.exp(-between / (2 * width)) + jitter * np.eye(len(landmarks))
    tall = np.exp(-cdist(inputs, landmarks, "sqeuclidean") / (2 * width))
    weights = np.linalg.solve(tall.T @ tall + ridge * small, tall.T @ (targets - offset))
    return weights, width


def test_it_is_the_dense_solution() -> None:
    inputs, targets, groups = problem()
    rows = np.arange(0, 60, 3)
    learned, _ = fit(inputs, targets, groups, rows, ONE_RIDGE)
    offset = targets.astype(float).mean(axis=0)
    weights, width = dense(inputs.astype(float), targets.astype(float), inputs[rows], offset)
    assert learned.width == pytest.approx(width)
    asked = np.random.default_rng(5).normal(size=(9, 3)).astype(np.float32)
    expected = np.exp(-cdist(asked, inputs[rows], "sqeuclidean") / (2 * width)) @ weights + offset
    np.testing.assert_allclose(learned.predict(asked), expected, atol=1e-5)


def test_held_out_residuals_are_those_of_a_fit_without_the_group() -> None:
    inputs, targets, groups = problem()
    rows = np.arange(0, 60, 3)
    _, residuals = fit(inputs, targets, groups, rows, ONE_RIDGE)
    offset = targets.astype(float).mean(axis=0)
    for group in range(4):
        kept = groups != group
        weights, width = dense(
            inputs[kept].astype(float), targets[kept].astype(float), inputs[rows], offset
        )
        held_out = np.flatnonzero(groups[rows] == group)
        kernel = np.exp(-cdist(inputs[rows[held_out]], inputs[rows], "sqeuclidean") / (2 * width))
        expected = targets[rows[held_out]] - offset - kernel @ weights
        np.testing.assert_allclose(residuals[held_out], expected, atol=1e-5)


@pytest.mark.parametrize("noise", [0.001, 3.0])
def test_that_ridge_is_taken_which_errs_least_on_groups_that_were_held_out(noise: float) -> None:
    inputs, targets, groups = problem()
    random = np.random.default_rng(7)
    targets += (noise * random.normal(size=targets.shape)).astype(np.float32)
    rows = np.arange(0, 60, 3)
    ridges = (10.0, 0.01)
    both, left = fit(inputs, targets, groups, rows, replace(ONE_RIDGE, ridges=ridges))
    alone = [
        fit(inputs, targets, groups, rows, replace(ONE_RIDGE, ridges=(ridge,))) for ridge in ridges
    ]
    best = int(np.argmin([np.square(residuals).sum() for _, residuals in alone]))
    assert best == (noise < 1.0)
    np.testing.assert_allclose(left, alone[best][1])
    np.testing.assert_allclose(both.coefficients, alone[best][0].coefficients)


def test_chunks_change_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    inputs, targets, groups = problem()
    rows = np.arange(0, 60, 3)
    whole, residuals = fit(inputs, targets, groups, rows, ONE_RIDGE)
    monkeypatch.setattr(kernel_ridge, "CHUNK", 7)
    pieces, same = fit(inputs, targets, groups, rows, ONE_RIDGE)
    np.testing.assert_allclose(pieces.coefficients, whole.coefficients, atol=1e-7)
    np.testing.assert_allclose(same, residuals, atol=1e-7)


def test_far_from_all_that_was_learned_the_mean_is_predicted() -> None:
    inputs, targets, groups = problem()
    learned, _ = fit(inputs, targets, groups, np.arange(0, 60, 3))
    far = np.full((1, 3), 1e3, np.float32)
    np.testing.assert_allclose(learned.kernel(far), 0.0)
    np.testing.assert_allclose(learned.predict(far)[0], targets.astype(float).mean(axis=0))


def test_inputs_that_are_all_equal_give_the_mean() -> None:
    """A person who stands still: no landmark differs from another."""
    inputs = np.ones((20, 3), np.float32)
    targets = np.arange(40.0, dtype=np.float32).reshape(20, 2)
    learned, residuals = fit(inputs, targets, np.arange(20) % 2, np.arange(0, 20, 2))
    np.testing.assert_allclose(learned.predict(inputs[:1])[0], targets.mean(axis=0), rtol=1e-2)
    assert np.isfinite(residuals).all()


def test_a_single_group_leaves_the_mean_as_the_held_out_prediction() -> None:
    inputs, targets, _ = problem()
    rows = np.arange(0, 60, 3)
    _, residuals = fit(inputs, targets, np.zeros(60, np.int64), rows)
    np.testing.assert_allclose(
        residuals, targets[rows] - targets.astype(float).mean(axis=0), atol=1e-6
    )


def test_nearly_equal_inputs_are_at_no_negative_distance() -> None:
    inputs = np.full((2, 60), 1e3, np.float32)
    inputs[1, 0] = np.nextafter(inputs[1, 0], np.float32(2e3))
    distances = squared_distances(inputs, inputs)
    assert (distances >= 0.0).all()
    assert gaussian(inputs, inputs, 1.0).max() <= 1.0
