from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from followed import assert_proper, follow
from inhand_tracker.geometry.estimate import Estimate
from inhand_tracker.mapping.labelled_sequence import LabelledSequence
from inhand_tracker.mapping.learning import learn
from inhand_tracker.methods.darby2014.parameters import DEFAULT_DARBY2014
from inhand_tracker.methods.darby2014.tracker import ParticleTracker
from inhand_tracker.methods.darby2014.variants import VARIANTS
from inhand_tracker.model.model import Model
from people import (
    FRAME_NS,
    HAND,
    STANDING,
    held,
    move,
    quaternion_of,
    same_rotation,
    scipy_rotation,
    sequence,
    wave_model,
    waving,
)
from scipy.spatial.transform import Rotation
from two_sides import UPRIGHT

OTHER_SIDE = [0, 1, 2, 3, 8, 9, 10, 11, 4, 5, 6, 7, 16, 17, 18, 19, 12, 13, 14, 15]
MIRROR = np.diag([-1.0, 1.0, 1.0])
BEST = VARIANTS["gd-stable-proximate"]


def unseen_person(frames: int = 20) -> np.ndarray:
    return waving(frames, seed=7, speed=0.23)


def tracked(method: str, joints: np.ndarray, **options: object) -> list[Estimate]:
    return follow(ParticleTracker(wave_model(), VARIANTS[method], **options), joints)


def angle(first: np.ndarray, second: np.ndarray) -> float:
    """Degrees between two rotations."""
    turn = scipy_rotation(first) * scipy_rotation(second).inv()
    return float(np.rad2deg(turn.magnitude()))


@pytest.mark.parametrize("method", VARIANTS)
def test_an_unseen_person_s_object_is_followed(method: str) -> None:
    joints = unseen_person(40)
    places, turns = held(joints, seed=7)
    estimates = tracked(method, joints)
    for estimate in estimates:
        assert_proper(estimate)
    away = [np.linalg.norm(e.translation - p) for e, p in zip(estimates, places, strict=True)]
    turned = [angle(e.rotation, q) for e, q in zip(estimates, turns, strict=True)]
    assert np.mean(away) < (0.06 if method == "gd-random" else 0.03)
    assert np.mean(turned) < 25.0


@pytest.mark.parametrize("method", VARIANTS)
def test_a_rigid_motion_of_the_scene_moves_the_estimate_with_it(method: str) -> None:
    joints = unseen_person()
    turn, shift = Rotation.from_rotvec([0.9, -1.4, 0.6]), np.array([0.4, -0.3, 5.0])
    still = tracked(method, joints)
    moved = tracked(method, move(turn, shift, joints))
    blocks = np.kron(np.eye(2), turn.as_matrix())
    for before, after in zip(still, moved, strict=True):
        expected = turn.apply(before.translation) + shift
        np.testing.assert_allclose(after.translation, expected, atol=1e-9)
        expected = quaternion_of(turn * scipy_rotation(before.rotation))
        assert same_rotation(after.rotation, expected)
        expected = blocks @ before.covariance @ blocks.T
        np.testing.assert_allclose(after.covariance, expected, atol=1e-9)
        assert after.confidence == pytest.approx(before.confidence)


@pytest.mark.parametrize("method", VARIANTS)
def test_a_left_handed_person_s_mirror_image_gives_the_mirrored_pose(method: str) -> None:
    joints = unseen_person()
    right = tracked(method, joints)
    left = tracked(method, joints[:, OTHER_SIDE] @ MIRROR, left_handed=True)
    own = np.diag([-1.0, 1.0, 1.0])  # the wedge's plane of symmetry
    for expected, estimate in zip(right, left, strict=True):
        np.testing.assert_allclose(estimate.translation, MIRROR @ expected.translation, atol=1e-9)
        turn = MIRROR @ scipy_rotation(expected.rotation).as_matrix() @ own
        assert same_rotation(estimate.rotation, quaternion_of(Rotation.from_matrix(turn)))
        assert estimate.confidence == pytest.approx(expected.confidence)


def test_the_left_hand_matters_for_left_handed_people_only() -> None:
    joints = unseen_person(5)
    without_left = joints.copy()
    without_left[:, 4:8] += [0.05, 0.0, 0.0]
    plain, changed = tracked("gd-hand", joints), tracked("gd-hand", without_left)
    assert np.linalg.norm(plain[-1].translation - changed[-1].translation) < 0.02
    left = tracked("gd-hand", joints, left_handed=True)
    assert np.linalg.norm(left[-1].translation - joints[-1, 7]) < 0.25


@pytest.mark.parametrize("scale", [0.6, 1.3])
def test_the_object_is_as_far_from_a_small_person_as_its_size_says(scale: float) -> None:
    joints = unseen_person()
    plain = tracked("gd-stable-proximate", joints)
    scaled = tracked("gd-stable-proximate", scale * joints)
    for before, after, frame in zip(plain, scaled, joints, strict=True):
        np.testing.assert_allclose(
            after.translation - scale * frame[HAND],
            scale * (before.translation - frame[HAND]),
            atol=1e-9,
        )
        assert same_rotation(after.rotation, before.rotation)


