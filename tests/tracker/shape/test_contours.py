import numpy as np
import pytest
import trimesh
from inhand_tracker.shape.contours import Contours, find_contours
from inhand_tracker.shape.parallel_view import view_axes
from inhand_tracker.shape.parameters import DEFAULT_SHAPE
from inhand_tracker.shape.shape import ObjectShape

TOWARDS_Z = np.array([[0.0, 0.0, 1.0]])


def shape_of(mesh: trimesh.Trimesh) -> ObjectShape:
    vertices = np.asarray(mesh.vertices, float)
    return ObjectShape(
        "thing", vertices, np.asarray(mesh.faces), vertices[:3], np.array([1.0, 0.0, 0.0])
    )


def ring(outer: float = 0.1, inner: float = 0.06) -> ObjectShape:
    """A flat ring about the z axis."""
    return shape_of(trimesh.creation.annulus(inner, outer, 0.02))


def net(spacing: float = 0.01) -> ObjectShape:
    """Thin bars across each other, 20 cm wide, with holes of a centimetre."""
    bars = []
    for place in np.arange(-0.1, 0.1001, spacing):
        for extents, centre in (
            ((0.2, 0.002, 0.002), (0.0, place, 0.0)),
            ((0.002, 0.2, 0.002), (place, 0.0, 0.0)),
        ):
            bar = trimesh.creation.box(extents)
            bar.apply_translation(centre)
            bars.append(bar)
    return shape_of(trimesh.util.concatenate(bars))


def around(contours: Contours) -> np.ndarray:
    return np.linalg.norm(contours.points[0, :, :2], axis=1)


def test_the_outline_of_a_ring_lies_on_both_of_its_circles_and_normals_point_off_it() -> None:
    contours = find_contours(ring(), TOWARDS_Z)
    radius = around(contours)
    outer = radius > 0.08
    assert 0.5 < outer.mean() < 0.75  # as long as the circles are
    np.testing.assert_allclose(radius[outer], 0.1, atol=0.002)
    np.testing.assert_allclose(radius[~outer], 0.06, atol=0.002)
    outwards = (contours.normals[0] * contours.points[0]).sum(axis=1) / radius
    np.testing.assert_allclose(outwards[outer], 1.0, atol=0.03)
    np.testing.assert_allclose(outwards[~outer], -1.0, atol=0.05)


def test_how_far_the_silhouette_goes_on_inwards_and_the_gap_outwards_are_told() -> None:
    contours = find_contours(ring(), TOWARDS_Z)
    outer = around(contours) > 0.08
    np.testing.assert_allclose(contours.inside[0], 0.04, atol=0.005)
    np.testing.assert_allclose(contours.outside[0][outer], DEFAULT_SHAPE.endless_m)
    np.testing.assert_allclose(contours.outside[0][~outer], 0.12, atol=0.01)


def test_the_area_is_that_of_the_silhouette() -> None:
    contours = find_contours(ring(), TOWARDS_Z)
    assert contours.areas[0] == pytest.approx(np.pi * (0.1**2 - 0.06**2), rel=0.05)


def test_holes_as_fine_as_a_net_have_no_outline() -> None:
    contours = find_contours(net(), TOWARDS_Z)
    at_rim = np.abs(contours.points[0, :, :2]).max(axis=1)
    assert (at_rim > 0.095).all()


def test_surface_points_lie_on_the_sides_that_are_seen_with_their_normals() -> None:
    box = shape_of(trimesh.creation.box((0.1, 0.2, 0.3)))
    direction = np.array([[1.0, 2.0, 2.0]]) / 3.0
    contours = find_contours(box, direction)
    halves = np.array([0.05, 0.1, 0.15])
    normals = contours.surface_normals[0]
    sides = np.argmax(normals, axis=1)
    np.testing.assert_allclose(normals, np.eye(3)[sides], atol=1e-6)
    on_side = contours.surface_points[0][np.arange(len(sides)), sides]
    np.testing.assert_allclose(on_side, halves[sides], atol=0.004)
    assert set(sides) == {0, 1, 2}


@pytest.mark.parametrize("direction", np.concatenate((np.eye(3), -np.eye(3))))
def test_normals_lie_in_the_plane_of_view_and_have_length_one(direction: np.ndarray) -> None:
    contours = find_contours(ring(), direction[None])
    np.testing.assert_allclose(np.linalg.norm(contours.normals[0], axis=1), 1.0, atol=1e-5)
    np.testing.assert_allclose(contours.normals[0] @ direction, 0.0, atol=1e-5)


def test_a_viewers_axes_are_right_handed_and_look_at_the_object() -> None:
    direction = np.array([0.6, 0.0, 0.8])
    axes = view_axes(direction)
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1.0)
    np.testing.assert_allclose(axes[2], -direction)
