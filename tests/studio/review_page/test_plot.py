"""Errors over time as a picture."""

import numpy as np
from inhand_lab.datasets.tracks import empty_track
from inhand_studio.review_page.errors import Estimate
from inhand_studio.review_page.parameters import DEFAULT_REVIEW
from inhand_studio.review_page.plot import plot_html, worst_frame

FRAMES = 3000


def _estimate(errors: np.ndarray | None) -> Estimate:
    return Estimate("one", "mug", (255, 0, 0), empty_track(0), errors)


def test_the_worst_frame_of_a_long_recording_is_in_the_plot_and_is_found() -> None:
    errors = np.full(FRAMES, 0.01)
    errors[1234] = 0.5
    estimates = [_estimate(np.full(FRAMES, np.nan)), _estimate(errors), _estimate(None)]
    assert worst_frame(estimates) == 1234
    column = 1234 * DEFAULT_REVIEW.columns // FRAMES
    assert f" {column},0.0 " in plot_html(estimates, FRAMES, DEFAULT_REVIEW)


def test_a_line_is_broken_where_there_are_no_errors() -> None:
    errors = np.full(FRAMES, 0.01)
    errors[1000:2000] = np.nan
    assert plot_html([_estimate(errors)], FRAMES, DEFAULT_REVIEW).count("<polyline") == 2


def test_without_errors_there_is_no_plot() -> None:
    for estimates in ([], [_estimate(None)], [_estimate(np.full(FRAMES, np.nan))]):
        assert plot_html(estimates, FRAMES, DEFAULT_REVIEW) == ""
        assert worst_frame(estimates) is None
