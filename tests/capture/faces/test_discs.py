"""Discs as pixels."""

import numpy as np
from inhand_capture.faces.discs import Disc, mask_of_discs

SIZE = (48, 64)


def test_a_disc_hides_every_pixel_that_it_touches() -> None:
    mask = mask_of_discs([Disc(20.0, 10.0, 5.0)], SIZE, SIZE)
    rows, columns = np.nonzero(mask)
    distances = np.hypot(rows - 10.0, columns - 20.0)
    assert distances.max() <= 6.0
    assert mask.sum() == sum(
        np.hypot(y - 10.0, x - 20.0) <= 6.0 for y in range(48) for x in range(64)
    )


def test_a_disc_at_an_edge_hides_what_is_in_the_picture() -> None:
    mask = mask_of_discs([Disc(-3.0, 47.0, 8.0)], SIZE, SIZE)
    assert mask[47, 0]
    assert mask[:, 40:].sum() == 0
    assert not mask_of_discs([Disc(-300.0, 20.0, 8.0), Disc(20.0, 900.0, 8.0)], SIZE, SIZE).any()


def test_depth_of_another_size_is_hidden_in_the_same_place() -> None:
    small = mask_of_discs([Disc(31.5, 23.5, 12.0)], SIZE, (24, 32))
    large = mask_of_discs([Disc(31.5, 23.5, 12.0)], SIZE, SIZE)
    assert np.all(np.kron(small, np.ones((2, 2), bool)) >= large)
    rows, columns = np.nonzero(small)
    assert (rows.mean(), columns.mean()) == (11.5, 15.5)


def test_a_disc_larger_than_the_picture_hides_all_of_it() -> None:
    assert mask_of_discs([Disc(10.0, 10.0, 1e6)], SIZE, SIZE).all()
