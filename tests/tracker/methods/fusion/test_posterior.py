"""Poses judged by an image and a belief, both of which are known."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from gaussian_sight import TRUE, GaussianSight, View, alone, pose
from inhand_tracker.geometry.bounding_sphere import BoundingSphere
from inhand_tracker.geometry.pose_gaussian import PoseGaussian, PoseMixture
from inhand_tracker.methods.fusion.parameters import DEFAULT_FUSION, FusionParameters
from inhand_tracker.methods.fusion.posterior import ImagePosterior
from inhand_tracker.sight.refinement import PosePrior, Refined
from inhand_tracker.sight.view import PlacedView

WIDE = PoseGaussian(TRUE.centre, TRUE.rotation, np.diag([0.2**2] * 3 + [0.5**2] * 3))
ELSEWHERE = replace(WIDE, centre=TRUE.centre + np.array([1.0, 0.0, 0.0]))
SIGHT = GaussianSight(bonus=5.0)


def posterior(
    *parts: PoseGaussian,
    sight: GaussianSight = SIGHT,
    sharpness: float = 1.0,
    parameters: FusionParameters = DEFAULT_FUSION,
) -> ImagePosterior:
    belief = PoseMixture(parts, np.full(len(parts), 1.0 / len(parts)))
    sphere = BoundingSphere(np.zeros(3), 0.1)
    return ImagePosterior(
        sight, sphere, (PlacedView(View(None, None)),), belief, sharpness, parameters
    )


@pytest.mark.parametrize("sharpness", [1.0, 0.25])
def test_a_score_is_the_belief_and_the_tempered_image(sharpness: float) -> None:
    poses = alone(TRUE).sample(10, np.random.default_rng(0))
    scores, seen = posterior(WIDE, sharpness=sharpness).scores(*poses)
    np.testing.assert_allclose(seen, SIGHT.log_likelihood(*poses, View(None, None)))
    tempered = DEFAULT_FUSION.image_temper * sharpness * seen
    np.testing.assert_allclose(scores, tempered + alone(WIDE).log_densities(*poses)[0])


def test_starts_that_lead_to_one_place_give_one_mode() -> None:
    starts = alone(WIDE).sample(5, np.random.default_rng(1))
    (mode,), seen = posterior(WIDE).modes(*starts)
    np.testing.assert_allclose(mode.centre, TRUE.centre)
    np.testing.assert_allclose(seen, 5.0)
    kept = DEFAULT_FUSION.refinement_temper
    information = np.linalg.inv(WIDE.covariance) + kept * np.linalg.inv(TRUE.covariance)
    np.testing.assert_allclose(mode.covariance, np.linalg.inv(information), rtol=1e-9)


def test_each_start_is_refined_with_the_part_of_the_belief_that_it_is_near() -> None:
    starts = np.stack((WIDE.centre, ELSEWHERE.centre)), np.tile(TRUE.rotation, (2, 1))
    parameters = replace(DEFAULT_FUSION, refines=False)
    narrow = replace(ELSEWHERE, covariance=0.01 * WIDE.covariance)
    modes, _ = posterior(narrow, WIDE, parameters=parameters).modes(*starts)
    assert [one.covariance[0, 0] for one in modes] == pytest.approx([0.0004, 0.04])
    np.testing.assert_allclose([one.centre[0] for one in modes], TRUE.centre[0] + [1.0, 0.0])


@pytest.mark.parametrize(("apart_m", "count"), [(0.009, 1), (0.011, 2)])
def test_poses_no_farther_apart_than_a_centimetre_are_the_same(apart_m: float, count: int) -> None:
    centres = TRUE.centre + np.array([[0.0, 0.0, 0.0], [apart_m, 0.0, 0.0]])
    one = posterior(WIDE, sight=GaussianSight(refines=False))
    assert len(one.modes(centres, np.tile(TRUE.rotation, (2, 1)))[0]) == count


def test_a_mode_weighs_by_its_height_and_its_volume() -> None:
    """Laplace's approximation: of two as likely, one of twice the width in a direction weighs
    twice as much."""
    narrow, wide = (
        PoseGaussian(TRUE.centre, TRUE.rotation, np.diag([scale, 1, 1, 1, 1, 1]))
        for scale in (1, 4)
    )
    mixture = posterior(WIDE).weigh([narrow, wide], np.full(2, 5.0))
    np.testing.assert_allclose(mixture.weights, [1 / 3, 2 / 3])


def test_the_likelier_of_two_modes_weighs_more() -> None:
    farther = replace(WIDE, centre=TRUE.centre + np.array([0.03, 0.0, 0.0]))
    near, off = (replace(one, covariance=WIDE.covariance) for one in (TRUE, farther))
    one = posterior(WIDE)
    scores, seen = np.hstack([one.scores(*pose(mode)) for mode in (near, off)])
    mixture = one.weigh([near, off], seen)
    assert np.log(mixture.weights[0] / mixture.weights[1]) == pytest.approx(scores[0] - scores[1])


class FirstStart(GaussianSight):
    """A sight whose refinement by several views brings all poses to the first one."""

    def refine_together(
        self,
        origins: np.ndarray,
        turns: np.ndarray,
        views: Sequence[PlacedView],
        prior: PosePrior,
        trust: float,
        near: tuple[float, float],
    ) -> tuple[Refined, np.ndarray]:
        one = self.refine(origins[:1], turns[:1], views[0].view, prior, trust)
        whole = replace(one, log_likelihoods=len(views) * one.log_likelihoods)
        return whole, np.zeros(1, int)


@pytest.mark.parametrize("thorough", [True, False])
def test_a_likelier_start_is_a_mode_where_several_views_are_searched_thoroughly(
    thorough: bool,
) -> None:
    view = PlacedView(View(None, None))
    one = posterior(WIDE, sight=FirstStart(bonus=5.0, refines=False))
    one = replace(one, views=(view, view), thorough=thorough)
    off = TRUE.centre + np.array([0.05, 0.0, 0.0])
    starts = np.stack((off, TRUE.centre)), np.tile(TRUE.rotation, (2, 1))
    modes, seen = one.modes(*starts)
    centres = [off, TRUE.centre] if thorough else [off]
    np.testing.assert_allclose([mode.centre for mode in modes], centres)
    assert (seen[-1] == pytest.approx(10.0)) == thorough
    assert len(one.modes(starts[0][::-1], starts[1])[0]) == 1
