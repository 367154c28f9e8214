"""Turns and mirror planes are found on meshes of which they are known."""

import numpy as np
import pytest
from inhand_lab.geometry.transforms import rotation_from_vector
from inhand_lab.new_objects.symmetry import SelfComparison, find_mirror, find_symmetries, reflection
from inhand_lab.objects.barbell import barbell
from inhand_lab.objects.flute import flute
from inhand_lab.objects.golf_club import golf_club
from inhand_lab.objects.hammer import hammer
from inhand_lab.objects.handled_shapes import build_box, build_mallet
from inhand_lab.objects.magnifier import magnifier
from inhand_lab.objects.model import ObjectModel
from inhand_lab.objects.mug import mug
from inhand_lab.objects.turned_shapes import build_cylinder
from inhand_lab.objects.vinegar_bottle import vinegar_bottle

pytestmark = pytest.mark.long
TURN = rotation_from_vector(np.array([0.3, -0.9, 0.5]))
NAMED = dict(zip("xyz", np.eye(3), strict=True))
MOVE = np.array([0.1, 0.0, -0.2])
KNOWN: list[tuple[ObjectModel, dict[str, int], list[int]]] = [
    (mug(), {}, []),
    (hammer(), {}, []),
    (flute(), {}, []),
    (golf_club(), {}, []),
    (vinegar_bottle(), {"z": 0}, []),
    (magnifier(), {"z": 2}, []),
    (barbell(), {"x": 0}, [2]),
    (build_mallet("mallet", 0.3, 0.12, 0.05, 0.025), {"z": 2}, []),
    (build_cylinder("cylinder", 0.1, 0.03), {"z": 0}, [2]),
    (build_box("box", 0.2, 0.12, 0.05), {"x": 2, "y": 2, "z": 2}, []),
    (build_box("pillar", 0.2, 0.06, 0.06), {"z": 4}, [2, 2]),
    (build_box("cube", 0.06, 0.06, 0.06), {"x": 4, "y": 4, "z": 4}, []),
]
"""Objects, the turns about their axes, and those about axes that lie anywhere across these."""


@pytest.mark.parametrize(("model", "axes", "across"), KNOWN, ids=[m.name for m, *_ in KNOWN])
@pytest.mark.parametrize("turn", [np.eye(3), TURN], ids=["upright", "askew"])
def test_the_turns_that_a_thing_bears_are_found_however_it_lies(
    model: ObjectModel, axes: dict[str, int], across: list[int], turn: np.ndarray
) -> None:
    moved = model.vertices @ turn.T + MOVE
    found = find_symmetries(SelfComparison(moved, model.faces))
    assert sorted(one.order for one in found) == sorted([*axes.values(), *across])
    for name, order in axes.items():
        axis = turn @ NAMED[name]
        assert any(one.order == order and abs(np.dot(one.axis, axis)) > 0.9999 for one in found), (
            name
        )
    for one in found:
        middle = turn @ ((model.vertices.min(axis=0) + model.vertices.max(axis=0)) / 2.0) + MOVE
        away = np.cross(np.array(one.centre) - middle, one.axis)
        assert np.linalg.norm(away) < 0.003


@pytest.mark.parametrize("turn", [np.eye(3), TURN], ids=["upright", "askew"])
def test_the_mirror_plane_of_a_mug_is_found_and_a_golf_club_has_none(turn: np.ndarray) -> None:
    found = find_mirror(SelfComparison(mug().vertices @ turn.T + MOVE, mug().faces))
    assert found is not None
    normal, point = found
    assert abs(normal @ turn[:, 0]) > 0.9999
    assert abs((point - MOVE) @ normal) < 0.001
    club = golf_club()
    assert find_mirror(SelfComparison(club.vertices @ turn.T, club.faces)) is None


def test_an_image_misses_by_how_far_it_is_off() -> None:
    box = build_box("box", 0.10, 0.06, 0.04)
    compared = SelfComparison(box.vertices, box.faces)
    assert compared.miss(reflection(NAMED["x"]), np.zeros(3)) < 1e-6
    quarter = rotation_from_vector(0.5 * np.pi * NAMED["z"])
    assert compared.miss(quarter, np.zeros(3)) == pytest.approx(0.01, abs=0.001)


def test_a_label_on_one_side_of_a_bottle_leaves_it_round() -> None:
    bottle = vinegar_bottle()
    ahead = bottle.vertices[bottle.faces].mean(axis=1)[:, 1] > 0.01
    faces = np.concatenate([bottle.faces, *[bottle.faces[ahead]] * 3])
    (found,) = find_symmetries(SelfComparison(bottle.vertices, faces))
    assert found.axis == (0.0, 0.0, 1.0)
    assert found.order == 0
    assert np.hypot(*found.centre[:2]) < 0.0005
