"""Sums that leak."""

import numpy as np
from inhand_lab.geometry.recursion import leaky_sum
from scipy.signal import lfilter


def test_a_leaky_sum_is_a_filter_of_first_order() -> None:
    values, before = np.random.default_rng(0).normal(size=(50, 3)), np.array([1.0, -2.0, 0.5])
    expected, _ = lfilter([1.0], [1.0, -0.9], values, axis=0, zi=0.9 * before[None])
    assert np.allclose(leaky_sum(values, 0.9, before), expected)
