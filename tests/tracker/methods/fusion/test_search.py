"""The search in an image whose likelihood is known."""

import math
from dataclasses import replace

import numpy as np
import pytest
from gaussian_sight import TRUE, GaussianSight
from inhand_tracker.geometry.bounding_sphere import BoundingSphere
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.image import Image
from inhand_tracker.geometry.pose_gaussian import PoseGaussian, PoseMixture
from inhand_tracker.methods.fusion.parameters import DEFAULT_FUSION, FusionParameters
from inhand_tracker.methods.fusion.search import ImageSearch
from inhand_tracker.sight.light import surrounding_tint
from people import STANDING
from rooms import BLUER, JOINTS, USUAL, room

CAMERA = Intrinsics(260.0, 260.0, 159.5, 119.5, 320, 240)
BLANK = Image(None, CAMERA, None, np.zeros((240, 320, 3), np.uint8))
AWAY = np.array([0.10, 0.05, -0.08])
SPHERE = BoundingSphere(np.zeros(3), 0.1)


def belief(centre: np.ndarray) -> PoseMixture:
    part = PoseGaussian(centre, TRUE.rotation, np.diag([0.1**2] * 3 + [0.3**2] * 3))
    return PoseMixture((part,), np.ones(1))


def search(sight: GaussianSight, parameters: FusionParameters = DEFAULT_FUSION) -> ImageSearch:
    return ImageSearch(sight, SPHERE, parameters, seed=1)


def looked(
    sight: GaussianSight,
    parameters: FusionParameters = DEFAULT_FUSION,
    *,
    sharpness: float = 1.0,
    off: np.ndarray = AWAY,
) -> PoseGaussian:
    pose = search(sight, parameters).look(belief(TRUE.centre + off), BLANK, STANDING, sharpness)
    assert pose is not None
    return pose


def away(pose: PoseGaussian) -> float:
    return float(np.linalg.norm(pose.centre - TRUE.centre))


def test_the_pose_goes_where_the_image_is_likeliest() -> None:
    assert away(looked(GaussianSight())) < 0.01
    assert away(looked(GaussianSight(refines=False))) < 0.5 * np.linalg.norm(AWAY)


def test_a_smear_counts_less_than_a_sharp_image() -> None:
    sharp, blurred = (
        looked(GaussianSight(refines=False), sharpness=sharpness) for sharpness in (1.0, 0.01)
    )
    assert away(sharp) < away(blurred)
    assert np.trace(sharp.covariance) < np.trace(blurred.covariance)


def test_an_image_counts_by_its_temper_and_never_for_nothing() -> None:
    sight = GaussianSight()
    for sharpness in (1.0, 0.5, 0.0):
        looked(sight, sharpness=sharpness)
    temper = DEFAULT_FUSION.image_temper
    assert sight.trusts == pytest.approx([temper, 0.5 * temper, 1e-3 * temper])


def weighed_with(effort: float, parameters: FusionParameters = DEFAULT_FUSION) -> int:
    sight = GaussianSight()
    search(sight, parameters).look(belief(TRUE.centre), BLANK, STANDING, 1.0, effort)
    return sight.weighed


def test_less_effort_tries_fewer_hypotheses_but_never_too_few() -> None:
    whole, half, least = (weighed_with(effort) for effort in (1.0, 0.5, 1e-3))
    assert half == pytest.approx(0.5 * whole, abs=2)
    assert least == DEFAULT_FUSION.fewest_hypotheses
    few = replace(DEFAULT_FUSION, hypotheses=10)
    assert weighed_with(1e-3, few) == weighed_with(1.0, few) == 10


def test_without_refinement_poses_stay_hypotheses() -> None:
    parameters = replace(DEFAULT_FUSION, refines=False)
    assert 0.0 < away(looked(GaussianSight(), parameters)) < np.linalg.norm(AWAY)


@pytest.mark.parametrize(
    "centre", [[0.0, 0.0, -1.5], [5.0, 0.0, 1.5], [0.0, -5.0, 1.5], [np.nan, 0.0, 1.5]]
)
def test_an_object_out_of_the_image_is_not_looked_for(centre: list[float]) -> None:
    sight = GaussianSight()
    one = search(sight)
    assert one.look(belief(np.array(centre)), BLANK, STANDING, 1.0) is None
    assert one.support is None
    assert sight.weighed == 0


def test_colours_are_learned_where_the_image_supports_the_pose_only() -> None:
    certain, doubtful = GaussianSight(bonus=20.0), GaussianSight(bonus=2.9)
    for sight in (certain, doubtful):
        looked(sight)
    assert len(certain.learned) == 1
    assert np.linalg.norm(certain.learned[0] - TRUE.centre) < 1e-9
    assert doubtful.learned == []