def same(first: Estimate, second: Estimate) -> bool:
    return (
        np.array_equal(first.translation, second.translation)
        and np.array_equal(first.rotation, second.rotation)
        and np.array_equal(first.covariance, second.covariance)
    )


@pytest.mark.parametrize("method", VARIANTS)
def test_a_single_frame_gives_what_a_tracker_s_first_frame_does(method: str) -> None:
    joints = unseen_person(3)
    tracker = ParticleTracker(wave_model(), VARIANTS[method])
    for frame in joints:
        (first,) = tracked(method, frame[None])
        assert same(tracker.estimate_single_frame(frame), first)


def test_single_frames_do_not_disturb_what_is_tracked() -> None:
    joints, others = unseen_person(10), waving(10, seed=4)
    tracker = ParticleTracker(wave_model(), VARIANTS["gd-random"])
    for number, expected in enumerate(tracked("gd-random", joints)):
        tracker.estimate_single_frame(others[number] + 1.0)
        assert same(tracker.step(joints[number], (number + 1) * FRAME_NS), expected)


def test_a_single_frame_without_a_body_is_lost() -> None:
    tracker = ParticleTracker(wave_model(), BEST)
    assert tracker.estimate_single_frame(np.full((20, 3), np.nan)).state == "lost"


def test_absurd_joints_are_taken_for_missing_ones() -> None:
    joints = unseen_person(6)
    absurd, missing = joints.copy(), joints.copy()
    absurd[3:, 18:], missing[3:, 18:] = 1e150, np.nan
    for given, expected in zip(
        tracked("gd-random", absurd), tracked("gd-random", missing), strict=True
    ):
        assert same(given, expected)
    assert ParticleTracker(wave_model(), BEST).step(1e150 * joints[0], FRAME_NS).state == "lost"


def test_a_wild_first_frame_is_over_with_the_second() -> None:
    joints = unseen_person(8)
    wild = joints.copy()
    wild[0, 3] += [0.0, -3.0, 0.0]
    for before, after in zip(
        tracked("gd-stable-proximate", joints)[1:],
        tracked("gd-stable-proximate", wild)[1:],
        strict=True,
    ):
        assert np.linalg.norm(after.translation - before.translation) < 0.01


def test_one_seed_gives_one_result_and_another_seed_another() -> None:
    joints = unseen_person()
    first, again = tracked("gd-random", joints, seed=3), tracked("gd-random", joints, seed=3)
    other = tracked("gd-random", joints, seed=4)
    assert all(same(a, b) for a, b in zip(first, again, strict=True))
    assert not any(same(a, b) for a, b in zip(first, other, strict=True))


def test_trackers_do_not_disturb_each_other_nor_their_input() -> None:
    joints = unseen_person(6)
    before = joints.copy()
    one, two = (ParticleTracker(wave_model(), BEST) for _ in range(2))
    for number, frame in enumerate(joints):
        estimates = [tracker.step(frame, (number + 1) * FRAME_NS) for tracker in (one, two)]
        assert same(*estimates)
    np.testing.assert_array_equal(joints, before)


@pytest.mark.parametrize("unseen", [[4, 5, 6, 7], [13, 14, 15, 17, 18, 19], [2, 3], [3]])
def test_a_limb_that_is_lost_for_a_while_keeps_its_last_place_in_the_body(
    unseen: list[int],
) -> None:
    """In a body that only shifts, a joint at its last place in the body is where it is."""
    joints = STANDING + 0.01 * np.arange(20)[:, None, None] * [1.0, 0.0, 0.5]
    partial = joints.copy()
    partial[8:, unseen] = np.nan
    for whole, holed in zip(
        tracked("gd-random", joints), tracked("gd-random", partial), strict=True
    ):
        assert_proper(holed)
        np.testing.assert_allclose(holed.translation, whole.translation, atol=1e-9)
        assert same_rotation(holed.rotation, whole.rotation)


def test_the_hand_that_holds_the_object_may_be_missing_from_the_start() -> None:
    joints = unseen_person()
    joints[:, [9, 10, 11]] = np.nan
    for estimate in tracked("gd-hand", joints):
        assert_proper(estimate)
        # The training people's mean hand stands in.
        assert np.linalg.norm(estimate.translation - STANDING[HAND]) < 0.5


@pytest.mark.parametrize("away", [3, 20, 200])
@pytest.mark.parametrize("method", VARIANTS)
def test_the_object_is_found_again_when_the_body_returns(method: str, away: int) -> None:
    joints = unseen_person(300)
    places, _ = held(joints, seed=7)
    tracker = ParticleTracker(wave_model(), VARIANTS[method])
    follow(tracker, joints[:10])
    for number in range(10, 10 + away):
        assert tracker.step(None, (number + 1) * FRAME_NS).state in ("predicted", "lost")
    back = follow(tracker, joints[10 + away : 30 + away], first=11 + away)
    for estimate in back:
        assert_proper(estimate)
    errors = [
        np.linalg.norm(estimate.translation - place)
        for estimate, place in zip(back, places[10 + away :], strict=False)
    ]
    assert np.mean(errors) < (0.06 if method == "gd-random" else 0.04)


