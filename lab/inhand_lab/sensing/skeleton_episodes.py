"""Errors of a skeleton tracker that begin and end: ends misread, hands flipped, wrists lost.

Hands and feet, small as they are, are now and then seen turned or cut short, a hand flips, and a
fast wrist stays behind or leaves the arm.
"""

from __future__ import annotations

import numpy as np
from inhand_schemas.joints import PARENTS, Joint
from inhand_tracker.geometry.arrays import Array, Indices

from inhand_lab.geometry.transforms import turn_points
from inhand_lab.sensing.skeleton_errors import HANDS
from inhand_lab.sensing.skeleton_noise_parameters import EpisodeNoise

FEET = (Joint.FOOT_LEFT, Joint.FOOT_RIGHT)
MOST_CHANCE = 0.5
"""Chance that an episode begins in a frame, at the most."""


def misread_ends(
    random: np.random.Generator, joints: Array, frame_rate: float, noise: EpisodeNoise
) -> Array:
    """Joints (T, 20, 3) with hands and feet that are now and then turned or cut short."""
    misread = joints.copy()
    for end in (*HANDS, *FEET):
        kind = noise.hand if end in HANDS else noise.foot
        # Some people's hands and feet stand out, others' are lost in sleeves and in the floor.
        chance = np.full(len(joints), random.exponential() * kind.rate / frame_rate)
        begun = _episodes(random, np.minimum(chance, MOST_CHANCE), kind.stay)
        turns = kind.turn * random.normal(size=(len(joints), 3))
        stretch = np.exp(kind.stretch * random.normal(size=(len(joints), 1)))
        wrong = begun >= 0
        root = joints[wrong, PARENTS[end]]
        bone = turn_points(joints[wrong, end] - root, turns[begun[wrong]])
        misread[wrong, end] = root + stretch[begun[wrong]] * bone
    return misread


def flip_hands(
    random: np.random.Generator, joints: Array, speed: Array, frame_rate: float, noise: EpisodeNoise
) -> Array:
    """Joints (T, 20, 3) with hands that now and then point back along the forearm."""
    flipped = joints.copy()
    for hand in HANDS:
        rate = noise.flip_rate + noise.flip_rate_moving * speed[:, hand]
        back = _episodes(random, np.minimum(rate / frame_rate, MOST_CHANCE), noise.flip_stay) >= 0
        wrist = joints[back, PARENTS[hand]]
        flipped[back, hand] = 2.0 * wrist - joints[back, hand]
    return flipped


def lose_wrists(
    random: np.random.Generator, joints: Array, speed: Array, frame_rate: float, noise: EpisodeNoise
) -> Array:
    """Joints (T, 20, 3) with fast wrists that stay behind or leave the arm, hands with them."""
    lost = joints.copy()
    for wrist, hand in (
        (Joint.WRIST_LEFT, Joint.HAND_LEFT),
        (Joint.WRIST_RIGHT, Joint.HAND_RIGHT),
    ):
        rate = noise.failure_rate * (np.clip(speed[:, wrist], noise.calm, noise.wild) - noise.calm)
        begun = _episodes(random, np.minimum(rate / frame_rate, MOST_CHANCE), noise.failure_stay)
        stuck = random.random(len(joints)) < noise.stuck_share
        astray = noise.astray * random.normal(size=(len(joints), 3))
        behind = (begun >= 0) & stuck[begun]
        away = (begun >= 0) & ~stuck[begun]
        for joint in (wrist, hand):
            lost[behind, joint] = joints[np.maximum(begun[behind] - 1, 0), joint]
            lost[away, joint] += astray[begun[away]]
    return lost


def _episodes(random: np.random.Generator, chance: Array, stay: float) -> Indices:
    """The frame (T,) in which the episode that a frame is in began, -1 outside one.

    An episode begins with the chance (T,) of its frame, and lasts on with the chance stay.
    """
    begins, stays = random.random(len(chance)) < chance, random.random(len(chance)) < stay
    begun = np.full(len(chance), -1, np.int64)
    for frame in range(len(chance)):
        if frame > 0 and begun[frame - 1] >= 0 and stays[frame]:
            begun[frame] = begun[frame - 1]
        elif begins[frame]:
            begun[frame] = frame
    return begun
