"""What is proposed of a mesh, and what is chosen in its place."""

import numpy as np
import pytest
from inhand_lab.new_objects.proposal import Choices, propose
from inhand_lab.objects.handled_shapes import build_box
from inhand_lab.objects.mug import mug
from inhand_runtime.errors import SettingsError
from inhand_tracker.shape.shape import Symmetry

pytestmark = pytest.mark.long
BOX = build_box("box", 0.20, 0.12, 0.05)


def test_a_mesh_beside_its_mirror_plane_is_moved_onto_it_with_marks_and_symmetries() -> None:
    move = np.array([0.03, 0.0, 0.0])
    proposed = propose("box", BOX.vertices + move, BOX.faces, BOX.marked_vertices + move)
    shape = proposed.shape
    assert proposed.mirrored
    np.testing.assert_allclose(shape.vertices, BOX.vertices, atol=1e-6)
    np.testing.assert_allclose(shape.marked_vertices, BOX.marked_vertices, atol=1e-6)
    np.testing.assert_allclose([one.centre for one in shape.symmetries], 0.0, atol=1e-5)


def test_the_simulators_mug_stays_where_it_is() -> None:
    model = mug()
    shape = propose("mug", model.vertices, model.faces, model.marked_vertices).shape
    np.testing.assert_array_equal(shape.vertices, model.vertices)
    np.testing.assert_array_equal(shape.marked_vertices, model.marked_vertices)
    np.testing.assert_array_equal(shape.mirror_normal, model.mirror_normal)
    assert shape.symmetries == ()


def test_what_is_chosen_takes_the_place_of_what_is_found() -> None:
    marks = np.array([(0.06, 0.0, 0.0), (-0.07, 0.0, 0.0), (0.0, 0.03, 0.11)])
    choices = Choices(marks, np.array([0.0, 1.0, 0.0]), (Symmetry((0.0, 0.0, 1.0), order=2),))
    shape = propose("box", BOX.vertices, BOX.faces, BOX.marked_vertices, choices).shape
    on_surface = [(0.06, 0.0, 0.0), (-0.06, 0.0, 0.0), (0.0, 0.025, 0.10)]
    np.testing.assert_allclose(shape.marked_vertices, on_surface, atol=1e-9)
    np.testing.assert_array_equal(shape.mirror_normal, [0.0, 1.0, 0.0])
    assert shape.symmetries == choices.symmetries


def test_a_mark_far_from_the_mesh_is_refused_with_how_far() -> None:
    marks = np.array([(0.06, 0.0, 0.0), (-0.06, 0.0, 0.0), (0.5, 0.0, 0.0)])
    with pytest.raises(SettingsError, match=r"--mark 50.0 0.0 0.0 lies 44.0 cm from the mesh"):
        propose("box", BOX.vertices, BOX.faces, BOX.marked_vertices, Choices(marks))


def test_a_chosen_plane_that_is_none_is_said_to_be_none() -> None:
    choices = Choices(mirror_normal=np.array([0.0, 1.0, 0.0]))
    model = mug()
    proposed = propose("mug", model.vertices, model.faces, model.marked_vertices, choices)
    assert not proposed.mirrored
    assert proposed.mirror_miss_m > 0.005
