from dataclasses import replace

import numpy as np
import pytest
from inhand_tracker.sight.appearance import learn_appearance
from inhand_tracker.sight.colours import Colours, colour_bins, log_odds_by_colour
from inhand_tracker.sight.light import surrounding_tint
from rooms import JOINTS, REDDER, USUAL, narrow, room
from sights import CAMERA, PLACE, RED, TURN, WALL, box, draw

ELBOW, WRIST, HAND = 9, 10, 11
SKIN = (220, 180, 150)
AHEAD = np.array([0.0, 0.0, 1.2])


def odds_of(learned: object, colour: tuple[int, int, int], shade: float = 1.0) -> float:
    pixel = (shade * np.array(colour)).astype(np.uint8)
    (row,) = colour_bins(np.broadcast_to(pixel, (1, 1, 3)).copy())
    odds = log_odds_by_colour(Colours(learned.of_object, learned.around))  # type: ignore[attr-defined]
    return float(odds[row[0]])


def test_the_objects_colours_and_those_around_it_are_told_apart() -> None:
    learned = learn_appearance(box(), [(draw(), PLACE, TURN, None)])
    assert learned is not None
    assert odds_of(learned, RED, 0.85) > 1.0
    assert odds_of(learned, WALL) < -1.0
    assert learned.of_object.sum() == pytest.approx(1.0, abs=1e-4)


@pytest.mark.parametrize(("returns_depth", "share"), [(True, 1.0), (False, 0.0)])
def test_how_often_depth_is_measured_is_learned(returns_depth: bool, share: float) -> None:
    learned = learn_appearance(box(), [(draw(returns_depth=returns_depth), PLACE, TURN, None)])
    assert learned is not None
    assert learned.returned == pytest.approx(share, abs=0.05)
    assert learned.behind == pytest.approx(0.0, abs=0.05)


def test_what_shines_through_is_learned_as_well() -> None:
    image = draw()
    through = replace(image, depth=np.full((480, 640), 2.0, np.float32))
    learned = learn_appearance(box(), [(through, PLACE, TURN, None)])
    assert learned is not None
    assert learned.returned == pytest.approx(0.0, abs=0.02)
    assert learned.behind == pytest.approx(1.0, abs=0.02)


def test_what_something_nearer_covers_is_not_the_object() -> None:
    image = draw()
    assert image.colour is not None
    assert image.depth is not None
    colour, depth = image.colour.copy(), image.depth.copy()
    column = int(CAMERA.project(PLACE)[0])
    colour[:, column:], depth[:, column:] = (60, 60, 220), 0.6
    learned = learn_appearance(
        box(), [(replace(image, colour=colour, depth=depth), PLACE, TURN, None)]
    )
    assert learned is not None
    assert odds_of(learned, (60, 60, 220)) < 0.0
    assert learned.returned == pytest.approx(1.0, abs=0.05)


def test_fingers_over_the_object_do_not_become_its_colour() -> None:
    image, joints = draw(), np.full((20, 3), np.nan)
    joints[[ELBOW, WRIST, HAND]] = PLACE + np.array(
        [[-0.35, 0.0, 0.0], [-0.1, 0, 0], [-0.05, 0, 0]]
    )
    assert image.colour is not None
    colour = image.colour.copy()
    column, row = np.rint(CAMERA.project(PLACE)).astype(int)
    # A forearm from the left, and its hand over a part of the object.
    colour[row - 22 : row + 22, column - 170 : column] = SKIN
    held = replace(image, colour=colour, depth=None)
    with_joints, without = (
        learn_appearance(box(), [(held, PLACE, TURN, known)]) for known in (joints, None)
    )
    assert with_joints is not None
    assert without is not None
    assert odds_of(with_joints, SKIN) < odds_of(without, SKIN) - 0.5
    assert odds_of(with_joints, RED, 0.85) > 1.0


def test_the_light_of_the_images_is_learned_with_how_much_it_varies() -> None:
    images = [room(light=light) for light in (USUAL, USUAL, REDDER)]
    learned = learn_appearance(box(), [(image, AHEAD, TURN, JOINTS) for image in images])
    assert learned is not None
    tints = [surrounding_tint(image, JOINTS) for image in images]
    assert learned.tint == pytest.approx(np.mean(tints))
    assert learned.tint_range == pytest.approx(max(tints) - np.mean(tints))
    without = learn_appearance(box(), [(narrow(images[0]), AHEAD, TURN, JOINTS)])
    assert without is not None
    assert np.isnan([without.tint, without.tint_range]).all()


def test_nothing_is_learned_without_colours_or_out_of_the_image() -> None:
    image = draw()
    assert learn_appearance(box(), []) is None
    assert learn_appearance(box(), [(replace(image, colour=None), PLACE, TURN, None)]) is None
    for place in (np.array([5.0, 0.0, 1.0]), np.array([0.0, 0.0, -1.0])):
        assert learn_appearance(box(), [(image, place, TURN, None)]) is None
