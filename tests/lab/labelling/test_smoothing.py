"""The likeliest way through the frames of a stretch."""

import numpy as np
import pytest
from inhand_lab.labelling.parameters import DEFAULT_LABELLING
from inhand_lab.labelling.smoothing import Smoothed, Way, smooth
from inhand_tracker.geometry import rotations

FRAMES = 31
TIMES = np.arange(FRAMES) / 30.0
SURE = np.diag(np.repeat([1e6, 1e5], 3))


def moving(bend: float = 0.0) -> Way:
    """A way of 0.6 m and 1 rad a second, bent by up to ``bend`` metres in the middle."""
    translations = np.zeros((FRAMES, 3))
    translations[:, 0] = 0.6 * TIMES
    translations[:, 1] = bend * np.sin(np.pi * TIMES)
    return Way(translations, rotations.from_vector(np.outer(TIMES, [0.0, 0.0, 1.0])), TIMES)


def smoothed(start: Way, guide: Way, seen: list[int], truth: Way) -> Smoothed:
    """Smooth with images that show the truth in some frames, and keyframes at both ends."""
    information = np.zeros((FRAMES, 6, 6))
    information[[0, FRAMES - 1, *seen]] = SURE
    steps = start.deviations(truth)
    steps[[frame for frame in range(1, FRAMES - 1) if frame not in seen]] = 0.0
    return smooth(start.moved(steps), guide, information, DEFAULT_LABELLING)


def off(found: Smoothed, truth: Way) -> np.ndarray:
    return np.abs(truth.deviations(found.way)).max(axis=1)


def test_where_no_image_says_anything_the_way_is_the_guides() -> None:
    found = smoothed(moving(), moving(), [], moving())
    assert off(found, moving()).max() < 1e-6


def test_what_images_show_moves_the_frames_between_them_too() -> None:
    truth = moving(bend=0.08)
    found = smoothed(moving(), moving(), list(range(3, FRAMES, 3)), truth)
    assert off(found, truth).max() < 0.01


def test_a_frame_that_is_not_seen_is_less_sure() -> None:
    seen = [frame for frame in range(1, FRAMES - 1) if not 12 <= frame <= 20]
    found = smoothed(moving(), moving(), seen, moving())
    spread = np.sqrt(np.trace(found.covariances[:, :3, :3], axis1=1, axis2=2))
    assert int(np.argmax(spread)) == 16
    assert spread[16] > 5.0 * spread[5]


def test_noise_of_a_start_is_smoothed_away_where_images_are_weak() -> None:
    noise = 0.01 * np.random.default_rng(0).standard_normal((FRAMES, 6))
    noise[[0, -1]] = 0.0
    start = moving().moved(noise)
    information = np.tile(1e4 * np.eye(6), (FRAMES, 1, 1))
    found = smooth(start, moving(), information, DEFAULT_LABELLING)
    assert off(found, moving()).mean() < 0.6 * np.abs(noise).max(axis=1).mean()


@pytest.mark.parametrize("frames", [3, 4])
def test_the_shortest_stretches_are_smoothed(frames: int) -> None:
    whole = moving()
    part = Way(whole.translations[:frames], whole.rotations[:frames], TIMES[:frames])
    information = np.tile(SURE, (frames, 1, 1))
    found = smooth(part, part, information, DEFAULT_LABELLING)
    assert np.abs(part.deviations(found.way)).max() < 1e-9


def test_covariances_are_the_blocks_of_the_whole_inverse() -> None:
    found = smoothed(moving(), moving(), [5, 15], moving())
    assert np.linalg.eigvalsh(found.covariances).min() > 0.0
    assert np.allclose(np.diagonal(found.covariances[5])[:3], 1e-6, rtol=0.5)
