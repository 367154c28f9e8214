"""The filter of a Kinect's skeletons."""

import numpy as np
from inhand_lab.sensing.skeleton_filter import smooth
from inhand_lab.sensing.skeleton_noise_parameters import SkeletonFilter

FILTER = SkeletonFilter()


def test_the_filter_follows_a_leap_at_once_and_holds_a_tremble() -> None:
    leap = np.zeros((20, 1, 3))
    leap[10:] = 0.5
    sure = np.zeros((20, 1))
    assert np.linalg.norm(smooth(leap, sure, FILTER)[10, 0] - leap[10, 0]) < 0.05
    tremble = 0.003 * np.random.default_rng(0).normal(size=(600, 1, 3))
    filtered = smooth(tremble, np.zeros((600, 1)), FILTER)
    assert np.std(np.diff(filtered, axis=0)) < 0.1 * np.std(np.diff(tremble, axis=0))


def test_the_filter_lags_behind_a_steady_movement_by_centimetres() -> None:
    steady = np.linspace(0.0, 1.0, 60)[:, None, None] * np.ones(3)
    lag = np.linalg.norm(smooth(steady, np.zeros((60, 1)), FILTER) - steady, axis=2)
    assert lag[30:].max() < 0.04
    assert lag[30:].min() < 0.03
