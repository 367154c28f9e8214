"""What trackers of every method do alike, with a method of three lines and with the real ones."""

import cv2
import numpy as np
import pytest
from followed import assert_proper, follow
from inhand_tracker.body.reader import Body
from inhand_tracker.geometry.estimate import LOST, Estimate
from inhand_tracker.geometry.image import Image
from inhand_tracker.methods.darby2014.tracker import ParticleTracker
from inhand_tracker.methods.darby2014.variants import VARIANTS
from inhand_tracker.methods.follower import Follower, FollowingTracker
from inhand_tracker.methods.fusion.tracker import FusionTracker
from people import FRAME_NS, HAND, STANDING, scipy_rotation, unseen_wave, wave_model
from two_sides import CAMERA, SIDES, UPRIGHT, wedge_silhouette

BEST = VARIANTS["gd-stable-proximate"]


class InTheHand(Follower):
    """The object is in the hand, and the more certainly the longer it was seen there."""

    frames = 0

    def estimate(self, body: Body, time_ns: int, image: Image | None) -> Estimate:
        self.frames += 1
        confidence = 1.0 - 0.5**self.frames
        return Estimate("tracked", confidence, body.joints[HAND], UPRIGHT, np.eye(6))

    def remember(self, body: Body, time_ns: int) -> None:
        self.frames += 1


class HandTracker(FollowingTracker):
    def __init__(self, *, left_handed: bool = False) -> None:
        super().__init__(wave_model(), left_handed=left_handed)
        self.restart()

    def _start(self, *, alone: bool) -> Follower:
        return InTheHand(self.new_reader())


def test_every_frame_is_the_follower_s_estimate() -> None:
    joints = unseen_wave(3)
    for frame, estimate in zip(joints, follow(HandTracker(), joints), strict=True):
        np.testing.assert_allclose(estimate.translation, frame[HAND])


def test_a_restart_and_a_single_frame_begin_anew() -> None:
    tracker, joints = HandTracker(), unseen_wave(3)
    assert [one.confidence for one in follow(tracker, joints)] == [0.5, 0.75, 0.875]
    assert tracker.estimate_single_frame(joints[0]).confidence == 0.5
    assert tracker.step(joints[0], 4 * FRAME_NS).confidence == 1.0 - 0.5**4
    tracker.restart()
    assert tracker.step(joints[0], 5 * FRAME_NS).confidence == 0.5


def test_frames_in_which_the_object_is_not_looked_for_are_remembered() -> None:
    tracker, joints = HandTracker(), unseen_wave(2)
    body = tracker.new_reader().read(joints[0])
    assert body is not None
    tracker.remember(body, FRAME_NS)
    assert tracker.step(joints[1], 2 * FRAME_NS).confidence == 0.75


def test_frames_that_are_skipped_are_remembered_by_their_joints() -> None:
    tracker, joints = HandTracker(), unseen_wave(2)
    tracker.remember_joints(joints[0], FRAME_NS)
    tracker.remember_joints(np.full((20, 3), np.nan), 2 * FRAME_NS)
    assert tracker.step(joints[1], 3 * FRAME_NS).confidence == 0.75


class Effort(InTheHand):
    """As sure as the effort that it may take."""

    def estimate(self, body: Body, time_ns: int, image: Image | None) -> Estimate:
        return Estimate("tracked", self.effort, body.joints[HAND], UPRIGHT, np.eye(6))


