import numpy as np
import pytest
from inhand_tracker.sight.colours import (
    BINS,
    Colours,
    blend,
    colour_bins,
    histogram,
    log_odds_by_colour,
    smoothed,
)

RED, GREEN, UNSEEN = (200, 20, 20), (20, 200, 20), (20, 20, 200)


def bin_of(colour: tuple[int, int, int]) -> int:
    return int(colour_bins(np.full((3, 3, 3), colour, np.uint8))[1, 1])


def all_of(colour: tuple[int, int, int]) -> np.ndarray:
    counts = histogram(colour_bins(np.full((8, 8, 3), colour, np.uint8)), np.ones((8, 8), "f4"))
    assert counts is not None
    return counts


def test_a_bin_is_16_levels_of_each_colour() -> None:
    assert bin_of((15, 31, 32)) == 0 * 256 + 1 * 16 + 2
    assert bin_of((255, 255, 255)) == BINS - 1


def test_a_histogram_sums_to_one_and_counts_what_is_weighed() -> None:
    image = np.zeros((8, 8, 3), np.uint8)
    image[:, :4], image[:, 4:] = RED, GREEN
    weights = np.zeros((8, 8), np.float32)
    weights[:, :3] = 1.0
    counts = histogram(colour_bins(image), weights)
    assert counts is not None
    assert counts.sum() == pytest.approx(1.0, abs=1e-5)
    assert counts[bin_of(RED)] > 0.1
    assert counts[bin_of(GREEN)] == pytest.approx(0.0, abs=1e-6)


def test_nothing_weighed_is_no_histogram() -> None:
    assert histogram(np.zeros((4, 4), np.uint16), np.zeros((4, 4), np.float32)) is None


def test_smoothing_spreads_to_neighbouring_colours_and_keeps_the_sum() -> None:
    one = np.zeros(BINS, np.float32)
    one[bin_of(RED)] = 1.0
    spread = smoothed(one)
    assert spread.sum() == pytest.approx(1.0, abs=1e-5)
    assert spread[bin_of((184, 20, 20))] > 0.01
    assert spread[bin_of(GREEN)] == pytest.approx(0.0, abs=1e-9)


def test_odds_speak_for_what_the_object_shows_and_against_what_surrounds_it() -> None:
    odds = log_odds_by_colour(Colours(all_of(RED), all_of(GREEN)))
    assert odds[bin_of(RED)] == 3.0
    assert odds[bin_of(GREEN)] == -3.0
    assert -1.5 < odds[bin_of(UNSEEN)] < 0.0


@pytest.mark.parametrize("known", [Colours(), Colours(of_object=np.full(BINS, 1.0 / BINS, "f4"))])
def test_while_something_is_unknown_colours_say_nothing(known: Colours) -> None:
    np.testing.assert_array_equal(log_odds_by_colour(known), np.zeros(BINS))


def test_blending_takes_what_there_is() -> None:
    red, green = all_of(RED), all_of(GREEN)
    assert blend(None, None, 0.3) is None
    assert blend(None, green, 0.3) is green
    assert blend(red, None, 0.3) is red
    mixed = blend(red, green, 0.25)
    assert mixed is not None
    np.testing.assert_allclose(mixed, 0.75 * red + 0.25 * green, atol=1e-7)
