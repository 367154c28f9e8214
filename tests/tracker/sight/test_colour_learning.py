import numpy as np
import pytest
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.image import Image
from inhand_tracker.sight.colour_learning import learn_colours
from inhand_tracker.sight.colours import Colours, colour_bins
from inhand_tracker.sight.frame import prepare
from sights import RED, WALL, box

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


def test_nothing_is_learned_without_colour_or_out_of_the_image() -> None:
    colours = Colours()
    grey = prepare(Image(None, CAMERA, np.ones((48, 64), np.float32), None))
    assert learn_colours(box(), colours, grey, POSE, (0.1, 0.1)) is colours
    away = np.array([9.0, 0.0, 1.0]), POSE[1]
    coloured = prepare(red_before_a_wall())
    assert learn_colours(box(), colours, coloured, away, (0.1, 0.1)) is colours
