"""The measures of a pose's error, against figures worked out by hand."""

import numpy as np
import pytest
import trimesh
from inhand_lab.datasets.tracks import Track
from inhand_lab.evaluation.pose_errors import ErrorGauge, least_angle
from inhand_tracker.shape.shape import ObjectShape, Symmetry
from scipy.spatial.transform import Rotation
from waving import box

RADIUS = 0.04
ROUND = (Symmetry((0.0, 0.0, 1.0)),)


def quaternions(*rotation_vectors: tuple[float, float, float]) -> np.ndarray:
    return Rotation.from_rotvec(np.array(rotation_vectors)).as_quat(scalar_first=True)


def track(*poses: tuple[tuple[float, float, float], tuple[float, float, float]]) -> Track:
    """Poses by translation and rotation vector."""
    return Track(np.array([pose[0] for pose in poses]), quaternions(*(pose[1] for pose in poses)))


def cylinder(symmetries: tuple[Symmetry, ...]) -> ObjectShape:
    mesh = trimesh.creation.cylinder(RADIUS, 0.1, sections=64)
    vertices = np.array(mesh.vertices)
    marks = vertices[:8]
    normal = np.array([1.0, 0.0, 0.0])
    return ObjectShape("tin", vertices, np.array(mesh.faces), marks, normal, symmetries)


def test_a_shift_is_the_same_in_every_distance_and_no_turn() -> None:
    errors = ErrorGauge(box()).compare(
        track(((0.03, 0.0, 2.04), (0.0, 1.0, 0.0))), track(((0.0, 0.0, 2.0), (0.0, 1.0, 0.0)))
    )
    for distance in (errors.vertex_m, errors.translation_m, errors.add_m):
        assert distance == pytest.approx([0.05], abs=1e-9)
    assert errors.rotation_rad == pytest.approx([0.0], abs=1e-6)


def test_a_half_turn_of_the_box_moves_its_corners_by_their_distance_across_the_axis() -> None:
    errors = ErrorGauge(box()).compare(
        track(((0.0, 0.0, 2.0), (0.0, 0.0, np.pi))), track(((0.0, 0.0, 2.0), (0.0, 0.0, 0.0)))
    )
    assert errors.vertex_m == pytest.approx([2.0 * np.hypot(0.03, 0.05)])
    assert errors.translation_m == pytest.approx([0.0])
    assert errors.rotation_rad == pytest.approx([np.pi])


def test_a_pose_that_is_missing_has_no_error_and_is_not_within_limits() -> None:
    true = track(((0.0, 0.0, 2.0), (0.0, 0.0, 0.0)), ((0.0, 0.0, 2.0), (0.0, 0.0, 0.0)))
    nothing = Track(
        np.array([[np.nan] * 3, [0.0, 0.0, 2.0]]), np.array([[np.nan] * 4, [1.0, 0.0, 0.0, 0.0]])
    )
    errors = ErrorGauge(box()).compare(nothing, true)
    assert np.isnan(errors.vertex_m).tolist() == [True, False]
    assert errors.close().tolist() == [False, True]
    assert errors.area_under_curve() == pytest.approx(0.5)


@pytest.mark.parametrize(("shift_m", "area"), [(0.0, 1.0), (0.025, 0.75), (0.1, 0.0), (0.7, 0.0)])
def test_the_area_under_the_curve_falls_evenly_to_nothing_at_10_cm(
    shift_m: float, area: float
) -> None:
    still = (0.0, 0.0, 0.0)
    errors = ErrorGauge(box()).compare(
        track(((shift_m, 0.0, 2.0), still)), track(((0.0, 0.0, 2.0), still))
    )
    assert errors.area_under_curve() == pytest.approx(area)


