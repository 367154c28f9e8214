"""Weights that sum to 1, and particles that survive by them."""

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given
from hypothesis.extra.numpy import arrays
from inhand_tracker.geometry.weights import normalised_weights, systematic_resample


def test_log_weights_become_shares() -> None:
    weights = normalised_weights(np.log([1.0, 3.0, 4.0]))
    np.testing.assert_allclose(weights, [0.125, 0.375, 0.5])


@given(arrays(float, 7, elements=st.floats(-1e6, 0.0)))
def test_weights_sum_to_one_however_small_they_are(log_weights: np.ndarray) -> None:
    weights = normalised_weights(log_weights)
    assert weights.sum() == pytest.approx(1.0)
    assert (weights >= 0).all()
    assert weights[np.argmax(log_weights)] == weights.max()


@given(
    arrays(float, st.integers(1, 60), elements=st.floats(0, 1)).filter(lambda w: w.sum() > 1e-3),
    st.integers(0, 1000),
)
def test_every_particle_survives_about_as_often_as_its_weight_says(
    weights: np.ndarray, seed: int
) -> None:
    shares = weights / weights.sum()
    chosen = systematic_resample(shares, np.random.default_rng(seed))
    assert len(chosen) == len(weights)
    counts = np.bincount(chosen, minlength=len(weights))
    assert len(counts) == len(weights)
    expected = len(weights) * shares
    assert (counts >= np.floor(expected - 1e-9)).all()
    assert (counts <= np.ceil(expected + 1e-9)).all()


def test_resampling_is_fair() -> None:
    weights = np.array([0.05, 0.45, 0.1, 0.4])
    random = np.random.default_rng(5)
    counts = np.zeros(4)
    for _ in range(4000):
        counts += np.bincount(systematic_resample(weights, random), minlength=4)
    np.testing.assert_allclose(counts / 16_000, weights, atol=0.01)


class _Fixed:
    """A generator that gives one number."""

    def __init__(self, value: float) -> None:
        self._value = value

    def random(self) -> float:
        return self._value


@pytest.mark.parametrize("count", [1, 2, 100, 1000])
@pytest.mark.parametrize("value", [0.0, 0.5, np.nextafter(1.0, 0.0)])
def test_resampling_stays_in_range_for_every_random_number(count: int, value: float) -> None:
    chosen = systematic_resample(np.full(count, 1.0 / count), _Fixed(value))
    assert chosen.min() >= 0
    assert chosen.max() < count


def test_particles_without_weight_do_not_survive() -> None:
    for value in (0.0, 0.3, 0.999):
        chosen = systematic_resample(np.array([0.0, 0.5, 0.0, 0.5, 0.0]), _Fixed(value))
        assert set(chosen.tolist()) == {1, 3}
