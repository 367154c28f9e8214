from dataclasses import replace
from functools import lru_cache

import cv2
import numpy as np
import pytest
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.estimate import Estimate
from inhand_tracker.geometry.image import Image
from inhand_tracker.mapping.learning import LabelledSequence, learn
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

CAMERA = Intrinsics(525.0, 525.0, 319.5, 239.5, 640, 480)
OTHER_SIDE = [0, 1, 2, 3, 8, 9, 10, 11, 4, 5, 6, 7, 16, 17, 18, 19, 12, 13, 14, 15]
MIRROR = np.diag([-1.0, 1.0, 1.0])
BEST = VARIANTS["gd-stable-proximate"]


def unseen_person(frames: int = 20) -> np.ndarray:
    return waving(frames, seed=7, speed=0.23)


def follow(tracker: ParticleTracker, joints: np.ndarray, first: int = 1) -> list[Estimate]:
    return [tracker.step(frame, (first + number) * FRAME_NS) for number, frame in enumerate(joints)]


def tracked(method: str, joints: np.ndarray, **options: object) -> list[Estimate]:
    return follow(ParticleTracker(wave_model(), VARIANTS[method], **options), joints)


def assert_proper(estimate: Estimate) -> None:
    """A pose of finite numbers, a unit quaternion and a covariance that is one."""
    assert estimate.state == "tracked"
    assert 0.0 <= estimate.confidence <= 1.0
    assert np.isfinite(estimate.translation).all()
    assert np.linalg.norm(estimate.rotation) == pytest.approx(1.0)
    np.testing.assert_allclose(estimate.covariance, estimate.covariance.T, atol=1e-12)
    assert np.linalg.eigvalsh(estimate.covariance).min() > -1e-12


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


def test_edges_weigh_a_single_frame_too() -> None:
    tracker = ParticleTracker(two_sided_model(), VARIANTS["gd-hand"], seed=1)
    image = Image(silhouette(SIDES[0], UPRIGHT), CAMERA)
    away = [
        np.linalg.norm(tracker.estimate_single_frame(STANDING, shown).translation - SIDES[0])
        for shown in (None, image)
    ]
    assert away[1] < away[0]


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


@pytest.mark.parametrize("gone", [None, np.full((20, 3), np.nan)])
def test_without_a_body_the_pose_is_predicted_for_a_second_and_then_lost(
    gone: np.ndarray | None,
) -> None:
    tracker = ParticleTracker(wave_model(), BEST)
    last = follow(tracker, unseen_person(10))[-1]
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


def test_a_body_that_was_never_seen_is_lost() -> None:
    tracker = ParticleTracker(wave_model(), BEST)
    assert tracker.step(None, FRAME_NS).state == "lost"
    assert tracker.step(np.full((20, 3), np.nan), 2 * FRAME_NS).state == "lost"
    assert_proper(tracker.step(STANDING, 3 * FRAME_NS))


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


def test_going_back_in_time_without_a_body_loses_the_object() -> None:
    tracker = ParticleTracker(wave_model(), BEST)
    follow(tracker, unseen_person(3), first=100)
    assert tracker.step(None, 50 * FRAME_NS).state == "lost"


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


# --- Edges


def silhouette(translation: np.ndarray, rotation: np.ndarray, value: int = 220) -> np.ndarray:
    """The wedge (which is convex) drawn bright on black."""
    corners = scipy_rotation(rotation).apply(wave_model().shape.vertices) + translation
    pixels = corners[:, :2] / corners[:, 2:] * 525.0 + [319.5, 239.5]
    grey = np.zeros((480, 640), np.uint8)
    cv2.fillConvexPoly(grey, cv2.convexHull(np.rint(pixels).astype(np.int32)), value)
    return grey


SIDES = (np.array([-0.16, -0.13, 2.0]), np.array([-0.32, -0.13, 2.0]))
UPRIGHT = quaternion_of(Rotation.from_rotvec([0.5, 0.3, 0.2]))


@lru_cache(maxsize=1)
def two_sided_model() -> Model:
    """A person who stands still, while the object is at one of two places 16 cm apart."""
    joints = np.repeat(STANDING[None], 40, axis=0)
    turns = np.tile(UPRIGHT, (40, 1))
    sequences = [
        LabelledSequence(f"p{i}", False, joints, np.repeat(SIDES, 20, axis=0)[:: 1 - 2 * i], turns)
        for i in range(2)
    ]
    return replace(wave_model(), mapping=learn(sequences, np.array([1.0, 0.0, 0.0])))


