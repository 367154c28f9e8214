"""magnifyText: the lens goes along lines over the page, nearer and further, facing the reader."""

import numpy as np
import pytest
from inhand_lab.geometry.transforms import normalised, rotation_about
from inhand_lab.motions.magnify_text import BOOK_SIZE, PAGE_COLOUR
from inhand_lab.objects.magnifier import magnifier
from performers import FRAME_RATE, performed

PARTICIPANTS = range(10)


@pytest.mark.parametrize("participant", PARTICIPANTS)
def test_the_lens_follows_lines_over_the_page(participant: int) -> None:
    _, performance, body = performed("magnifyText", participant)
    glass = performance.world_from_object
    book = next(box for box in performance.furniture if box.colour == PAGE_COLOUR)
    above = glass.translation - np.array(book.centre)
    above[:, 2] -= BOOK_SIZE[2] / 2
    reading = above[:, 2] > 0.04
    assert reading.sum() > 4 * FRAME_RATE
    assert np.abs(above[reading, :2]).max(axis=0) == pytest.approx(BOOK_SIZE[:2] / 2, abs=0.12)
    along = above[reading, 0]
    crossings = np.count_nonzero(np.diff(np.sign(along - along.mean())))
    assert crossings >= 2
    assert np.ptp(above[reading, 2]) > 0.01
    eyes = normalised(body.from_head.translation - glass.translation)[reading]
    towards = np.abs(np.sum(eyes * glass.rotation[reading, :, 1], axis=1))
    assert np.median(towards) > 0.7


def test_half_a_turn_about_the_handle_leaves_the_glass_as_it_is() -> None:
    model = magnifier()
    (symmetry,) = model.symmetries
    assert (symmetry.axis, symmetry.order) == ((0.0, 0.0, 1.0), 2)
    turned = model.vertices @ rotation_about("z", np.pi).T
    gaps = np.linalg.norm(model.vertices[:, None] - turned, axis=2).min(axis=1)
    assert gaps.max() < 1e-6
