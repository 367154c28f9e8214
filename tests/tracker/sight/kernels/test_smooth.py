import numpy as np
from inhand_tracker.sight.kernels.smooth import smooth
from scipy.ndimage import correlate1d

LEVELS = 5


def test_each_level_gives_its_neighbours_their_share_along_every_axis() -> None:
    histogram = np.random.default_rng(2).random(LEVELS**3).astype(np.float32)
    expected = histogram.reshape(LEVELS, LEVELS, LEVELS).astype(float)
    for axis in range(3):
        expected = correlate1d(expected, np.array([0.3, 1.0, 0.3]) / 1.6, axis, mode="nearest")
    smoothed = np.empty_like(histogram)
    smooth(histogram, LEVELS, 0.3, smoothed)
    np.testing.assert_allclose(smoothed, expected.ravel(), rtol=1e-5)
