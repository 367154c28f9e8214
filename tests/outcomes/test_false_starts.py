"""A tracker that thinks for a moment that a thing is in a hand says nothing of it."""

import numpy as np
import pytest
from inhand_outcomes.achievement import Achievement
from inhand_outcomes.false_starts import without_false_starts
from inhand_outcomes.hands import hand_distances
from inhand_outcomes.in_hand import in_hand
from inhand_outcomes.thing import Thing
from inhand_outcomes.track import Track
from inhand_schemas.joints import Joint
from numpy.typing import NDArray

TIMES = np.arange(0.0, 8.0, 1.0 / 30.0)
TABLE, CHEST, SIDE = np.array([[0.4, 0.3, 0.8], [0.1, 0.2, 1.2], [0.3, -0.2, 0.75]])
CUBE = 0.04 * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
THING = Thing("cup", "", CUBE, np.zeros((0, 3), np.int64))
HAND = np.tile(SIDE, (len(TIMES), 1))


def track(places: NDArray[np.float64], hand: NDArray[np.float64]) -> Track:
    """A thing at places (T, 3), and a right hand at others."""
    joints = np.full((len(TIMES), 20, 3), np.nan)
    joints[:, Joint.HAND_RIGHT] = hand
    poses = np.hstack([places, np.tile([1.0, 0.0, 0.0, 0.0], (len(TIMES), 1))])
    covariances = np.tile(1e-4 * np.eye(6), (len(TIMES), 1, 1))
    return Track(TIMES, poses, covariances, np.ones(len(TIMES), bool), joints)


def elsewhere(start_s: float, end_s: float) -> Track:
    """A thing that lies on a table, and is thought to be at a chest for a while."""
    there = (start_s <= TIMES) & (end_s > TIMES)
    return track(np.where(there[:, None], CHEST, TABLE), HAND)


def unseen_s(seen: Track) -> float:
    return float((~without_false_starts(seen).seen).sum() / 30.0)


@pytest.mark.parametrize("seconds", [0.3, 1.0, 2.0])
def test_what_jumps_there_and_back_was_not_there(seconds: float) -> None:
    assert unseen_s(elsewhere(3.0, 3.0 + seconds)) == pytest.approx(seconds, abs=0.05)


def test_what_stays_after_a_jump_is_believed_once_it_has_stayed() -> None:
    assert unseen_s(elsewhere(3.0, 99.0)) == 0.0
    assert unseen_s(elsewhere(6.5, 99.0)) == pytest.approx(1.5, abs=0.05)


def test_what_a_hand_moves_swiftly_and_back_is_believed() -> None:
    share = np.interp(TIMES, [3.0, 3.2, 4.0, 4.2], [0.0, 1.0, 1.0, 0.0])
    places = TABLE + share[:, None] * (CHEST - TABLE)
    assert unseen_s(track(places, HAND)) == 0.0


@pytest.mark.parametrize(("away_m", "least", "most"), [(0.1, 0.85, 0.9), (0.6, 0.0, 0.01)])
def test_what_no_hand_holds_is_not_used(away_m: float, least: float, most: float) -> None:
    places = np.tile(TABLE, (len(TIMES), 1))
    lying = track(places, np.add(places, [away_m, 0.0, 0.0]))
    (judged,) = in_hand([Achievement("shake", 2.0, 3.0, 0.9)], lying, THING)
    assert least <= judged.probability <= most


def test_a_hand_in_the_middle_of_a_stick_is_at_it() -> None:
    corners = np.array([[0.01, 0.0, -0.7], [-0.01, 0.0, -0.7], [0.0, 0.01, 0.7]])
    stick = Thing("broom", "", corners, np.array([[0, 1, 2]]))
    held = track(np.tile(TABLE, (len(TIMES), 1)), np.tile(TABLE, (len(TIMES), 1)))
    assert hand_distances(held, stick)[0, 1] < 0.03
