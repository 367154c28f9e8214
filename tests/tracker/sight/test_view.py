import numpy as np
import pytest
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.image import Image
from inhand_tracker.sight.colours import BINS, Colours, colour_scores, log_odds_by_colour
from inhand_tracker.sight.frame import prepare
from inhand_tracker.sight.view import view_frame

CAMERA = Intrinsics(100.0, 100.0, 31.5, 23.5, 64, 48)


def colours() -> Colours:
    random = np.random.default_rng(0)
    return Colours(*random.dirichlet(np.ones(BINS), 2).astype(np.float32))


def test_each_pixel_is_scored_by_its_colours_bin() -> None:
    image = np.random.default_rng(1).integers(0, 256, (48, 64, 3)).astype(np.uint8)
    frame = prepare(Image(None, CAMERA, None, image))
    view = view_frame(frame, colours())
    assert frame.bins is not None
    np.testing.assert_array_equal(view.colour_scores, colour_scores(colours())[frame.bins])
    assert not view.limbs.any()
    pixels = view.pixels
    np.testing.assert_array_equal(pixels.lens, [100.0, 100.0, 31.5, 23.5])
    assert pixels.edges.shape == (4, 48, 64)
    np.testing.assert_array_equal(pixels.depth, np.zeros((48, 64)))


def test_a_colour_of_the_object_speaks_for_within_and_against_beside() -> None:
    scores, odds = colour_scores(colours()), log_odds_by_colour(colours())
    assert 1000 < (odds > 0.0).sum() < 3000
    np.testing.assert_array_equal(scores[:, 0] > 0.0, odds > 0.0)
    np.testing.assert_array_equal(scores[:, 1] < 0.0, odds > 0.0)
    np.testing.assert_allclose(np.exp(scores).sum(axis=1), 2.0, rtol=1e-5)


@pytest.mark.parametrize("depth", [None, np.ones((48, 64), np.float32)])
def test_a_frame_without_colour_scores_nothing(depth: np.ndarray | None) -> None:
    view = view_frame(prepare(Image(None, CAMERA, depth, None)), colours())
    assert not view.colour_scores.any()
    assert view.pixels.depth.any() == (depth is not None)
