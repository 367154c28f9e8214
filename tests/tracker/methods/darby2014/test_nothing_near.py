"""Body poses that are like none of those learned."""

from dataclasses import replace

import numpy as np
import pytest
from inhand_tracker.body.skeleton import LEFT_HAND, RIGHT_HAND
from inhand_tracker.mapping.mapping import Mapping
from inhand_tracker.methods.darby2014.nothing_near import draw_broadly, farthest_near
from inhand_tracker.methods.darby2014.parameters import DEFAULT_DARBY2014
from inhand_tracker.methods.darby2014.particles import Particles
from inhand_tracker.methods.darby2014.tracker import ParticleTracker
from inhand_tracker.methods.darby2014.variants import VARIANTS
from people import FRAME_NS, held, wave_model, waving

FALLBACK = VARIANTS["gd-fallback"]


def on_a_line(*sequences: tuple[str, list[float]]) -> Mapping:
    """Participants whose body poses differ in one number only."""
    lengths = [len(values) for _, values in sequences]
    count = sum(lengths)
    poses = np.zeros((count, 60))
    poses[:, 7] = np.concatenate([values for _, values in sequences])
    translations = np.ones((count, 19, 3))
    return replace(
        wave_model().mapping,
        participants=tuple(name for name, _ in sequences),
        starts=np.concatenate(([0], np.cumsum(lengths))),
        radii=np.ones(len(sequences)),
        body_poses=poses,
        translations=translations,
        rotations=np.tile([1.0, 0.0, 0.0, 0.0], (count, 19, 1)),
        translation_variation=np.zeros(count),
        rotation_variation=np.zeros(count),
        stable_translation_part=np.zeros(count, int),
        stable_rotation_part=np.arange(count) % 19,
        proximate_part=np.zeros(count, int),
    )


def test_the_farthest_near_is_what_hardly_any_training_pose_is_beyond() -> None:
    first, second = np.arange(100.0), np.arange(100.0) + 0.25
    mapping = on_a_line(("p0", list(first)), ("p1", list(second)))
    assert farthest_near(mapping) == pytest.approx(0.25)


def test_one_participant_s_own_poses_do_not_make_others_near() -> None:
    mapping = on_a_line(("p0", [0.0, 1.0]), ("p0", [0.1, 1.1]), ("p1", [5.0, 5.0]))
    assert farthest_near(mapping) == pytest.approx(5.0, abs=0.1)


def test_the_recordings_of_a_single_participant_stand_for_people() -> None:
    mapping = on_a_line(("p0", [0.0, 1.0]), ("p0", [0.5, 1.5]))
    assert farthest_near(mapping) == pytest.approx(0.5)


def broadly(mapping: Mapping, at: float, method: str = "gd-fallback") -> Particles:
    pose = np.zeros(60)
    pose[7] = at
    many = replace(DEFAULT_DARBY2014, particles=5000)
    return draw_broadly(mapping, pose, VARIANTS[method], np.random.default_rng(0), many)


def test_broad_draws_prefer_likely_frames_and_reach_far() -> None:
    mapping = on_a_line(("p0", list(np.arange(100.0))), ("p1", list(np.arange(100.0) + 0.5)))
    for frames in (broadly(mapping, 0.0).translation_frames, broadly(mapping, 0.0).rotation_frames):
        away = mapping.body_poses[frames, 7]
        # The least of ten evenly drawn shares of 100 has the mean 100 / 11.
        assert away.mean() == pytest.approx(100 / 11, abs=1.0)
        assert away.max() > 30.0
        assert set((frames >= 100).tolist()) == {False, True}


def test_translations_are_predicted_from_the_nearer_hand_of_their_frame() -> None:
    mapping = on_a_line(("p0", list(np.arange(50.0))), ("p1", list(np.arange(50.0))))
    mapping.translations[:50, RIGHT_HAND] = 0.1
    mapping.translations[50:, LEFT_HAND] = 0.1
    particles = broadly(mapping, 25.0)
    expected = np.where(particles.translation_frames < 50, RIGHT_HAND, LEFT_HAND)
    np.testing.assert_array_equal(particles.translation_parts, expected)


def test_rotations_are_predicted_from_the_method_s_part() -> None:
    mapping = on_a_line(("p0", list(np.arange(50.0))), ("p1", list(np.arange(50.0))))
    particles = broadly(mapping, 25.0)
    np.testing.assert_array_equal(
        particles.rotation_parts, mapping.stable_rotation_part[particles.rotation_frames]
    )
    assert set(broadly(mapping, 25.0, "gd-hand").rotation_parts.tolist()) == {RIGHT_HAND}


def contorted() -> np.ndarray:
    """A leg kicked high, and the right arm as somebody waves."""
    joints = waving(1, seed=7)[0]
    joints[17:20] = joints[16] + np.array([[0.0, -0.1, -0.4], [0.0, -0.3, -0.8], [0.0, -0.4, -0.8]])
    return joints


def test_a_pose_like_none_learned_keeps_the_object_by_the_hand() -> None:
    joints = contorted()
    (place,), _ = held(joints[None], seed=7)
    tracker = ParticleTracker(wave_model(), FALLBACK)
    for frame in range(1, 6):
        estimate = tracker.step(joints, frame * FRAME_NS)
        assert np.linalg.norm(estimate.translation - place) < 0.08


def test_the_fallback_says_that_it_is_less_sure() -> None:
    usual, unusual = (
        ParticleTracker(wave_model(), FALLBACK).step(joints, FRAME_NS)
        for joints in (waving(1, seed=7)[0], contorted())
    )
    assert np.trace(unusual.covariance) > 2.0 * np.trace(usual.covariance)


def test_near_poses_are_tracked_as_without_the_fallback() -> None:
    plain, fallback = (
        ParticleTracker(wave_model(), VARIANTS[name])
        for name in ("gd-stable-proximate", "gd-fallback")
    )
    for number, frame in enumerate(waving(30, seed=1)):
        first, second = (t.step(frame, (number + 1) * FRAME_NS) for t in (plain, fallback))
        np.testing.assert_array_equal(first.translation, second.translation)
