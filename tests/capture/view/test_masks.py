"""Polygons on pixels."""

import numpy as np
from inhand_capture.view.masks import in_blocks, mask_of

SQUARE = ((0.25, 0.25), (0.75, 0.25), (0.75, 0.75), (0.25, 0.75))


def test_a_polygon_covers_its_pixels_and_those_of_its_edges() -> None:
    mask = mask_of([SQUARE], 16, 8)
    expected = np.zeros((8, 16), bool)
    expected[2:7, 4:13] = True
    np.testing.assert_array_equal(mask, expected)


def test_its_direction_does_not_matter() -> None:
    np.testing.assert_array_equal(mask_of([SQUARE[::-1]], 16, 8), mask_of([SQUARE], 16, 8))


def test_the_whole_picture_can_be_masked() -> None:
    assert mask_of([((0, 0), (1, 0), (1, 1), (0, 1))], 13, 7).all()


def test_a_polygon_that_crosses_itself_has_no_hole() -> None:
    angles = np.pi * (0.8 * np.arange(5) - 0.5)
    star = tuple((0.5 + 0.4 * np.cos(a), 0.5 + 0.4 * np.sin(a)) for a in angles.tolist())
    assert mask_of([star], 200, 200)[100, 100]


def test_several_polygons_are_all_covered() -> None:
    left = ((0, 0), (0.1, 0), (0.1, 1), (0, 1))
    right = ((0.9, 0), (1, 0), (1, 1), (0.9, 1))
    mask = mask_of([left, right], 100, 10)
    assert mask[:, :11].all()
    assert mask[:, 90:].all()
    assert not mask[:, 11:90].any()


def test_a_polygon_thinner_than_a_pixel_covers_its_edges() -> None:
    assert mask_of([((0.2, 0.5), (0.8, 0.5), (0.5, 0.5))], 10, 10)[5].tolist() == (
        [False] * 2 + [True] * 7 + [False]
    )
    assert mask_of([((1, 1), (1, 1), (1, 1))], 10, 10)[9, 9]


def test_no_polygon_masks_nothing() -> None:
    assert not mask_of([], 5, 4).any()


def test_blocks_cover_whatever_they_touch() -> None:
    mask = np.zeros((20, 40), bool)
    mask[17, 33] = True
    expected = np.zeros((20, 40), bool)
    expected[16:, 32:] = True
    np.testing.assert_array_equal(in_blocks(mask), expected)