def test_a_step_takes_the_effort_that_the_tracker_has_and_a_frame_alone_takes_all(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(HandTracker, "_start", lambda self, alone: Effort(self.new_reader()))
    tracker = HandTracker()
    body = tracker.new_reader().read(STANDING)
    assert tracker.step(STANDING, FRAME_NS).confidence == 1.0
    tracker.effort = 0.25
    assert tracker.step(STANDING, FRAME_NS).confidence == 0.25
    tracker.restart()
    assert tracker.step_body(body, 2 * FRAME_NS).confidence == 0.25
    assert tracker.estimate_single_frame(STANDING).confidence == 1.0


def test_the_reader_is_of_the_tracker_s_handedness() -> None:
    for left_handed in (False, True):
        body = HandTracker(left_handed=left_handed).new_reader().read(STANDING)
        assert body is not None
        assert bool(np.isclose(body.joints[HAND, 0], STANDING[HAND, 0])) != left_handed


@pytest.mark.parametrize("gone", [None, np.full((20, 3), np.nan)])
def test_without_a_body_the_pose_is_predicted_for_a_second_and_then_lost(
    gone: np.ndarray | None,
) -> None:
    tracker = ParticleTracker(wave_model(), BEST)
    last = follow(tracker, unseen_wave(10))[-1]
    confidences, spreads = [last.confidence], [np.trace(last.covariance)]
    for number in range(11, 41):
        estimate = tracker.step(gone, number * FRAME_NS)
        if number * FRAME_NS - 10 * FRAME_NS > 1_000_000_000:
            break
        assert estimate.state == "predicted"
        np.testing.assert_array_equal(estimate.translation, last.translation)
        np.testing.assert_array_equal(estimate.rotation, last.rotation)
        confidences.append(estimate.confidence)
        spreads.append(np.trace(estimate.covariance))
    assert (np.diff(confidences) < 0).all()
    assert (np.diff(spreads) > 0).all()
    assert 0.0 <= confidences[-1] < 0.1
    lost = tracker.step(gone, 45 * FRAME_NS)
    assert (lost.state, lost.confidence, lost.translation) == ("lost", 0.0, None)
    assert tracker.step(gone, 46 * FRAME_NS).state == "lost"


def test_a_body_that_was_never_seen_is_lost() -> None:
    tracker = ParticleTracker(wave_model(), BEST)
    assert tracker.step(None, FRAME_NS).state == "lost"
    assert tracker.step(np.full((20, 3), np.nan), 2 * FRAME_NS).state == "lost"
    assert_proper(tracker.step(STANDING, 3 * FRAME_NS))


def test_going_back_in_time_without_a_body_loses_the_object() -> None:
    tracker = ParticleTracker(wave_model(), BEST)
    follow(tracker, unseen_wave(3), first=100)
    assert tracker.step(None, 50 * FRAME_NS).state == "lost"


def test_the_outline_lies_on_the_drawn_wedge_silhouette() -> None:
    tracker = ParticleTracker(wave_model(), BEST)
    pose = Estimate("tracked", 1.0, SIDES[0], UPRIGHT, np.zeros((6, 6)))
    outline = tracker.outline(pose, CAMERA)
    assert outline is not None
    contour = cv2.findContours(
        wedge_silhouette(SIDES[0], UPRIGHT), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE
    )[0][0]
    away = [abs(cv2.pointPolygonTest(contour, tuple(p), True)) for p in outline.tolist()]
    assert np.mean(away) < 1.5
    assert tracker.outline(Estimate("lost", 0.0), CAMERA) is None


def test_an_unseen_body_s_object_is_predicted_for_a_second_and_then_lost() -> None:
    one, joints = FusionTracker(wave_model()), unseen_wave(4)
    last = follow(one, joints[:3])[-1]
    states = [one.step(None, 3 * FRAME_NS + 200_000_000 * n) for n in range(1, 8)]
    assert [estimate.state for estimate in states] == ["predicted"] * 5 + ["lost"] * 2
    np.testing.assert_array_equal(states[0].translation, last.translation)
    assert states[0].confidence > states[4].confidence
    assert one.step(joints[3], 10**10).state == "tracked"


def test_a_tracker_that_saw_nobody_has_lost_it() -> None:
    assert FusionTracker(wave_model()).step(None, FRAME_NS) == LOST
    assert FusionTracker(wave_model()).estimate_single_frame(np.full((20, 3), np.nan)) == LOST
    assert FusionTracker(wave_model()).outline(LOST, CAMERA) is None


def test_the_outline_is_about_the_object() -> None:
    one = FusionTracker(wave_model())
    (estimate,) = follow(one, unseen_wave(1))
    outline = one.outline(estimate, CAMERA)
    corners = scipy_rotation(estimate.rotation).apply(wave_model().shape.vertices)
    corners = CAMERA.project(corners + estimate.translation)
    assert outline is not None
    assert (outline >= corners.min(axis=0) - 1.0).all()
    assert (outline <= corners.max(axis=0) + 1.0).all()
