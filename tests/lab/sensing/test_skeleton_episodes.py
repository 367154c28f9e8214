"""Errors of a skeleton tracker that begin and end."""

from dataclasses import replace

import numpy as np
import pytest
from inhand_lab.sensing.skeleton_episodes import flip_hands, lose_wrists, misread_ends
from inhand_lab.sensing.skeleton_noise_parameters import EpisodeNoise
from inhand_schemas.joints import PARENTS, Joint

FRAME_RATE, FRAMES = 30.0, 3000
JOINTS = np.repeat(np.random.default_rng(0).uniform(-0.8, 0.8, (1, 20, 3)), FRAMES, axis=0)
NOISE = EpisodeNoise()


def test_a_flipped_hand_points_back_along_the_forearm_as_often_as_is_set() -> None:
    still = np.zeros((FRAMES, 20))
    noise = replace(NOISE, flip_rate=3.0, flip_stay=0.0)
    flipped = flip_hands(np.random.default_rng(1), JOINTS, still, FRAME_RATE, noise)
    back = np.any(flipped[:, Joint.HAND_LEFT] != JOINTS[:, Joint.HAND_LEFT], axis=1)
    assert back.mean() == pytest.approx(0.1, abs=0.02)
    hand, wrist = JOINTS[0, Joint.HAND_LEFT], JOINTS[0, Joint.WRIST_LEFT]
    assert np.allclose(flipped[back, Joint.HAND_LEFT], 2.0 * wrist - hand)
    others = [joint for joint in range(20) if joint not in (Joint.HAND_LEFT, Joint.HAND_RIGHT)]
    assert np.array_equal(flipped[:, others], JOINTS[:, others])


def test_a_slow_wrist_is_never_lost_and_a_lost_one_takes_its_hand_along() -> None:
    slow, fast = np.full((FRAMES, 20), 0.9 * NOISE.calm), np.full((FRAMES, 20), NOISE.wild)
    kept, lost = (
        lose_wrists(np.random.default_rng(2), JOINTS, speed, FRAME_RATE, NOISE)
        for speed in (slow, fast)
    )
    assert np.array_equal(kept, JOINTS)
    moved = lost - JOINTS
    assert np.any(moved[:, Joint.WRIST_RIGHT])
    assert np.allclose(moved[:, Joint.WRIST_RIGHT], moved[:, Joint.HAND_RIGHT])


def test_misread_hands_and_feet_are_turned_and_stretched_about_their_roots() -> None:
    still = replace(NOISE, hand=replace(NOISE.hand, turn=0.0), foot=replace(NOISE.foot, rate=0.0))
    misread = misread_ends(np.random.default_rng(3), JOINTS, FRAME_RATE, still)
    end = Joint.HAND_RIGHT
    root = JOINTS[0, PARENTS[end]]
    bones = misread[:, end] - root
    assert np.allclose(np.cross(bones, JOINTS[0, end] - root), 0.0)
    assert np.ptp(np.linalg.norm(bones, axis=1)) > 0.0
    assert np.array_equal(misread[:, Joint.FOOT_LEFT], JOINTS[:, Joint.FOOT_LEFT])
