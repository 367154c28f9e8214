import kernel_arrays as arrays
import numpy as np
import pytest
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.sight.kernels import projection

CORNER_LENS = (70.0, 72.0, 31.8, 24.1)
POSES = list(zip(*arrays.poses(), strict=True))


@pytest.mark.parametrize(("place", "turn"), POSES[:5])
def test_points_are_turned_and_projected_as_by_matrix_and_camera(
    place: np.ndarray, turn: np.ndarray
) -> None:
    matrix = projection.rotation_matrix(*turn)
    np.testing.assert_allclose(np.reshape(matrix, (3, 3)), rotations.to_matrix(turn), atol=1e-12)
    point = np.array(projection.rotated(matrix, 0.02, -0.03, 0.01)) + place
    expected = rotations.rotate(turn, np.array([0.02, -0.03, 0.01])) + place
    np.testing.assert_allclose(point, expected)
    camera = Intrinsics(70.0, 72.0, 31.3, 23.6, 64, 48)
    np.testing.assert_allclose(
        projection.projected(CORNER_LENS, *point), camera.project(expected) + 0.5
    )


@pytest.mark.parametrize(("place", "turn"), POSES)
def test_a_pose_is_seen_from_the_nearest_direction(place: np.ndarray, turn: np.ndarray) -> None:
    outlines, matrix = arrays.outlines(), projection.rotation_matrix(*turn)
    view = projection.view_of_pose(outlines.grid, outlines.directions, matrix, *place)
    assert view == arrays.nearest(outlines.directions, (place, turn))


@pytest.mark.parametrize("seed", range(5))
def test_a_normals_image_is_where_its_point_moves_along_it(seed: int) -> None:
    random = np.random.default_rng(seed)
    point, normal = random.normal([0.0, 0.0, 1.0], 0.1), random.normal(size=3)
    ends = [
        np.array(projection.projected(CORNER_LENS, *(point + s * normal))) for s in (-1e-6, 1e-6)
    ]
    moved = (ends[1] - ends[0]) / 2e-6
    image = np.array(projection.image_normal(CORNER_LENS, tuple(normal), *point))
    np.testing.assert_allclose(image / point[2], moved, rtol=1e-5)
    ray = tuple(point / point[2])
    np.testing.assert_allclose(projection.image_normal(CORNER_LENS, tuple(normal), *ray), image)


@pytest.mark.parametrize("degrees", np.arange(-170.0, 181.0, 10.0))
def test_a_channel_is_that_of_the_nearest_of_four_directions(degrees: float) -> None:
    normal = np.array([np.cos(np.deg2rad(degrees)), np.sin(np.deg2rad(degrees))])
    assert projection.edge_channel(*normal) == arrays.channels(normal[:, None])[0]


@pytest.mark.parametrize(
    ("u", "v", "inside"),
    [
        (0.0, 0.0, True),
        (63.9, 47.9, True),
        (64.0, 5.0, False),
        (5.0, -0.1, False),
        (np.nan, 5.0, False),
        (5.0, np.nan, False),
    ],
)
def test_pixels_in_the_image(u: float, v: float, inside: bool) -> None:
    assert projection.in_image(u, v, 64, 48) == inside


@pytest.mark.parametrize(
    ("measured", "covered"), [(0.0, False), (0.5, True), (0.97, False), (1.0, False), (2.0, False)]
)
def test_a_point_is_covered_by_what_was_measured_well_before_it(
    measured: float, covered: bool
) -> None:
    assert projection.is_covered(measured, 1.0, 0.05) == covered


def test_noise_grows_with_the_square_of_the_depth() -> None:
    assert projection.depth_noise(0.003, 0.0025, 2.0) == pytest.approx(0.013)
