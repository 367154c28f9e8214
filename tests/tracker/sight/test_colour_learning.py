import numpy as np
import pytest
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.image import Image
from inhand_tracker.sight.colour_learning import learn_colours
from inhand_tracker.sight.colours import Colours, colour_bins, log_odds_by_colour
from inhand_tracker.sight.frame import prepare
from sights import EXTENTS, RED, WALL, box

CAMERA = Intrinsics(100.0, 100.0, 31.5, 23.5, 64, 48)
POSE = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0, 0.0])


def red_before_a_wall() -> Image:
    colour = np.full((48, 64, 3), WALL, np.uint8)
    colour[12:36, 20:44] = RED
    return Image(None, CAMERA, None, colour)


def share(histogram: np.ndarray | None, colour: tuple[int, int, int]) -> float:
    assert histogram is not None
    return float(histogram[colour_bins(np.full((1, 1, 3), colour, np.uint8))[0, 0]])


def test_both_rates_learn_what_each_learns_alone() -> None:
    frame = prepare(red_before_a_wall())
    own = learn_colours(box(), Colours(), frame, POSE, (0.1, 0.0))
    around = learn_colours(box(), Colours(), frame, POSE, (0.0, 0.3))
    both = learn_colours(box(), Colours(), frame, POSE, (0.1, 0.3))
    assert own.around is None
    assert around.of_object is None
    np.testing.assert_array_equal(both.of_object, own.of_object)
    np.testing.assert_array_equal(both.around, around.around)
    assert share(own.of_object, RED) > 0.1 > 0.01 > share(own.of_object, WALL)
    assert share(around.around, WALL) > 0.05


@pytest.mark.parametrize("rate", [0.1, 0.7])
def test_a_rate_is_the_share_of_the_newest_frame(rate: float) -> None:
    frame, old = prepare(red_before_a_wall()), np.full(4096, 1.0 / 4096, np.float32)
    new = learn_colours(box(), Colours(), frame, POSE, (rate, 0.0)).of_object
    mixed = learn_colours(box(), Colours(of_object=old), frame, POSE, (rate, 0.0)).of_object
    assert new is not None
    assert mixed is not None
    np.testing.assert_allclose(mixed, (1.0 - rate) * old + rate * new, atol=1e-7)


def test_a_colour_that_is_half_the_objects_says_nothing_and_each_sides_own_does() -> None:
    colour = np.full((48, 64, 3), WALL, np.uint8)
    colour[16:32, 27:37] = RED
    frame = prepare(Image(None, CAMERA, None, colour))
    place = np.array([0.0, 0.0, 1.0 + EXTENTS[2] / 2.0]), POSE[1]
    colours = learn_colours(box(), Colours(), frame, place, (0.1, 0.5))
    odds = log_odds_by_colour(colours)[frame.bins]
    rim, inside, outside = odds[24, 26:28], odds[24, 30], odds[24, 20]
    assert inside > 1.0
    assert outside < -1.0
    # The outline is between these two: of one an eighth or a quarter more is the object's.
    assert abs(rim.sum()) < 0.5


def test_no_mixed_colours_are_learned_from_a_pose_that_is_not_trusted() -> None:
    frame = prepare(red_before_a_wall())
    assert learn_colours(box(), Colours(), frame, POSE, (0.0, 0.5)).mixed is None
    mixed = learn_colours(box(), Colours(), frame, POSE, (0.1, 0.5)).mixed
    assert mixed is not None
    assert mixed.shape == (4096, 2)
    assert (mixed.sum(axis=0) < 1.0).all()


def test_nothing_is_learned_without_colour_or_out_of_the_image() -> None:
    colours = Colours()
    grey = prepare(Image(None, CAMERA, np.ones((48, 64), np.float32), None))
    assert learn_colours(box(), colours, grey, POSE, (0.1, 0.1)) is colours
    away = np.array([9.0, 0.0, 1.0]), POSE[1]
    coloured = prepare(red_before_a_wall())
    assert learn_colours(box(), colours, coloured, away, (0.1, 0.1)) is colours
