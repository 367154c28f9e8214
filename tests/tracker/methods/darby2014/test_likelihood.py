from dataclasses import replace
from functools import lru_cache

import cv2
import numpy as np
import pytest
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.image import Image
from inhand_tracker.methods.darby2014.depths import surfaces_of
from inhand_tracker.methods.darby2014.edges import chamfer_of
from inhand_tracker.methods.darby2014.likelihood import DEFAULT_TERMS, TERMS, Likelihood, Term
from people import quaternion_of, scipy_rotation, wave_model
from scipy.spatial.transform import Rotation

CAMERA = Intrinsics(525.0, 525.0, 319.5, 239.5, 640, 480)
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
