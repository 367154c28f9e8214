"""A stretch between two keyframes that images refine."""

from typing import Any

import numpy as np
from gaussian_sight import TRAINED, TRUE, GaussianSight, View
from inhand_lab.labelling.assistance import Assisted, Shown, StretchRefiner
from inhand_lab.labelling.looking import Looker
from inhand_lab.labelling.parameters import DEFAULT_LABELLING
from inhand_lab.labelling.smoothing import Way

FRAMES = 21
MIDDLE = FRAMES // 2
TIMES = np.arange(FRAMES) / 30.0
SHOWN = View(None, TRAINED)


def bulging(metres: float = 0.05) -> Way:
    """The object stands still where it truly is, but between keyframes the way leaves it."""
    places = np.tile(TRUE.centre, (FRAMES, 1))
    places[:, 0] += metres * np.sin(np.pi * np.arange(FRAMES) / (FRAMES - 1))
    return Way(places, np.tile(TRUE.rotation, (FRAMES, 1)), TIMES)


def refined(way: Way, views: list[Any]) -> Assisted:
    looker = Looker(GaussianSight(), DEFAULT_LABELLING)  # type: ignore[arg-type]
    return StretchRefiner(looker).refine(Shown(way, views, np.full(FRAMES, 300.0)))


def off(way: Way) -> np.ndarray:
    distances: np.ndarray = np.linalg.norm(way.translations - TRUE.centre, axis=1)
    return distances


def test_images_bring_the_way_to_where_the_object_is() -> None:
    found = refined(bulging(), [SHOWN] * FRAMES)
    assert off(bulging()).max() > 0.045
    assert off(found.way).max() < 0.01


def test_without_images_the_way_stays_and_is_least_sure_in_the_middle() -> None:
    found = refined(bulging(), [None] * FRAMES)
    np.testing.assert_allclose(found.way.translations, bulging().translations, atol=1e-6)
    assert int(np.argmax(found.covariances[:, 0, 0])) == MIDDLE


def test_frames_that_are_not_seen_follow_those_around_and_are_less_sure() -> None:
    views = [None if abs(frame - MIDDLE) < 3 else SHOWN for frame in range(FRAMES)]
    found = refined(bulging(), views)
    assert off(found.way)[MIDDLE] < 0.03
    assert found.covariances[MIDDLE, 0, 0] > 2.0 * found.covariances[4, 0, 0]


def test_images_that_show_something_else_than_the_way_make_both_sides_disagree() -> None:
    apart = bulging()
    apart.translations[MIDDLE:, 1] += 0.5  # the keyframe after is far from what images show
    agreeing, disagreeing = (
        refined(way, [SHOWN] * FRAMES).disagreements.max() for way in (bulging(0.0), apart)
    )
    assert disagreeing > 2.0 * agreeing
