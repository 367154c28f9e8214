import kernel_arrays as arrays
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from inhand_tracker.sight.kernels.mixed_offset import Mixing, mixed_offset

MIXING = Mixing(4.0, 4.5, 40.0, 0.1, 3.0)
WITHIN, BESIDE = np.array([180.0, 40.0, 30.0]), np.array([90.0, 110.0, 120.0])
WIDE = 100.0, 100.0
FINE = 16


def edge(angle: float, offset: float, *, within: np.ndarray = WITHIN) -> np.ndarray:
    """An image, each pixel the mean of what it covers, of a half-plane that ends ``offset`` pixels
    along its normal from the image's middle."""
    rows, columns = (np.indices((FINE * arrays.HEIGHT, FINE * arrays.WIDTH)) + 0.5) / FINE
    across = (columns - arrays.WIDTH / 2) * np.cos(angle) + (rows - arrays.HEIGHT / 2) * np.sin(
        angle
    )
    inside = (across < offset).reshape(arrays.HEIGHT, FINE, arrays.WIDTH, FINE).mean(axis=(1, 3))
    colours = inside[..., None] * within + (1.0 - inside[..., None]) * BESIDE
    return np.rint(colours).astype(np.uint8)


def found(
    image: np.ndarray,
    angle: float,
    sides: tuple[float, float] = WIDE,
    odds: tuple[float, float] = (1.0, -1.0),
) -> tuple[float, float]:
    """Where the outline is found in an image, whose colours have these log-odds where they are
    redder, and where they are not."""
    scores = np.zeros((*image.shape[:2], 2), np.float32)
    scores[..., 0] = np.where(image[..., 0] > 135, *odds)
    pixels = arrays.pixels()._replace(colour=image, colour_scores=scores)
    line = arrays.WIDTH / 2, arrays.HEIGHT / 2, np.cos(angle), np.sin(angle)
    offset, variance = mixed_offset(line, sides, pixels, MIXING)
    return float(offset), float(variance)


@given(angle=st.floats(0.0, 2.0 * np.pi), offset=st.floats(-0.7, 0.7))
def test_steps_lead_to_the_outline_to_a_twentieth_of_a_pixel(angle: float, offset: float) -> None:
    where, variance = found(edge(angle, offset), angle)
    assert where == pytest.approx(offset, abs=0.05 + 0.25 * abs(offset))
    assert 0.999 * MIXING.variance < variance < 0.5


def test_two_alike_colours_or_those_of_other_things_show_no_outline() -> None:
    alike = BESIDE + 15.0
    assert found(edge(0.3, 0.2), 0.3)[1] < np.inf
    assert found(edge(0.3, 0.2, within=alike), 0.3)[1] == np.inf
    assert found(edge(0.3, 0.2), 0.3, odds=(-1.0, -1.0))[1] == np.inf
    assert found(edge(0.3, 0.2), 0.3, odds=(1.0, 1.0))[1] == np.inf


def test_a_third_colour_near_the_outline_makes_it_less_sure() -> None:
    image = edge(0.0, 0.0)
    usual = found(image, 0.0)[1]
    image[:, arrays.WIDTH // 2 + 2] = [20, 220, 20]
    assert found(image, 0.0)[1] > 1.5 * usual


def test_a_line_out_of_the_image_shows_nothing() -> None:
    pixels = arrays.pixels()
    for line in ((1.0, 20.0, 1.0, 0.0), (np.nan, 20.0, 1.0, 0.0), (63.0, 47.0, 0.0, 1.0)):
        assert mixed_offset(line, WIDE, pixels, MIXING)[1] == np.inf
