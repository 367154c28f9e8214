import numpy as np
import pytest
from inhand_tracker.geometry.arrays import Bytes
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.image import Image
from inhand_tracker.sight.frame import prepare
from inhand_tracker.sight.light import light_gains, light_tint, under_white_light
from inhand_tracker.sight.parameters import DEFAULT_SIGHT

CAMERA = Intrinsics(300.0, 300.0, 159.5, 119.5, 320, 240)
LIGHTS = ((0.85, 1.0, 1.15), (1.15, 1.0, 0.85), (1.1, 0.95, 1.0))


def room(seed: int = 0, gains: tuple[float, ...] = (1.0, 1.0, 1.0)) -> Image:
    """A picture of many things of muted colours, in a light."""
    random = np.random.default_rng(seed)
    shades = random.uniform(60.0, 180.0, (12, 16, 1)) + random.normal(0.0, 15.0, (12, 16, 3))
    colour = np.kron(shades, np.ones((20, 20, 1))) * np.array(gains)
    return with_colour(np.clip(np.rint(colour), 0, 255).astype(np.uint8))


def with_colour(colour: Bytes) -> Image:
    return Image(None, CAMERA, None, colour)


@pytest.mark.parametrize("gains", LIGHTS)
def test_the_tint_changes_as_the_light_does(gains: tuple[float, ...]) -> None:
    red, green, blue = np.log(gains)
    changed = light_tint(room(gains=gains)) - light_tint(room())
    np.testing.assert_allclose(changed, [red - green, blue - green], atol=0.02)


def test_brightness_is_no_tint() -> None:
    darker = light_tint(room(gains=(0.8, 0.8, 0.8)))
    np.testing.assert_allclose(darker, light_tint(room()), atol=0.01)


@pytest.mark.parametrize("gains", LIGHTS[:2])
def test_colours_in_bluer_and_redder_light_become_those_of_the_usual_light(
    gains: tuple[float, ...],
) -> None:
    usual, lit = prepare(room()).colour, prepare(room(gains=gains)).colour
    assert usual is not None
    assert lit is not None
    ratios = np.log(lit.reshape(-1, 3).mean(axis=0) / usual.reshape(-1, 3).mean(axis=0))
    assert np.abs(ratios).max() < 0.04


def test_one_wide_and_colourful_wall_tints_little() -> None:
    image = room()
    assert image.colour is not None
    painted = image.colour.copy()
    painted[:, :160] = (190, 60, 60)
    changed = light_gains(with_colour(painted), DEFAULT_SIGHT) / light_gains(room(), DEFAULT_SIGHT)
    assert np.abs(np.log(changed)).max() < 0.09


@pytest.mark.parametrize("level", [0, 128, 255])
def test_a_picture_of_one_grey_stays_as_it_is(level: int) -> None:
    colour = np.full((240, 320, 3), level, np.uint8)
    gains = light_gains(with_colour(colour), DEFAULT_SIGHT)
    np.testing.assert_allclose(under_white_light(colour, gains), colour, atol=3)


def test_a_part_is_seen_in_the_light_of_the_whole_picture() -> None:
    whole, part = prepare(room()), prepare(room(), (40.0, 40.0, 120.0, 100.0))
    assert whole.colour is not None
    np.testing.assert_array_equal(part.colour, whole.colour[40:100, 40:120])
