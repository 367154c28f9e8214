from dataclasses import replace
from functools import lru_cache

import cv2
import numpy as np
import pytest
from followed import assert_proper
from inhand_tracker.geometry.image import Image
from inhand_tracker.methods.darby2014.depths import surfaces_of
from inhand_tracker.methods.darby2014.edges import chamfer_of
from inhand_tracker.methods.darby2014.likelihood import Likelihood
from inhand_tracker.methods.darby2014.parameters import DEFAULT_DARBY2014
from inhand_tracker.methods.darby2014.terms import DEFAULT_TERMS, TERMS, Term
from inhand_tracker.methods.darby2014.tracker import ParticleTracker
from inhand_tracker.methods.darby2014.variants import VARIANTS
from people import FRAME_NS, STANDING, held, quaternion_of, scipy_rotation, unseen_wave, wave_model
from scipy.spatial.transform import Rotation
from two_sides import CAMERA, SIDES, UPRIGHT, two_sided_model, wedge_silhouette

PLACE = np.array([0.1, -0.05, 1.5])
TURN = quaternion_of(Rotation.from_rotvec([0.5, 0.3, 0.2]))


@lru_cache(maxsize=1)
def seen() -> Image:
    """The wedge (which is convex) bright before a dark wall, 40 cm behind it."""
    shape = wave_model().shape
    corners = scipy_rotation(TURN).apply(shape.vertices) + PLACE
    pixels = CAMERA.project(corners)
    grey = np.zeros((480, 640), np.uint8)
    cv2.fillConvexPoly(grey, cv2.convexHull(np.rint(pixels).astype(np.int32)), 220)
    depth = np.full((480, 640), 1.9, np.float32)
    for face in shape.faces:
        a, b, c = corners[face]
        normal = np.cross(b - a, c - a)
        if normal @ a < 0.0:
            mask = np.zeros((480, 640), np.uint8)
            cv2.fillConvexPoly(mask, np.rint(pixels[face]).astype(np.int32), 1)
            rows, columns = np.nonzero(mask)
            rays = np.column_stack(((columns - 319.5) / 525.0, (rows - 239.5) / 525.0, rows**0))
            depth[rows, columns] = normal @ a / (rays @ normal)
    return Image(grey, CAMERA, depth)


def hypotheses(count: int = 200) -> tuple[np.ndarray, np.ndarray]:
    """The true pose first, and others 1 to 15 cm and up to 40° away."""
    random = np.random.default_rng(0)
    shifts = random.normal(size=(count, 3))
    shifts *= random.uniform(0.01, 0.15, (count, 1)) / np.linalg.norm(shifts, axis=1, keepdims=True)
    turns = Rotation.from_rotvec(random.normal(size=(count, 3)) * np.deg2rad(12.0))
    shifts[0], turns = 0.0, Rotation.concatenate([Rotation.identity(), turns[1:]])
    return PLACE + shifts, quaternion_of(turns * scipy_rotation(TURN))


@pytest.mark.parametrize("terms", [("edges",), ("depth",), ("edges", "depth")])
def test_the_true_pose_is_among_the_best(terms: tuple[Term, ...]) -> None:
    log_weights = Likelihood(wave_model(), terms).log_weights(*hypotheses(), seen())
    assert np.mean(log_weights > log_weights[0]) < 0.03


@pytest.mark.parametrize("terms", [("edges",), ("depth",)])
def test_what_is_far_away_weighs_less_than_what_is_near(terms: tuple[Term, ...]) -> None:
    places = PLACE + np.array([[0.0, 0, 0], [0.02, 0, 0], [0.12, 0, 0]])
    weights = Likelihood(wave_model(), terms).log_weights(places, np.tile(TURN, (3, 1)), seen())
    assert weights[0] > weights[1] > weights[2]


def test_terms_add_up() -> None:
    both, edges, depth = (
        Likelihood(wave_model(), terms).log_weights(*hypotheses(), seen())
        for terms in (TERMS, ("edges",), ("depth",))
    )
    np.testing.assert_allclose(both, edges + depth)


def test_the_published_term_is_the_default() -> None:
    assert DEFAULT_TERMS == ("edges",)
    assert TERMS == ("edges", "depth")