def test_the_support_is_that_of_the_likeliest_pose_by_the_colours_of_training() -> None:
    one = search(GaussianSight(bonus=20.0))
    one.look(belief(TRUE.centre), BLANK, STANDING, 1.0)
    assert one.support is not None
    assert one.support.parts == pytest.approx([2.0, 4.0, 6.0, 8.0])
    assert one.support.log_likelihood == pytest.approx(20.0)
    assert one.support.recoloured == 0.0
    one.look(belief(TRUE.centre), BLANK, STANDING, 1.0)
    assert one.support.parts == pytest.approx([2.0, 4.0, 6.0, 8.0])
    assert one.support.recoloured == pytest.approx(1.0)


def test_the_same_seed_looks_at_the_same_hypotheses() -> None:
    first, second = (looked(GaussianSight(refines=False)) for _ in range(2))
    np.testing.assert_array_equal(first.centre, second.centre)


@pytest.mark.parametrize(("radius_m", "coarse"), [(0.1, True), (0.6, False)])
def test_where_an_object_may_be_anywhere_it_is_looked_for_coarsely_a_large_one_is_not(
    radius_m: float, coarse: bool
) -> None:
    sight, parameters = GaussianSight(), replace(DEFAULT_FUSION, most_pixels=10_000)
    sphere = BoundingSphere(np.zeros(3), radius_m)
    ImageSearch(sight, sphere, parameters, seed=1).look(belief(TRUE.centre), BLANK, STANDING, 1.0)
    assert (sight.frames[-1].camera.fx < CAMERA.fx) == coarse


def test_images_in_another_light_are_searched_in_that_of_training() -> None:
    usual = surrounding_tint(room(), JOINTS)
    assert usual is not None
    brightness = []
    for light in (USUAL, BLUER):
        sight = GaussianSight(usual_light=(usual, 0.0))
        search(sight).look(belief(TRUE.centre), room(light=light), JOINTS, 1.0)
        colour = sight.frames[0].colour
        assert colour is not None
        brightness.append(colour.reshape(-1, 3).mean(axis=0))
    np.testing.assert_allclose(brightness[1], brightness[0], rtol=0.03)


def test_images_in_the_light_of_training_are_searched_as_they_are() -> None:
    usual = surrounding_tint(room(), JOINTS)
    assert usual is not None
    looks = []
    for light in ((usual, 0.0), (math.nan, math.nan)):
        sight = GaussianSight(usual_light=light)
        search(sight).look(belief(TRUE.centre), room(), JOINTS, 1.0)
        looks.append(sight.frames[0].colour)
    np.testing.assert_array_equal(*looks)


def median_distance(bonus: float, sharpness: float = 1.0, *, thoroughly: bool = False) -> float:
    """How far off, in metres, the best hypotheses are, in a search without refinement."""
    parameters = replace(DEFAULT_FUSION, refines=False)
    found = [
        ImageSearch(GaussianSight(bonus, refines=False), SPHERE, parameters, seed).look(
            belief(TRUE.centre + 2.0 * AWAY), BLANK, JOINTS, sharpness, thoroughly=thoroughly
        )
        for seed in range(5)
    ]
    return float(np.median([away(one) for one in found if one is not None]))


def test_a_thorough_search_narrows_its_hypotheses_down() -> None:
    assert median_distance(200.0, thoroughly=True) < 0.7 * median_distance(200.0)


def test_a_sharp_image_that_supports_no_pose_is_searched_again() -> None:
    assert median_distance(5.0) == median_distance(5.0, thoroughly=True)
    assert median_distance(5.0, 0.25) > median_distance(5.0, 0.25, thoroughly=True)


def test_with_less_effort_a_thorough_search_tries_fewer_hypotheses_too() -> None:
    weighed = []
    for effort in (1.0, 0.5):
        sight = GaussianSight()
        search(sight).look(belief(TRUE.centre), BLANK, STANDING, 1.0, effort, thoroughly=True)
        weighed.append(sight.weighed)
    assert weighed[1] == pytest.approx(0.5 * weighed[0], abs=4)


def test_an_object_is_looked_for_about_its_centre_though_poses_are_of_a_pivot() -> None:
    """A pivot out of the image: the object itself is in it."""
    sight = GaussianSight()
    sphere = BoundingSphere(np.zeros(3), 0.1, np.array([3.0, 0.0, 0.0]))
    pivot = TRUE.centre + np.array([3.0, 0.0, 0.0])
    sure = PoseGaussian(pivot, TRUE.rotation, np.diag([1e-4] * 6))
    one = ImageSearch(sight, sphere, DEFAULT_FUSION, seed=1)
    assert one.look(PoseMixture((sure,), np.ones(1)), BLANK, STANDING, 1.0) is not None
