"""Whole shapes from the part of a surface that was seen."""

import numpy as np
import pytest
import trimesh
from inhand_lab.importers.completed_shapes import complete_box, complete_cup


def test_three_sides_of_a_box_tell_all_of_it() -> None:
    box = trimesh.creation.box((0.1, 0.2, 0.3))
    points, faces = trimesh.sample.sample_surface(box, 20_000, seed=0)
    seen = (box.face_normals[faces] @ [1.0, 2.0, 2.0]) > 0.0
    turn = trimesh.transformations.rotation_matrix(0.7, [1.0, 1.0, 0.3], [0.2, 0.0, 0.1])
    shape = complete_box("box", trimesh.transform_points(points[seen], turn))
    whole = trimesh.Trimesh(shape.vertices, shape.faces)
    assert whole.volume == pytest.approx(0.006, rel=0.02)
    expected = trimesh.transform_points(np.zeros((1, 3)), turn)[0]
    np.testing.assert_allclose(whole.center_mass, expected, atol=0.002)


def test_a_third_of_a_cups_side_and_its_rim_tell_the_cup() -> None:
    random = np.random.default_rng(0)
    angles = random.uniform(-1.0, 1.0, 4000)
    rim = random.uniform(-np.pi, np.pi, 500)
    side = np.column_stack((np.cos(angles), np.sin(angles))) * 0.04
    lip = np.column_stack((np.cos(rim), np.sin(rim))) * 0.043
    points = np.concatenate(
        (
            np.column_stack((side, random.uniform(-0.04, 0.037, 4000))),
            np.column_stack((lip, np.full(500, 0.04))),
        )
    ) + np.array([0.01, -0.02, 0.0])
    shape = complete_cup("cup", points)
    (symmetry,) = shape.symmetries
    np.testing.assert_allclose(symmetry.centre[:2], [0.01, -0.02], atol=0.001)
    radius = np.linalg.norm(shape.vertices[:, :2] - [0.01, -0.02], axis=1)
    assert radius.max() == pytest.approx(0.043, abs=0.001)
    # Hollow: something of the bottom lies within, above the lowest point.
    assert trimesh.Trimesh(shape.vertices, shape.faces).volume < 0.3 * np.pi * 0.04**2 * 0.08
