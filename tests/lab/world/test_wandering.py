"""Wandering: the same walk for every camera, on feet that stand."""

import numpy as np
import pytest
from inhand_lab.world.wanderer_views import WandererCamera, wander_at, watch_wanderer
from inhand_schemas.joints import Joint

SECONDS = 8.0


def test_the_walk_is_the_same_at_whatever_times_it_is_looked_at() -> None:
    fine = wander_at(0, 3, SECONDS, np.arange(240) / 30.0).joints
    coarse = wander_at(0, 3, SECONDS, np.arange(0, 240, 3) / 30.0).joints
    np.testing.assert_allclose(coarse, fine[::3], atol=1e-12)


def test_one_foot_stands_while_the_body_goes_about() -> None:
    joints = wander_at(0, 4, SECONDS, np.arange(240) / 30.0).joints
    feet = joints[:, [Joint.ANKLE_LEFT, Joint.ANKLE_RIGHT]]
    speeds = np.linalg.norm(np.diff(feet, axis=0), axis=2) * 30.0
    assert np.quantile(speeds.min(axis=1), 0.9) < 0.3
    assert np.ptp(joints[:, 0, :2], axis=0).min() > 0.5
    assert np.abs(joints[:, 0, :2]).max() < 1.6
    assert np.linalg.norm(np.diff(joints[:, 0], axis=0), axis=1).max() * 30.0 < 2.5


def test_each_camera_sees_the_same_person_at_its_own_times() -> None:
    front = WandererCamera("front", 0.0, 3.5, 1.5)
    side = WandererCamera("side", 1.5, 3.5, 1.5, frame_rate=15.0, offset_s=-2.0, dropped_share=0.1)
    views = watch_wanderer(0, 5, SECONDS, [front, side])
    assert len(views[1].said_s) < 115
    assert views[1].said_s[0] == pytest.approx(2.0, abs=0.2)
    true = side.true_times(views[1].said_s)
    others = np.abs(true[:, None] - front.true_times(views[0].said_s)).argmin(axis=1)
    ours = side.world_from_camera.apply(views[1].joints[:, 0])
    theirs = front.world_from_camera.apply(views[0].joints[others, 0])
    assert np.nanmedian(np.linalg.norm(ours - theirs, axis=1)) < 0.05
