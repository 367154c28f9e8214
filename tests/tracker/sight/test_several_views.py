"""Poses refined by what several cameras see of them at once."""

import numpy as np
import pytest
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.placement import HERE, Placement
from inhand_tracker.sight.refinement import PosePrior
from inhand_tracker.sight.sight import Sight
from inhand_tracker.sight.view import PlacedView
from people import quaternion_of
from scipy.spatial.transform import Rotation
from sights import PLACE, TURN, appearance, draw, scattered, sight, view_of

NEAR = (1e-6, 1e-6)
"""Metres and radians within which poses of which each goes on are."""
PRIOR_INFORMATION = np.diag([1.0 / 0.03**2] * 3 + [1.0 / 0.15**2] * 3)


def aside(degrees: float) -> Placement:
    """view_from_reference of a camera that looks at the box from so far aside."""
    turn = Rotation.from_euler("y", degrees, degrees=True)
    return Placement(PLACE - turn.apply(PLACE), quaternion_of(turn))


def seen_from(eyes: Sight, place: Placement, sharpness: float = 1.0) -> PlacedView:
    """A view of the box by a camera elsewhere, of which the box is where the first one has it."""
    pose = place.poses(PLACE, TURN)
    image = draw(*pose, returns_depth=False)
    return PlacedView(view_of(eyes, image), place, sharpness)


def prior_about(poses: tuple[np.ndarray, np.ndarray]) -> PosePrior:
    return PosePrior(*poses, np.tile(PRIOR_INFORMATION, (len(poses[0]), 1, 1)))


def test_where_poses_are_of_does_not_matter() -> None:
    eyes, place = sight(learned=appearance()), aside(40.0)
    view = view_of(eyes, draw())
    starts = scattered(6, 0.02, 6.0)
    alone = eyes.refine(*starts, view, prior_about(starts), 0.3)
    # The same poses, seen from elsewhere, and the same view, which now is not of that place.
    moved = place.poses(*starts)
    placed = PlacedView(view, place.inverse())
    together, kept = eyes.refine_together(*moved, [placed], prior_about(moved), 0.3, NEAR)
    assert kept.tolist() == list(range(6))
    back = place.inverse().poses(together.translations, together.rotations)
    np.testing.assert_allclose(back[0], alone.translations, atol=1e-6)
    assert rotations.angle_between(back[1], alone.rotations).max() < 1e-5
    turn = rotations.to_matrix(place.rotation)
    both = np.kron(np.eye(2), turn)
    expected = both @ alone.information @ both.T
    scale = np.abs(expected).max()
    np.testing.assert_allclose(together.information, expected, atol=1e-5 * scale)
    np.testing.assert_allclose(together.log_likelihoods, alone.log_likelihoods, rtol=1e-5)


def test_two_cameras_without_depth_know_how_far_away_a_thing_is() -> None:
    eyes = sight(learned=appearance(returns_depth=False))
    first = seen_from(eyes, HERE)
    starts = scattered(12, 0.03, 5.0)
    off = {}
    for name, views in {"one": [first], "two": [first, seen_from(eyes, aside(75.0))]}.items():
        refined, kept = eyes.refine_together(*starts, views, prior_about(starts), 0.15, NEAR)
        off[name] = np.linalg.norm(refined.translations - PLACE, axis=1).mean()
        assert len(kept) == 12
    assert off["two"] < 0.5 * off["one"]


def test_a_view_counts_by_its_sharpness() -> None:
    eyes, starts = sight(learned=appearance()), scattered(1, 0.0, 0.0)
    whole, hardly = (
        eyes.refine_together(
            *starts, [seen_from(eyes, HERE, sharpness)], prior_about(starts), 0.15, NEAR
        )[0]
        for sharpness in (1.0, 0.01)
    )
    assert np.trace(hardly.information[0]) < 0.1 * np.trace(whole.information[0])
    assert hardly.log_likelihoods == pytest.approx(0.01 * whole.log_likelihoods, rel=0.2)


def test_of_poses_that_come_together_one_goes_on() -> None:
    eyes = sight(learned=appearance())
    starts = scattered(5, 0.01, 3.0)
    views = [PlacedView(view_of(eyes, draw()), HERE)]
    refined, kept = eyes.refine_together(*starts, views, prior_about(starts), 0.3, (0.03, 0.3))
    assert kept.tolist() == [0]
    assert np.linalg.norm(refined.translations[0] - PLACE) < 0.005


def test_no_more_than_four_views_are_taken() -> None:
    eyes, starts = sight(learned=appearance()), scattered(1, 0.0, 0.0)
    view = PlacedView(view_of(eyes, draw()), HERE)
    with pytest.raises(ValueError, match="by 1 to 4 views, not by 5"):
        eyes.refine_together(*starts, [view] * 5, prior_about(starts), 1.0, NEAR)