LAMP = np.array([0.1, -0.3, 2.1])


@lru_cache(maxsize=1)
def lamp_model() -> Model:
    """The object hangs still in the room, so that the hand tells its place only by the moment."""
    sequences = [
        replace(one, translations=np.tile(LAMP, (60, 1)), rotations=np.tile(UPRIGHT, (60, 1)))
        for one in (sequence(f"p{i}", seed=i) for i in range(3))
    ]
    return replace(wave_model(), mapping=learn(sequences, np.array([1.0, 0.0, 0.0])))


def error_after_a_leap(jump_ns: int) -> float:
    """The error of g-hand, in metres, when a frame is half a swing ahead of the one before."""
    joints = unseen_person(60)
    tracker = ParticleTracker(lamp_model(), VARIANTS["g-hand"])
    follow(tracker, joints[:30], first=1000)
    estimate = tracker.step(joints[43], 1029 * FRAME_NS + jump_ns)
    assert_proper(estimate)
    return float(np.linalg.norm(estimate.translation - LAMP))


@pytest.mark.parametrize("jump", [-10_000_000_000, -FRAME_NS, 0, 501_000_000, 10**18])
def test_after_a_jump_of_time_all_particles_are_drawn_afresh(jump: int) -> None:
    assert error_after_a_leap(jump) < 0.10


@pytest.mark.parametrize("jump", [FRAME_NS, 10 * FRAME_NS, 500_000_000])
def test_a_few_frames_that_lack_are_no_jump(jump: int) -> None:
    """g-hand's particles live on, and cannot follow the leap."""
    assert error_after_a_leap(jump) > 0.30


def test_frames_that_are_sent_twice_do_no_harm() -> None:
    tracker = ParticleTracker(wave_model(), BEST)
    for number, frame in enumerate(unseen_person(5)):
        for _ in range(3):
            assert_proper(tracker.step(frame, (number + 1) * FRAME_NS))


@pytest.mark.parametrize("method", VARIANTS)
def test_one_particle_tracks_too(method: str) -> None:
    joints = unseen_person()
    places, _ = held(joints, seed=7)
    for estimate, place in zip(
        tracked(method, joints, parameters=replace(DEFAULT_DARBY2014, particles=1)),
        places,
        strict=True,
    ):
        assert_proper(estimate)
        assert estimate.confidence == 1.0
        assert np.linalg.norm(estimate.translation - place) < 0.3


@lru_cache(maxsize=4)
def model_of(kind: str) -> Model:
    if kind == "two sequences":
        sequences = [sequence(f"p{i}", 30, seed=i) for i in range(2)]
    elif kind == "one participant":
        sequences = [sequence("p0", 30, seed=i) for i in range(2)]
    elif kind == "two frames each":
        sequences = [sequence(f"p{i}", 2, seed=i) for i in range(2)]
    else:
        joints = np.repeat(STANDING[None], 6, axis=0)
        one = LabelledSequence("p0", False, joints, *held(joints))
        sequences = [one, replace(one, participant="p1")]
    mapping = learn(sequences, wave_model().shape.mirror_normal)
    return replace(wave_model(), mapping=mapping)


@pytest.mark.parametrize("method", VARIANTS)
@pytest.mark.parametrize(
    "kind", ["two sequences", "one participant", "two frames each", "all body poses equal"]
)
def test_small_models_track(kind: str, method: str) -> None:
    joints = unseen_person()
    tracker = ParticleTracker(model_of(kind), VARIANTS[method])
    for estimate in follow(tracker, joints):
        assert_proper(estimate)
        assert np.linalg.norm(estimate.translation - STANDING[HAND]) < 0.8


@pytest.mark.parametrize("size", [1e-2, 1e2])
def test_dolls_and_giants_are_tracked(size: float) -> None:
    for estimate in tracked("gd-stable-proximate", size * unseen_person(4)):
        assert_proper(estimate)
        assert np.linalg.norm(estimate.translation) < 10 * size


def test_a_person_of_unknown_height_is_not_tracked_until_the_head_is_seen() -> None:
    headless = STANDING.copy()
    headless[3] = np.nan
    tracker = ParticleTracker(wave_model(), BEST)
    assert tracker.step(headless, FRAME_NS).state == "lost"
    assert_proper(tracker.step(STANDING, 2 * FRAME_NS))
    assert_proper(tracker.step(headless, 3 * FRAME_NS))


def test_a_degenerate_body_is_not_tracked() -> None:
    for joints in (np.zeros((20, 3)), np.full((20, 3), 2.0), np.full((20, 3), np.inf)):
        assert ParticleTracker(wave_model(), BEST).step(joints, FRAME_NS).state == "lost"
