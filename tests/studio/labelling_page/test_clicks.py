"""Where clicks meet the object and the image."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from inhand_lab.labelling.keyframes import LabellingError
from inhand_studio.clicked_point import point_on
from inhand_studio.labelling_page.clicks import Picking, pixel_along
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.camera import Intrinsics
from waving import box

CAMERA = Intrinsics(525.0, 515.0, 300.0, 250.0, 640, 480)
turns = st.tuples(*[st.floats(-3.0, 3.0)] * 3).map(lambda one: rotations.from_vector(np.array(one)))
shares = st.tuples(st.integers(0, 11), st.floats(0.05, 0.45), st.floats(0.05, 0.45))


@given(rotation=turns, share=shares)
def test_a_click_meets_the_nearest_point_of_the_object(
    rotation: np.ndarray, share: tuple[int, float, float]
) -> None:
    shape, (face, first, second) = box(), share
    corners = shape.vertices[shape.faces[face]]
    point = corners[0] + first * (corners[1] - corners[0]) + second * (corners[2] - corners[0])
    place = np.array([0.2, -0.1, 1.5])
    seen = rotations.rotate(rotation, point) + place
    met = point_on(shape, (place, rotation), np.zeros(3), seen / np.linalg.norm(seen))
    there = rotations.rotate(rotation, met) + place
    assert np.linalg.norm(np.cross(there, seen)) < 1e-6
    assert np.linalg.norm(there) <= np.linalg.norm(seen) + 1e-6


def test_a_click_beside_the_object_is_refused() -> None:
    pose = np.array([0.0, 0.0, 1.5]), np.array([1.0, 0.0, 0.0, 0.0])
    with pytest.raises(LabellingError, match="beside the object"):
        point_on(box(), pose, np.zeros(3), np.array([0.3, 0.0, 1.0]))


def test_a_click_is_at_the_pixel_where_the_point_is_seen_and_refused_from_elsewhere() -> None:
    point = np.array([0.3, -0.2, 2.0])
    assert pixel_along(CAMERA, np.zeros(3), 0.1 * point) == pytest.approx(CAMERA.project(point))
    with pytest.raises(LabellingError, match="look through the camera"):
        pixel_along(CAMERA, np.array([0.1, 0.0, 0.0]), point)


def test_points_and_pixels_come_by_turns_until_three_pairs() -> None:
    picking = Picking()
    with pytest.raises(LabellingError, match="point of the object first"):
        picking.with_pixel(np.zeros(2))
    for number in range(3):
        assert not picking.done
        assert f"point {number + 1}" in picking.next_click
        picking = picking.with_point(np.full(3, number)).with_pixel(np.full(2, number))
    assert picking.done
