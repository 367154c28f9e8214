"""One depth image of several frames in which nothing moves."""

import numpy as np
import pytest
from inhand_lab.new_objects.recorded_depth import still_depth
from inhand_lab.new_objects.table import MeasuringError


def test_each_pixel_is_the_median_of_the_frames_that_measured_it() -> None:
    frames = np.full((9, 4, 5), 0.8)
    frames[:, 0, 0] = [0.8, 0.0, 0.81, 0.0, 0.79, 0.8, 0.8, 0.0, 0.82]
    frames[:6, 0, 1] = 0.0
    depth = still_depth(frames)
    assert depth[0, 0] == pytest.approx(0.8)
    assert depth[0, 1] == 0.0
    np.testing.assert_allclose(depth[1:], 0.8)


def test_depth_that_nothing_measured_is_nothing() -> None:
    assert not still_depth(np.zeros((6, 4, 5))).any()


def test_what_moves_is_refused() -> None:
    frames = np.full((9, 20, 20), 0.8)
    frames[6:, :5] = 0.75
    with pytest.raises(MeasuringError, match="25% of the image move: keep camera, thing and hands"):
        still_depth(frames)
