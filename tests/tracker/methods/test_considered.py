"""What trackers tell of what they chose an estimate from."""

import numpy as np
import pytest
from followed import follow
from inhand_tracker.body.anchors import ANCHORS
from inhand_tracker.body.skeleton import PARTS, mirror_joints, mirror_pose
from inhand_tracker.geometry.considered import Considered
from inhand_tracker.methods.darby2014.tracker import ParticleTracker
from inhand_tracker.methods.darby2014.variants import VARIANTS
from inhand_tracker.methods.fusion.tracker import FusionTracker
from inhand_tracker.methods.object_tracker import ObjectTracker
from people import FRAME_NS, held, same_rotation, unseen_wave, wave_model
from wedges import FRAMES, images

BEST = VARIANTS["gd-stable-proximate"]


def considered_by(tracker: ObjectTracker) -> Considered:
    considered = tracker.considered()
    assert considered is not None
    return considered


def test_hypotheses_are_weighed_poses_near_the_estimate() -> None:
    tracker = FusionTracker(wave_model())
    assert tracker.considered() is None
    estimate = follow(tracker, unseen_wave(FRAMES), images())[-1]
    considered = considered_by(tracker)
    assert considered.weights.sum() == pytest.approx(1.0)
    assert len(considered.weights) == len(considered.translations) > 20
    np.testing.assert_allclose(np.linalg.norm(considered.rotations, axis=1), 1.0)
    mean = considered.weights @ considered.translations
    assert np.linalg.norm(mean - estimate.translation) < 0.05


def test_the_mean_of_the_particles_is_the_estimate() -> None:
    tracker = ParticleTracker(wave_model(), BEST)
    estimate = follow(tracker, unseen_wave(5))[-1]
    considered = considered_by(tracker)
    mean = considered.weights @ considered.translations
    np.testing.assert_allclose(mean, estimate.translation)
    assert list(considered.predictions) == list(PARTS)


def test_without_an_image_the_body_s_prediction_is_the_first_estimate() -> None:
    tracker = FusionTracker(wave_model())
    (estimate,) = follow(tracker, unseen_wave(1))
    considered = considered_by(tracker)
    assert len(considered.weights) == 0
    translation, rotation = considered.predictions["body"]
    np.testing.assert_allclose(translation, estimate.translation)
    assert same_rotation(rotation, estimate.rotation)


def test_each_anchor_predicts_what_is_held_near_where_it_is() -> None:
    tracker, joints = FusionTracker(wave_model()), unseen_wave(3)
    follow(tracker, joints)
    predictions = considered_by(tracker).predictions
    place = held(joints)[0][-1]
    off = {name: np.linalg.norm(pose[0] - place) for name, pose in predictions.items()}
    assert list(off) == [*ANCHORS, "body"]
    assert off["right hand"] < 0.03
    assert max(off.values()) < 0.3


def test_a_left_handed_person_s_predictions_are_mirrored() -> None:
    model, joints = wave_model(), unseen_wave(2)
    right, left = FusionTracker(model), FusionTracker(model, left_handed=True)
    follow(right, joints)
    follow(left, mirror_joints(joints))
    ours, theirs = considered_by(right).predictions, considered_by(left).predictions
    for name, pose in ours.items():
        translation, rotation = mirror_pose(*pose, model.shape.mirror_normal)
        np.testing.assert_allclose(theirs[name][0], translation, atol=1e-6)
        assert same_rotation(theirs[name][1], rotation, 1e-5)


def test_nothing_was_considered_of_a_body_that_is_not_seen() -> None:
    tracker = FusionTracker(wave_model())
    follow(tracker, unseen_wave(2))
    tracker.step(None, 3 * FRAME_NS)
    assert tracker.considered() is None
