import numpy as np
from inhand_tracker.sight.kernels.score_colours import score_colours


def test_scores_are_those_of_the_definition() -> None:
    random = np.random.default_rng(0)
    bins = random.integers(0, 7, (9, 11)).astype(np.uint16)
    limbs = random.integers(0, 2, (9, 11)).astype(np.uint8)
    table = random.normal(size=(7, 2)).astype(np.float32)
    scores = np.empty((9, 11, 2), np.float32)
    score_colours(bins, limbs, table, 0.25, scores)
    plain = table[bins]
    against = (limbs == 1) & (plain[..., 0] < plain[..., 1])
    np.testing.assert_allclose(scores, np.where(against[..., None], 0.25, 1.0) * plain)
