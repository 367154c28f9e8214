"""What recognition reads of a movement does not depend on the rate of frames."""

import numpy as np
from inhand_tracker.recognition.movement_window import MovementWindow
from inhand_tracker.recognition.parameters import DEFAULT_RECOGNITION

WINDOWS, LAGS = len(DEFAULT_RECOGNITION.windows), len(DEFAULT_RECOGNITION.lags)
PRESENT = 3 * 15 + 13
"""Number of features of one pose: fifteen joints and thirteen distances."""


def pose_at(seconds: float) -> np.ndarray:
    return 0.3 * np.sin(np.arange(60) + 2.0 * seconds)


def read(rate: float, seconds: float = 5.0) -> np.ndarray:
    movement = MovementWindow()
    for n in range(round(seconds * rate) + 1):
        movement.add(round(n / rate * 1e9), pose_at(n / rate))
    return movement.features()


def test_twice_as_many_frames_a_second_tell_the_same() -> None:
    features = read(30.0)
    assert features.shape == (PRESENT * (1 + LAGS + 3 * WINDOWS),)
    np.testing.assert_allclose(read(60.0), features, atol=0.03)


def test_a_body_that_stands_still_has_no_changes_spreads_or_speeds() -> None:
    movement = MovementWindow()
    for n in range(5):
        movement.add(n * 33_333_333, pose_at(0.0))
    blocks = movement.features().reshape(-1, PRESENT)
    np.testing.assert_allclose(blocks[1:4], 0.0, atol=1e-12)
    for window in range(WINDOWS):
        mean, spread, speed = blocks[4 + 3 * window : 7 + 3 * window]
        np.testing.assert_allclose(mean, blocks[0])
        np.testing.assert_allclose(spread, 0.0, atol=1e-12)
        np.testing.assert_allclose(speed, 0.0, atol=1e-12)


def test_a_clock_that_goes_back_starts_anew() -> None:
    movement, fresh = MovementWindow(), MovementWindow()
    for n in range(10):
        movement.add(10**9 + n * 33_333_333, pose_at(n))
    movement.add(5, pose_at(3.0))
    fresh.add(5, pose_at(3.0))
    np.testing.assert_array_equal(movement.features(), fresh.features())
