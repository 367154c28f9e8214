"""From probabilities to a recognised action, and from outlines to boxes."""

import numpy as np
import pytest
from inhand_tracker.recognition.recognition import outline_boxes, recognised_action


@pytest.mark.parametrize(
    ("probabilities", "expected"),
    [((0.5, 0.2), 0), ((0.2, 0.5), 1), ((0.49, 0.2), None), ((0.0, 0.0), None)],
)
def test_an_action_is_recognised_from_half_of_the_probability(
    probabilities: tuple[float, float], expected: int | None
) -> None:
    assert recognised_action(np.array(probabilities)) == expected


def test_a_box_holds_the_pixels_that_are_before_the_camera() -> None:
    outlines = np.array([[[1.0, 8.0], [3.0, 2.0], [np.nan, np.nan]], np.full((3, 2), np.nan)])
    np.testing.assert_array_equal(outline_boxes(outlines), [[1.0, 2.0, 3.0, 8.0], [np.nan] * 4])