def test_a_term_of_which_the_image_holds_nothing_is_left_out() -> None:
    image = seen()
    flat = np.zeros(200)
    for terms, partial in (
        (("depth",), replace(image, depth=None)),
        (("edges",), replace(image, grey=None)),
        ((), image),
    ):
        weights = Likelihood(wave_model(), terms).log_weights(*hypotheses(), partial)
        np.testing.assert_array_equal(weights, flat)


def test_models_of_older_releases_get_their_surfaces_when_depth_asks_for_them() -> None:
    model = wave_model()
    old = replace(model, viewpoints=replace(model.viewpoints, surfaces=None))
    expected, given = (
        Likelihood(one, ("depth",)).log_weights(*hypotheses(), seen()) for one in (model, old)
    )
    np.testing.assert_array_equal(given, expected)


def test_an_image_is_prepared_once_for_all_objects() -> None:
    image = replace(seen())
    assert image.once(chamfer_of) is image.once(chamfer_of)
    assert image.once(surfaces_of) is image.once(surfaces_of)


# --- In a tracker

STILL = replace(DEFAULT_DARBY2014, advance=0.0)
BEST = VARIANTS["gd-stable-proximate"]
OTHER_SIDE = [0, 1, 2, 3, 8, 9, 10, 11, 4, 5, 6, 7, 16, 17, 18, 19, 12, 13, 14, 15]
MIRROR = np.diag([-1.0, 1.0, 1.0])


def test_edges_weigh_a_single_frame_too() -> None:
    tracker = ParticleTracker(two_sided_model(), VARIANTS["gd-hand"], seed=1)
    image = Image(wedge_silhouette(SIDES[0], UPRIGHT), CAMERA)
    away = [
        np.linalg.norm(tracker.estimate_single_frame(STANDING, shown).translation - SIDES[0])
        for shown in (None, image)
    ]
    assert away[1] < away[0]


def errors_at(side: int, method: str, *, seen: bool) -> np.ndarray:
    tracker = ParticleTracker(two_sided_model(), VARIANTS[method], parameters=STILL, seed=1)
    image = Image(wedge_silhouette(SIDES[side], UPRIGHT), CAMERA) if seen else None
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
    joints = unseen_wave(8)
    blank = Image(np.full((480, 640), 90, np.uint8), CAMERA)
    plain, shown = (ParticleTracker(wave_model(), BEST, seed=2) for _ in range(2))
    for number, frame in enumerate(joints):
        without = plain.step(frame, (number + 1) * FRAME_NS)
        with_image = shown.step(frame, (number + 1) * FRAME_NS, blank)
        np.testing.assert_allclose(with_image.translation, without.translation, atol=1e-12)


def test_an_object_behind_the_camera_is_still_estimated() -> None:
    image = Image(wedge_silhouette(SIDES[0], UPRIGHT), CAMERA)
    tracker = ParticleTracker(wave_model(), BEST)
    for number, frame in enumerate(unseen_wave(5) - [0.0, 0.0, 4.0]):
        assert_proper(tracker.step(frame, (number + 1) * FRAME_NS, image))


def test_the_mirrored_image_of_a_left_handed_person_gives_the_mirrored_pose() -> None:
    joints = unseen_wave(10)
    places, turns = held(joints, seed=7)
    right = ParticleTracker(wave_model(), VARIANTS["gd-random"])
    left = ParticleTracker(wave_model(), VARIANTS["gd-random"], left_handed=True)
    centred = replace(CAMERA)  # cx = (640 - 1) / 2: mirroring the pixels mirrors the scene
    for number, frame in enumerate(joints):
        grey = wedge_silhouette(places[number], turns[number])
        time_ns = (number + 1) * FRAME_NS
        expected = right.step(frame, time_ns, Image(grey, centred))
        flipped = Image(np.ascontiguousarray(grey[:, ::-1]), centred)
        estimate = left.step(frame[OTHER_SIDE] @ MIRROR, time_ns, flipped)
        # The boundary's points begin elsewhere in the mirrored view: not to the last digit.
        np.testing.assert_allclose(estimate.translation, MIRROR @ expected.translation, atol=0.02)
