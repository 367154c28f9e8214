"""Distances from an outline, and fits to points without noise."""

import itertools

import numpy as np
import pytest
from inhand_lab.new_objects.outline_fit import fit_box, fit_cup, fit_cylinder, outline_distances
from inhand_lab.new_objects.parameters import DEFAULT_MEASURING
from inhand_lab.objects.turned_shapes import cup_outline, cylinder_outline


def plain_distance(radius: float, height: float, outline: list[tuple[float, float]]) -> float:
    """The definition: the least distance from any piece of the polyline, by many points of it."""
    pieces = itertools.pairwise(outline)
    shares = np.linspace(0.0, 1.0, 2001)[:, None]
    points = np.concatenate([np.array(a) + shares * np.subtract(b, a) for a, b in pieces])
    return float(np.linalg.norm(points - (radius, height), axis=1).min())


def test_distances_are_those_from_the_nearest_piece_of_an_outline() -> None:
    random = np.random.default_rng(0)
    radii, heights = random.uniform(0.0, 0.1, 50), random.uniform(-0.05, 0.15, 50)
    outline = cup_outline(0.1, 0.08, 0.06)
    expected = [plain_distance(r, z, outline) for r, z in zip(radii, heights, strict=True)]
    np.testing.assert_allclose(outline_distances(radii, heights, outline), expected, atol=1e-4)


def turned_points(outline: list[tuple[float, float]], angles: tuple[float, float]) -> np.ndarray:
    """Points of a surface of revolution at (0.1, -0.2), between two angles."""
    random = np.random.default_rng(1)
    corners = np.array(outline)
    starts, along = corners[:-1], np.diff(corners, axis=0)
    lengths = np.linalg.norm(along, axis=1)
    pieces = random.choice(len(along), 3000, p=lengths / lengths.sum())
    radius, z = (starts[pieces] + random.uniform(size=(3000, 1)) * along[pieces]).T
    turn = random.uniform(*angles, 3000)
    return np.column_stack((0.1 + radius * np.cos(turn), -0.2 + radius * np.sin(turn), z))


def test_a_cylinder_is_found_by_the_half_that_faces_the_camera() -> None:
    points = turned_points(cylinder_outline(0.12, 0.07), (-np.pi, 0.0))
    fitted = fit_cylinder(points, DEFAULT_MEASURING)
    assert fitted.measures["diameter"] == pytest.approx(0.07, abs=0.002)
    assert fitted.measures["height"] == pytest.approx(0.12, abs=0.001)
    np.testing.assert_allclose(fitted.centre, [0.1, -0.2], atol=0.002)


def test_a_cup_is_found_with_its_inside() -> None:
    points = turned_points(cup_outline(0.1, 0.08, 0.06), (-np.pi, np.pi))
    fitted = fit_cup(points, DEFAULT_MEASURING)
    expected = {"height": 0.1, "diameter": 0.08, "foot": 0.06}
    assert fitted.measures == pytest.approx(expected, abs=0.001)
    assert fitted.distances.max() < 0.001


def test_a_turned_box_is_found_by_its_top_and_two_sides() -> None:
    random = np.random.default_rng(2)
    x, y, z = random.uniform(-0.5, 0.5, (3, 1000))
    half = np.full(1000, 0.5)
    faces = [(x, y, half), (x, -half, z), (half, y, z)]
    points = np.concatenate([np.column_stack(face) for face in faces]) * (0.12, 0.05, 0.2)
    turn = np.array([[np.cos(0.4), -np.sin(0.4)], [np.sin(0.4), np.cos(0.4)]])
    points[:, :2] = points[:, :2] @ turn.T + (0.3, 0.1)
    points[:, 2] += 0.1
    fitted = fit_box(points, DEFAULT_MEASURING)
    sides = sorted((fitted.measures["width"], fitted.measures["depth"]))
    np.testing.assert_allclose(sides, [0.05, 0.12], atol=0.001)
    assert fitted.measures["height"] == pytest.approx(0.2, abs=0.001)
    np.testing.assert_allclose(fitted.centre, [0.3, 0.1], atol=0.001)
