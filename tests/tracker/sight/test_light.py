import math
from dataclasses import replace

import numpy as np
import pytest
from inhand_tracker.geometry.image import Image
from inhand_tracker.sight.frame import prepare
from inhand_tracker.sight.light import LightWatch, scale_colours, surrounding_tint
from inhand_tracker.sight.parameters import DEFAULT_SIGHT
from rooms import BLUER, JOINTS, REDDER, ROOM_CAMERA, USUAL, room, smaller_depth, with_person_in

Light = tuple[float, float, float]


def tint_of(image: Image, joints: np.ndarray | None = JOINTS) -> float:
    tint = surrounding_tint(image, joints)
    assert tint is not None
    return tint


def watch_of(*images: Image, usual: Image | None = None, tint_range: float = 0.0) -> LightWatch:
    """A watch that knows the light of one image, and has seen others."""
    watch = LightWatch((tint_of(usual or room()), tint_range))
    for image in images:
        watch.watch(image, JOINTS)
    return watch


@pytest.mark.parametrize("light", [BLUER, REDDER])
def test_the_tint_changes_as_the_light_does(light: Light) -> None:
    red, _, blue = light
    changed = tint_of(room(light=light)) - tint_of(room())
    assert changed == pytest.approx(0.5 * math.log(red / blue), abs=0.015)


@pytest.mark.parametrize("light", [(0.8, 0.8, 0.8), (0.95, 1.08, 0.95)])
def test_brightness_and_green_are_no_tint(light: Light) -> None:
    assert tint_of(room(light=light)) == pytest.approx(tint_of(room()), abs=0.015)


def test_a_person_s_clothes_are_no_surroundings() -> None:
    usual, red = room(), with_person_in(room(), (180, 60, 60))
    assert tint_of(red, None) > tint_of(usual, None) + 0.005
    for image in (red, smaller_depth(red)):
        assert tint_of(image) == pytest.approx(tint_of(usual), abs=0.002)


def test_one_wide_and_colourful_wall_says_little_more_than_a_cup() -> None:
    usual, cup, wall = room(), room(), room()
    for image, part in ((cup, np.s_[0:20, 0:20]), (wall, np.s_[:, 0:120])):
        assert image.colour is not None
        image.colour[part] = (190, 110, 90)
    by_wall = tint_of(wall, None) - tint_of(usual, None)
    by_cup = tint_of(cup, None) - tint_of(usual, None)
    assert 0.0 < by_cup < by_wall < 0.06


def test_too_little_around_the_person_says_nothing() -> None:
    assert surrounding_tint(replace(room(), colour=None), JOINTS) is None
    assert surrounding_tint(replace(room(), colour=np.zeros((240, 320, 3), np.uint8))) is None
    near = np.full((240, 320), 2.3, np.float32)
    assert surrounding_tint(Image(None, ROOM_CAMERA, near, room().colour), JOINTS) is None


@pytest.mark.parametrize("light", [BLUER, REDDER])
def test_an_image_in_clearly_another_light_is_brought_into_that_of_training(light: Light) -> None:
    image, usual = room(light=light), prepare(room()).colour
    gains = watch_of(image).gains
    lit = prepare(image, gains=gains).colour
    assert usual is not None
    assert lit is not None
    ratios = np.log(lit.reshape(-1, 3).mean(axis=0) / usual.reshape(-1, 3).mean(axis=0))
    assert np.abs(ratios).max() < 0.02


@pytest.mark.parametrize("light", [USUAL, (0.96, 1.0, 1.04), (1.04, 1.0, 0.96)])
def test_an_image_in_the_light_of_training_or_of_nearly_that_stays_as_it_is(light: Light) -> None:
    assert watch_of(room(light=light)).gains is None


def test_another_room_is_no_other_light() -> None:
    assert all(watch_of(room(seed)).gains is None for seed in range(1, 9))


def test_the_more_the_light_differs_the_more_of_it_is_taken_away_without_a_jump() -> None:
    shifts = np.linspace(0.0, 0.2, 101)
    watches = [watch_of(room(light=(np.exp(s), 1.0, np.exp(-s)))) for s in shifts]
    blue = np.array([1.0 if watch.gains is None else watch.gains[2] for watch in watches])
    steps = np.diff(np.log(blue))
    assert (steps > -0.005).all()
    assert steps.max() < 0.04
    assert blue[-1] == pytest.approx(np.exp(0.2), rel=0.03)


def test_what_lies_between_the_lights_of_training_is_none_of_its_own() -> None:
    assert watch_of(room(light=REDDER)).gains is not None
    assert watch_of(room(light=REDDER), tint_range=0.16).gains is None


def test_one_strange_picture_does_not_change_the_light_at_once() -> None:
    same = [room()] * 8
    assert watch_of(*same, room(light=BLUER)).gains is None
    changed = watch_of(*same, *[room(light=BLUER)] * 16).gains
    at_once = watch_of(room(light=BLUER)).gains
    assert changed is not None
    np.testing.assert_allclose(changed, at_once, atol=0.005)


def test_where_training_showed_no_light_images_stay_as_they_are() -> None:
    watch = LightWatch((math.nan, math.nan))
    watch.watch(room(light=BLUER), JOINTS)
    assert watch.gains is None


def test_a_picture_that_says_nothing_leaves_the_light_as_it_was() -> None:
    watch = watch_of(room(light=BLUER))
    before = watch.gains
    watch.watch(replace(room(), colour=None), JOINTS)
    np.testing.assert_array_equal(watch.gains, before)


def test_a_part_is_seen_in_the_light_of_the_whole_picture() -> None:
    gains = np.array([1.2, 1.0, 0.9])
    whole, part = prepare(room(), gains=gains), prepare(room(), (40, 40, 120, 100), gains=gains)
    assert whole.colour is not None
    np.testing.assert_array_equal(part.colour, whole.colour[40:100, 40:120])


def test_colours_are_multiplied_and_bounded() -> None:
    colour = np.array([[[100, 100, 200]]], np.uint8)
    scaled = scale_colours(colour, np.array([0.5, 1.004, 1.5]))
    np.testing.assert_array_equal(scaled, [[[50, 100, 255]]])


def test_lamps_and_daylight_differ_by_more_than_rooms_may() -> None:
    assert DEFAULT_SIGHT.same_light + DEFAULT_SIGHT.light_ramp < 0.5 * math.log(1.15 / 0.85)