def test_5_cm_and_5_degrees_are_both_asked_for() -> None:
    near, far = (0.04, 0.0, 2.0), (0.06, 0.0, 2.0)
    little, much = (np.radians(4.0), 0.0, 0.0), (np.radians(6.0), 0.0, 0.0)
    true = track(*[((0.0, 0.0, 2.0), (0.0, 0.0, 0.0))] * 4)
    estimated = track((near, little), (near, much), (far, little), (far, much))
    assert ErrorGauge(box()).compare(estimated, true).close().tolist() == [
        True,
        False,
        False,
        False,
    ]


def test_a_turn_about_an_axis_of_symmetry_is_no_error_but_of_the_marked_vertices() -> None:
    turned, still = (
        track(((0.0, 0.0, 2.0), (0.0, 0.0, 1.0))),
        track(((0.0, 0.0, 2.0), (0.0, 0.0, 0.0))),
    )
    errors = ErrorGauge(cylinder(ROUND)).compare(turned, still)
    assert errors.rotation_rad == pytest.approx([0.0], abs=1e-6)
    assert errors.add_m[0] < 0.003
    assert errors.vertex_m[0] > 0.02
    assert ErrorGauge(cylinder(())).compare(turned, still).add_m[0] > 0.02


def test_the_translation_of_a_symmetric_object_is_that_of_its_centre() -> None:
    centre = np.array([0.5, 0.0, 0.0])
    shape = cylinder((Symmetry((0.0, 0.0, 1.0), tuple(centre.tolist())),))
    turn = Rotation.from_rotvec([0.0, 0.0, 1.0])
    about_centre = track((tuple((centre - turn.apply(centre)).tolist()), (0.0, 0.0, 1.0)))
    errors = ErrorGauge(shape).compare(about_centre, track(((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))))
    assert errors.translation_m == pytest.approx([0.0], abs=1e-9)


@pytest.mark.parametrize(
    ("symmetries", "turn", "left_deg"),
    [
        ((), (0.0, 0.0, 170.0), 170.0),
        ((Symmetry((0.0, 0.0, 1.0), order=2),), (0.0, 0.0, 170.0), 10.0),
        ((Symmetry((0.0, 0.0, 2.0), order=4),), (0.0, 0.0, 100.0), 10.0),
        (ROUND, (0.0, 0.0, 170.0), 0.0),
        (ROUND, (20.0, 0.0, 0.0), 20.0),
        ((*ROUND, Symmetry((1.0, 0.0, 0.0), order=2)), (175.0, 0.0, 0.0), 5.0),
        ((*ROUND, Symmetry((1.0, 0.0, 0.0), order=2)), (0.0, 175.0, 0.0), 5.0),
    ],
)
def test_the_angle_is_the_least_over_equal_poses(
    symmetries: tuple[Symmetry, ...], turn: tuple[float, float, float], left_deg: float
) -> None:
    between = quaternions(tuple(np.radians(turn).tolist()))
    assert np.degrees(least_angle(between, symmetries)) == pytest.approx([left_deg], abs=1e-5)
    assert np.degrees(least_angle(-between, symmetries)) == pytest.approx([left_deg], abs=1e-5)


def test_the_stated_deviation_is_that_of_vertices_of_drawn_poses() -> None:
    random = np.random.default_rng(0)
    root = 0.01 * random.normal(size=(6, 6))
    turn = Rotation.from_rotvec([0.4, -1.0, 0.3])
    one = Track(np.zeros((1, 3)), turn.as_quat(scalar_first=True)[None], (root @ root.T)[None])
    drawn = random.normal(size=(20000, 6)) @ root.T
    arms = turn.apply(box().marked_vertices)
    moved = drawn[:, None, :3] + np.cross(drawn[:, None, 3:], arms)
    expected = np.sqrt(np.square(moved).sum(axis=-1).mean())
    assert ErrorGauge(box()).stated_m(one)[0] == pytest.approx(expected, rel=0.02)
    assert np.isnan(ErrorGauge(box()).stated_m(Track(one.translations, one.rotations))[0])
