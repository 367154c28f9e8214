"""The fused tracker on simulated people who drink from a mug, none of whom it was learned from."""

from functools import cache

import numpy as np
import pytest
from drinkers import FRAMES, Fused, fused

STRANGERS = (7, 8, 9)
UNSEEN = 45
"""Frames: 3 s."""
BACK_WITHIN = 3
SECOND = 15
BEGINNINGS = (45, 60, 75, 90)

pytestmark = pytest.mark.long


@cache
def blind(participant: int) -> Fused:
    return fused(participant, [])


@cache
def seeing(participant: int) -> Fused:
    return fused(participant, range(FRAMES))


@cache
def interrupted(participant: int, begin: int) -> Fused:
    """No image comes for 3 s."""
    return fused(participant, [f for f in range(FRAMES) if not begin <= f < begin + UNSEEN])


@pytest.mark.parametrize("participant", STRANGERS)
def test_images_halve_the_error_and_more(participant: int) -> None:
    seen, unseen = (one(participant).errors.mean() for one in (seeing, blind))
    assert seen < 0.5 * unseen
    assert seen < 0.02


@pytest.mark.parametrize("participant", STRANGERS)
@pytest.mark.parametrize("begin", BEGINNINGS)
def test_unseen_for_three_seconds_it_is_hardly_worse_than_the_prior(
    participant: int, begin: int
) -> None:
    end = begin + UNSEEN
    track = interrupted(participant, begin)
    unseen = track.errors[begin:end].mean()
    assert unseen < 1.2 * blind(participant).errors[begin:end].mean()
    assert {one.state for one in track.estimates} == {"tracked"}


def test_in_the_third_frame_that_is_seen_again_it_errs_as_if_it_had_never_been_unseen() -> None:
    """On the mean of all interruptions; a single frame errs by a centimetre more or less."""
    after, never = [], []
    for participant in STRANGERS:
        for begin in BEGINNINGS:
            third = begin + UNSEEN + BACK_WITHIN - 1
            after.append(interrupted(participant, begin).errors[third])
            never.append(seeing(participant).errors[third])
    assert np.mean(after) < 1.1 * np.mean(never)


def test_in_the_second_after_that_it_errs_no_more_than_if_it_had_never_been_unseen() -> None:
    more = []
    for participant in STRANGERS:
        for begin in BEGINNINGS:
            since = slice(
                begin + UNSEEN + BACK_WITHIN - 1, begin + UNSEEN + BACK_WITHIN + SECOND - 1
            )
            after, never = (
                one.errors[since].mean()
                for one in (interrupted(participant, begin), seeing(participant))
            )
            more.append(after - never)
    assert np.mean(more) < 0.002
    assert np.max(more) < 0.02


def test_until_images_fail_their_coming_failure_changes_nothing() -> None:
    begin = 60
    for one, other in zip(
        interrupted(7, begin).estimates[:begin], seeing(7).estimates[:begin], strict=True
    ):
        np.testing.assert_array_equal(one.translation, other.translation)


@pytest.mark.parametrize("kind", [blind, seeing])
def test_the_truth_lies_within_the_stated_90_percent_region(kind: object) -> None:
    """Over some strangers' recordings; each alone errs by a habit of its own."""
    covered = [kind(participant).coverage() for participant in STRANGERS]
    assert 0.8 <= np.mean(covered) <= 1.0


def test_confidence_tells_good_frames_from_bad_ones() -> None:
    """Over many strangers: within one recording errors of millimetres hardly differ."""
    tracks = [seeing(participant) for participant in (*STRANGERS, *range(20, 26))]
    confidences = np.array([one.confidence for track in tracks for one in track.estimates])
    errors = np.concatenate([track.errors for track in tracks])
    order = np.argsort(confidences, kind="stable")
    third = len(order) // 3
    assert errors[order[-third:]].mean() < errors[order[:third]].mean()
