"""One pose that is brought to where an image shows the object."""

import numpy as np
import pytest
from inhand_lab.labelling.measured_depth import point_at
from inhand_lab.labelling.pose_refinement import refine_pose
from inhand_lab.labelling.pose_start import PickedPoint, pose_from_clicks
from inhand_lab.world.messages import shape_of
from inhand_lab.world.simulation import simulate
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.image import Image
from inhand_tracker.shape.viewpoints import find_viewpoints
from inhand_tracker.sight.appearance import Appearance
from inhand_tracker.sight.sight import Sight
from sights import CAMERA, PLACE, TURN, appearance, draw, scattered, sight


@pytest.mark.parametrize("learned", [None, appearance()])
def test_a_pose_set_by_hand_comes_to_where_the_object_is(learned: Appearance | None) -> None:
    eyes = sight(learned=learned)
    translations, turns = scattered(5, 0.03, 10.0)
    for pose in list(zip(translations, turns, strict=True))[1:]:
        found = refine_pose(eyes, draw(), pose)
        assert found.shown
        assert np.linalg.norm(found.pose[0] - PLACE) < 0.005
        assert np.rad2deg(rotations.angle_between(found.pose[1], TURN)) < 1.5


def test_an_image_that_shows_nothing_leaves_the_pose_and_says_so() -> None:
    empty = Image(None, CAMERA, np.zeros((480, 640), np.float32))
    found = refine_pose(sight(), empty, (PLACE, TURN))
    assert not found.shown
    np.testing.assert_allclose(found.pose[0], PLACE)
    assert found.moved_m < 1e-9


def test_the_same_pose_and_image_give_the_same_again() -> None:
    pose = PLACE + 0.01, TURN
    once, again = (refine_pose(sight(), draw(), pose) for _ in range(2))
    np.testing.assert_array_equal(once.pose[0], again.pose[0])


@pytest.mark.long
def test_three_clicks_on_a_simulated_frame_and_a_refinement_find_the_object() -> None:
    """What the drawn box cannot show: a sensor's noise, a hand before the object, its own shape."""
    simulation = simulate("hammerNail", 1, 5, frames=40)
    shape, sensed = shape_of(simulation.object_model), simulation.render(20)
    depth = sensed.depth.astype(np.float32) / np.float32(1000.0)
    image = Image(None, simulation.intrinsics, depth, sensed.colour)
    true = simulation.translations[20], simulation.rotations[20]
    placed = rotations.rotate(true[1], shape.vertices) + true[0]
    pixels = image.camera.project(placed)
    surface = np.array([point_at(image, pixel) for pixel in pixels])
    seen = np.flatnonzero(np.linalg.norm(surface - placed, axis=1) < 0.01)
    random = np.random.default_rng(3)
    chosen = max(
        (random.choice(seen, 3, replace=False) for _ in range(200)),
        key=lambda some: np.linalg.svd(placed[some] - placed[some].mean(axis=0))[1][1],
    )
    started = pose_from_clicks(
        [
            PickedPoint(pixels[one] + random.normal(0.0, 1.0, 2), shape.vertices[one])
            for one in chosen
        ],
        image,
    )
    sight = Sight(shape, find_viewpoints(shape))
    found = refine_pose(sight, image, started, simulation.joints_in_camera[20])
    before, after = (np.linalg.norm(pose[0] - true[0]) for pose in (started, found.pose))
    assert before < 0.03
    assert after < 0.01
    assert np.rad2deg(rotations.angle_between(found.pose[1], true[1])) < 6.0
