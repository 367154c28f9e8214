"""Objects: what is marked on them, and what returns depth."""

import numpy as np
import pytest
from inhand_lab.objects.model import RETURN_NO_DEPTH, build_model, reflected, tube
from inhand_lab.world.interactions import INTERACTIONS
from trimesh import creation


def test_eight_objects_return_nothing() -> None:
    assert len(RETURN_NO_DEPTH) == 8
    for interaction in INTERACTIONS.values():
        model = interaction.object_model()
        assert model.returns_depth == (model.name not in RETURN_NO_DEPTH)


@pytest.mark.parametrize("interaction", INTERACTIONS)
def test_marks_are_vertices_and_every_vertex_has_a_colour(interaction: str) -> None:
    model = INTERACTIONS[interaction].object_model()
    vertices = {tuple(vertex) for vertex in model.vertices}
    assert {tuple(mark) for mark in model.marked_vertices} <= vertices
    assert len(model.vertex_colours) == len(model.vertices)


def test_a_mark_moves_to_the_nearest_vertex_and_parts_keep_their_colours() -> None:
    box = creation.box(extents=(2.0, 2.0, 2.0))
    model = build_model("cube", [(box, (1, 2, 3))], [(0.9, 1.2, 0.8)])
    assert np.array_equal(model.marked_vertices, [[1.0, 1.0, 1.0]])
    assert np.array_equal(np.unique(model.vertex_colours, axis=0), [[1, 2, 3]])
    assert model.returns_depth


def test_a_tube_is_closed_and_so_is_its_mirror_image() -> None:
    bent = tube(np.array([(0.1, 0.0, 0.0), (0.1, 0.2, 0.0), (0.1, 0.3, 0.2)]), 0.01)
    assert bent.is_watertight
    mirrored = reflected(bent)
    assert mirrored.volume == pytest.approx(bent.volume)
    assert mirrored.vertices[:, 0].max() < 0.0
