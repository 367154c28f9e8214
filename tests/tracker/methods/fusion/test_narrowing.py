"""Hypotheses that come closer to what an image shows, by a likelihood that is known."""

from dataclasses import replace

import numpy as np
import pytest
from gaussian_sight import TRUE, GaussianSight, View, alone
from inhand_tracker.geometry.bounding_sphere import BoundingSphere
from inhand_tracker.geometry.pose_gaussian import PoseGaussian
from inhand_tracker.methods.fusion.narrowing import Hypotheses, narrow
from inhand_tracker.methods.fusion.parameters import DEFAULT_FUSION
from inhand_tracker.methods.fusion.posterior import ImagePosterior
from inhand_tracker.sight.view import PlacedView

WIDE = PoseGaussian(
    TRUE.centre + np.array([0.2, -0.1, 0.15]),
    TRUE.rotation,
    np.diag([0.25**2] * 3 + [0.8**2] * 3),
)


def narrowed(rounds: int, seed: int) -> tuple[Hypotheses, Hypotheses]:
    """The hypotheses before and after some rounds."""
    random = np.random.default_rng(seed)
    parameters = replace(DEFAULT_FUSION, narrowing_rounds=rounds)
    sphere, views = BoundingSphere(np.zeros(3), 0.1), (PlacedView(View(None, None)),)
    posterior = ImagePosterior(GaussianSight(), sphere, views, alone(WIDE), 1.0, parameters)
    poses = alone(WIDE).sample(DEFAULT_FUSION.hypotheses, random)
    first = Hypotheses(*poses, posterior.scores(*poses)[0])
    return first, narrow(posterior, first, random)


def away(hypotheses: Hypotheses) -> float:
    best = hypotheses.best(1)
    return float(np.linalg.norm(best.centres[0] - TRUE.centre))


def test_three_rounds_come_more_than_twice_as_close() -> None:
    distances = [list(map(away, narrowed(3, seed))) for seed in range(10)]
    before, after = np.median(distances, axis=0)
    assert after < 0.5 * before


def test_without_rounds_hypotheses_stay_as_they_are() -> None:
    first, after = narrowed(0, 1)
    assert after is first


def test_each_round_adds_its_number_of_hypotheses() -> None:
    first, after = narrowed(2, 1)
    added = 2 * DEFAULT_FUSION.narrowed_hypotheses
    assert len(after.scores) == len(first.scores) + added


@pytest.mark.parametrize("count", [1, 5])
def test_the_best_are_those_of_the_highest_scores(count: int) -> None:
    first, _ = narrowed(0, 2)
    expected = np.sort(first.scores)[-count:]
    np.testing.assert_array_equal(np.sort(first.best(count).scores), expected)
