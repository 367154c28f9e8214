import numpy as np
from inhand_tracker.sight.kernels.count import count


def test_counts_are_added_to_those_of_the_definition() -> None:
    random = np.random.default_rng(0)
    bins = random.integers(0, 7, (9, 11)).astype(np.uint16)
    weights = random.random((9, 11)).astype(np.float32)
    counts = np.ones(7, np.float32)
    count(bins, weights, counts)
    np.testing.assert_allclose(counts, 1.0 + np.bincount(bins.ravel(), weights.ravel()), rtol=1e-5)
