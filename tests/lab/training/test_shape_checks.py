"""Meshes and marks in other units, places and axes than metres in the object's frame."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.training.shape_checks import check_shape
from inhand_lab.world.interactions import INTERACTIONS
from inhand_lab.world.messages import shape_of
from inhand_tracker.shape.shape import ObjectShape

FOLDER = Path("objects/mug")
MUG = shape_of(INTERACTIONS["drinkFromMug"].object_model())
BOX_CORNERS = np.array([MUG.vertices.min(axis=0), MUG.vertices.max(axis=0)])
QUARTER_ABOUT_X = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])


def meshed(change: Callable[[np.ndarray], np.ndarray]) -> ObjectShape:
    return replace(MUG, vertices=change(MUG.vertices))


def marked(marks: object) -> ObjectShape:
    return replace(MUG, marked_vertices=np.array(marks, float))


def scaled(factor: float) -> ObjectShape:
    shape = meshed(lambda vertices: vertices * factor)
    return replace(shape, marked_vertices=MUG.marked_vertices * factor)


def refusal(shape: ObjectShape) -> str:
    with pytest.raises(DatasetError) as caught:
        check_shape(shape, FOLDER)
    message = str(caught.value)
    assert message.startswith(f"{FOLDER}: ")
    assert "\n" not in message
    return message


@pytest.mark.parametrize("interaction", INTERACTIONS)
def test_every_simulated_object_is_taken(interaction: str) -> None:
    check_shape(shape_of(INTERACTIONS[interaction].object_model()), FOLDER)


@pytest.mark.parametrize(
    ("shape", "size", "mend"),
    [
        (
            meshed(lambda v: v * 1000.0),
            "121 m long",
            "in millimetres; scale it to metres, by 0.001",
        ),
        (meshed(lambda v: v * 100.0), "12.1 m long", "in centimetres; scale it to metres, by 0.01"),
        (meshed(lambda v: v * 39.37), "4.75 m long", "in inches; scale it to metres, by 0.0254"),
        (meshed(lambda v: v * 0.001), "0.121 mm long", "scale it to metres"),
        (
            scaled(1000.0),
            "121 m long",
            "it and marked_vertices to metres, by 0.001 from millimetres",
        ),
        (scaled(100.0), "12.1 m long", "by 0.01 from centimetres (12.1 cm)"),
        (scaled(0.001), "0.121 mm long", "scale it and marked_vertices to metres"),
        (meshed(lambda v: v * 1e-30), "mm long", "scale it to metres"),
        (meshed(lambda v: v * 0.0), "0 mm long", "scale it to metres"),
    ],
)
def test_a_mesh_that_is_not_metres_is_refused_with_its_size(
    shape: ObjectShape, size: str, mend: str
) -> None:
    message = refusal(shape)
    assert size in message
    assert mend in message


@pytest.mark.parametrize(
    ("shape", "distance", "mend"),
    [
        (
            meshed(lambda v: v + np.array([0.5, 0.0, 0.0])),
            "50 cm",
            "move the mesh by about [-0.5, 0, 0] m",
        ),
        (
            meshed(lambda v: v + np.array([0.0, 0.0, 0.9])),
            "90 cm",
            "move the mesh by about [0, 0, -0.9] m",
        ),
        (meshed(lambda v: v @ QUARTER_ABOUT_X.T), "cm", "y points up in the mesh"),
        (meshed(lambda v: v @ QUARTER_ABOUT_X), "cm", "y points down in the mesh"),
        (marked(MUG.marked_vertices * 1000.0), " m from", "marks seem to be in millimetres"),
        (marked(MUG.marked_vertices * 100.0), " m from", "marks seem to be in centimetres"),
        (marked(MUG.marked_vertices * 39.37), " m from", "marks seem to be in inches"),
        (marked([[41, 0, 48], [-41, 0, 48], [0, 41, 48]]), " m from", "mark"),
        (marked([*MUG.marked_vertices, [0.0, 0.0, 0.3]]), "cm from", "mark vertices of the mesh"),
    ],
)
def test_marks_off_the_mesh_are_refused_with_how_far_they_lie(
    shape: ObjectShape, distance: str, mend: str
) -> None:
    message = refusal(shape)
    assert distance in message
    assert mend in message


def test_marks_that_cover_too_little_of_the_mesh_are_refused() -> None:
    broom = shape_of(INTERACTIONS["sweepFloor"].object_model())
    shape = replace(broom, marked_vertices=MUG.marked_vertices * 0.2)
    assert "cover 2.41 cm of a mesh that is 1.38 m long" in refusal(shape)


@pytest.mark.parametrize(
    ("marks", "words"),
    [
        ([[0, 0, 0]] * 3, "3 marked_vertices are all one point"),
        (MUG.marked_vertices * 0.001, "are all one point"),
        ([[0, 0, 0], [0, 0, 0.05], [0, 0, 0.1]], "lie on one line"),
        ([[0, 0, 0], [0, 0, 0], [0.02, 0.02, 0.02], [0.03, 0.03, 0.03]], "lie on one line"),
    ],
)
def test_marks_that_do_not_show_every_turn_are_refused(marks: object, words: str) -> None:
    assert words in refusal(marked(marks))


def test_corners_of_the_box_around_a_mesh_may_be_marked() -> None:
    low, high = BOX_CORNERS
    check_shape(marked([low, high, [low[0], high[1], high[2]]]), FOLDER)


def test_markers_that_stand_out_of_the_surface_may_be_marked() -> None:
    outwards = np.sign(MUG.marked_vertices) * 0.008
    check_shape(marked(MUG.marked_vertices + outwards), FOLDER)
