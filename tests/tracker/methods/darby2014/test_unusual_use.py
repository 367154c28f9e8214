"""Fig. 12 of Darby et al. 2014: glasses are worn while the arms swing as if to put them on."""

from functools import cache

import numpy as np
import pytest
from inhand_schemas.joints import JOINT_NAMES, Joint
from inhand_tracker.mapping.labelled_sequence import LabelledSequence
from inhand_tracker.mapping.learning import learn
from inhand_tracker.methods.darby2014.tracker import ParticleTracker
from inhand_tracker.methods.darby2014.variants import VARIANTS
from inhand_tracker.model.model import Model
from people import FRAME_NS, STANDING, wave_model

RAISING, WORN, FRAMES = 30, 60, 120
JUMP = slice(90, 100)
UPRIGHT = np.array([1.0, 0.0, 0.0, 0.0])
SIDES = (("Left", 1.0), ("Right", -1.0))


def put_arms(joints: np.ndarray, raised: float | None) -> None:
    """Both hands before the body, from 0 at the belt to 1 at the eyes; None for arms that hang."""
    for side, sign in SIDES:
        shoulder = joints[JOINT_NAMES.index(f"Shoulder{side}")]
        if raised is None:
            hand = shoulder + np.array([0.05 * sign, 0.60, -0.03])
            elbow = shoulder + np.array([0.04 * sign, 0.28, 0.0])
        else:
            hand = np.array([0.07 * sign, -0.10 - 0.60 * raised, 2.12 + 0.13 * raised])
            elbow = 0.5 * (shoulder + hand) + np.array([0.06 * sign, 0.12, 0.0])
        joints[JOINT_NAMES.index(f"Hand{side}")] = hand
        joints[JOINT_NAMES.index(f"Wrist{side}")] = hand + 0.2 * (elbow - hand)
        joints[JOINT_NAMES.index(f"Elbow{side}")] = elbow


def puts_on_glasses(seed: int, *, jumps: bool = False) -> LabelledSequence:
    """Glasses held at the belt, raised to the eyes, and worn with the arms down.

    Who jumps swings both arms up in front meanwhile.
    """
    joints = np.repeat(STANDING[None], FRAMES, axis=0)
    glasses = np.empty((FRAMES, 3))
    for frame, body in enumerate(joints):
        worn = frame >= WORN
        swings = jumps and JUMP.start <= frame < JUMP.stop
        put_arms(body, 0.4 if swings else None if worn else max(0.0, (frame - RAISING) / 30))
        hands = body[[Joint.HAND_LEFT, Joint.HAND_RIGHT]].mean(axis=0)
        glasses[frame] = body[Joint.HEAD] + np.array([0.0, 0.0, -0.12]) if worn else hands
    joints += 0.008 * np.random.default_rng(seed).normal(size=joints.shape)
    return LabelledSequence(f"p{seed}", False, joints, glasses, np.tile(UPRIGHT, (FRAMES, 1)))


@cache
def glasses_model() -> Model:
    shape = wave_model().shape
    sequences = [puts_on_glasses(seed) for seed in range(4)]
    mapping = learn(sequences, shape.mirror_normal)
    return Model("putOnGlasses", shape, mapping, wave_model().viewpoints)


def errors_of(method: str, performed: LabelledSequence) -> np.ndarray:
    """The errors of translation, in metres."""
    tracker = ParticleTracker(glasses_model(), VARIANTS[method])
    estimates = [tracker.step(b, (n + 1) * FRAME_NS) for n, b in enumerate(performed.joints)]
    return np.linalg.norm(
        np.array([estimate.translation for estimate in estimates]) - performed.translations, axis=1
    )


@pytest.mark.parametrize("method", ["gd-stable", "gd-stable-proximate", "gd-fallback"])
def test_a_swing_of_the_arms_takes_worn_glasses_along_until_the_arms_are_down(method: str) -> None:
    errors = errors_of(method, puts_on_glasses(5, jumps=True))
    assert np.median(errors[WORN : JUMP.start]) < 0.05
    assert np.median(errors[JUMP]) > 0.25
    assert errors[JUMP.stop] < 0.05


@pytest.mark.parametrize("method", ["gd-stable", "gd-stable-proximate", "gd-fallback"])
def test_without_the_swing_the_glasses_stay_on_the_head(method: str) -> None:
    errors = errors_of(method, puts_on_glasses(5))
    assert np.median(errors[JUMP]) < 0.05
