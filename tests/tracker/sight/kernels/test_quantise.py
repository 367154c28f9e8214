import numpy as np
from inhand_tracker.sight.kernels.quantise import quantise


def test_bins_are_those_of_the_definition() -> None:
    colour = np.random.default_rng(0).integers(0, 256, (9, 11, 3)).astype(np.uint8)
    bins = np.empty((9, 11), np.uint16)
    quantise(colour, bins)
    np.testing.assert_array_equal(bins, (colour // 16).astype(int) @ [256, 16, 1])