STILL = replace(DEFAULT_DARBY2014, advance=0.0)


def errors_at(side: int, method: str, *, seen: bool) -> np.ndarray:
    tracker = ParticleTracker(two_sided_model(), VARIANTS[method], parameters=STILL, seed=1)
    image = Image(silhouette(SIDES[side], UPRIGHT), CAMERA) if seen else None
    return np.array(
        [
            np.linalg.norm(
                tracker.step(STANDING, (number + 1) * FRAME_NS, image).translation - SIDES[side]
            )
            for number in range(40)
        ]
    )


@pytest.mark.parametrize("side", [0, 1])
def test_edges_pull_each_estimate_towards_the_truth(side: int) -> None:
    """Discriminative particles take both places alike; the weights of one frame decide."""
    blind, seen = (errors_at(side, "gd-hand", seen=seen) for seen in (False, True))
    assert blind.mean() == pytest.approx(0.08, abs=0.01)
    assert seen.mean() < 0.8 * blind.mean()


@pytest.mark.parametrize("side", [0, 1])
def test_edges_decide_over_time_where_particles_live_on(side: int) -> None:
    seen = errors_at(side, "g-hand", seen=True)[-10:]
    assert seen.mean() < 0.02
    blind = [errors_at(s, "g-hand", seen=False)[-10:].mean() for s in (0, 1)]
    assert np.mean(blind) > 0.06


def test_an_image_without_edges_changes_nothing() -> None:
    joints = unseen_person(8)
    blank = Image(np.full((480, 640), 90, np.uint8), CAMERA)
    plain, shown = (ParticleTracker(wave_model(), BEST, seed=2) for _ in range(2))
    for number, frame in enumerate(joints):
        without = plain.step(frame, (number + 1) * FRAME_NS)
        with_image = shown.step(frame, (number + 1) * FRAME_NS, blank)
        np.testing.assert_allclose(with_image.translation, without.translation, atol=1e-12)


def test_an_object_behind_the_camera_is_still_estimated() -> None:
    image = Image(silhouette(SIDES[0], UPRIGHT), CAMERA)
    tracker = ParticleTracker(wave_model(), BEST)
    for number, frame in enumerate(unseen_person(5) - [0.0, 0.0, 4.0]):
        assert_proper(tracker.step(frame, (number + 1) * FRAME_NS, image))


def test_the_mirrored_image_of_a_left_handed_person_gives_the_mirrored_pose() -> None:
    joints = unseen_person(10)
    places, turns = held(joints, seed=7)
    right = ParticleTracker(wave_model(), VARIANTS["gd-random"])
    left = ParticleTracker(wave_model(), VARIANTS["gd-random"], left_handed=True)
    centred = replace(CAMERA)  # cx = (640 - 1) / 2: mirroring the pixels mirrors the scene
    for number, frame in enumerate(joints):
        grey = silhouette(places[number], turns[number])
        time_ns = (number + 1) * FRAME_NS
        expected = right.step(frame, time_ns, Image(grey, centred))
        flipped = Image(np.ascontiguousarray(grey[:, ::-1]), centred)
        estimate = left.step(frame[OTHER_SIDE] @ MIRROR, time_ns, flipped)
        # The boundary's points begin elsewhere in the mirrored view: not to the last digit.
        np.testing.assert_allclose(estimate.translation, MIRROR @ expected.translation, atol=0.02)


def test_the_outline_lies_on_the_drawn_silhouette() -> None:
    tracker = ParticleTracker(wave_model(), BEST)
    pose = Estimate("tracked", 1.0, SIDES[0], UPRIGHT, np.zeros((6, 6)))
    outline = tracker.outline(pose, CAMERA)
    assert outline is not None
    contour = cv2.findContours(
        silhouette(SIDES[0], UPRIGHT), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE
    )[0][0]
    away = [abs(cv2.pointPolygonTest(contour, tuple(p), True)) for p in outline.tolist()]
    assert np.mean(away) < 1.5
    assert tracker.outline(Estimate("lost", 0.0), CAMERA) is None
