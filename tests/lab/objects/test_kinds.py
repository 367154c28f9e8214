"""Every kind has the measures that it was given, and impossible ones are refused."""

import numpy as np
import pytest
from inhand_lab.objects.hammer import hammer
from inhand_lab.objects.kinds import KINDS, build_kind
from inhand_lab.objects.mug import mug
from inhand_runtime.errors import SettingsError

EXAMPLES = {
    "mug": {"height": 9.5, "diameter": 8.0, "handle": 2.5},
    "cup": {"height": 10.0, "diameter": 8.0, "foot": 6.0},
    "bottle": {"height": 25.0, "diameter": 7.0, "neck": 2.8, "shoulder": 15.0},
    "box": {"height": 20.0, "width": 12.0, "depth": 5.0},
    "can": {"height": 11.0, "diameter": 6.6},
    "cylinder": {"height": 10.0, "diameter": 3.0},
    "stick": {"length": 100.0, "diameter": 2.0},
    "hammer": {"length": 30.0, "head": 12.0, "face": 2.5, "handle": 3.0},
    "mallet": {"length": 30.0, "head": 12.0, "face": 5.0, "handle": 2.5},
    "paddle": {"length": 30.0, "blade_length": 10.0, "blade_width": 7.0, "handle": 2.0},
}
SIZES = {  # along x, y and z, cm
    "mug": (8.0, 10.5, 9.5),
    "cup": (8.0, 8.0, 10.0),
    "bottle": (7.0, 7.0, 25.0),
    "box": (12.0, 5.0, 20.0),
    "can": (6.6, 6.6, 11.0),
    "cylinder": (3.0, 3.0, 10.0),
    "stick": (2.0, 2.0, 100.0),
    "hammer": (3.15, 12.0, 30.0),
    "mallet": (5.0, 12.0, 30.0),
    "paddle": (7.0, 2.0, 30.0),
}


@pytest.mark.parametrize("kind", KINDS)
def test_a_kind_is_as_large_as_its_measures_say_closed_and_marked_on_its_surface(kind: str) -> None:
    model = build_kind("it", kind, EXAMPLES[kind])
    np.testing.assert_allclose(100.0 * np.ptp(model.vertices, axis=0), SIZES[kind], atol=0.03)
    assert model.mesh.is_watertight
    assert model.mesh.volume > 0.0
    middle = model.vertices.min(axis=0) + model.vertices.max(axis=0)
    np.testing.assert_allclose(middle[[0, 2]], 0.0, atol=1e-9)
    spreads = np.linalg.svd(model.marked_vertices - model.marked_vertices.mean(axis=0))[1]
    assert spreads[1] > 0.01
    away = np.linalg.norm(model.vertices[None] - model.marked_vertices[:, None], axis=2)
    assert away.min(axis=1).max() == 0.0


def test_the_measures_of_the_simulators_mug_and_hammer_make_them() -> None:
    made = build_kind("mug", "mug", {"height": 9.6, "diameter": 8.2, "handle": 3.9})
    np.testing.assert_allclose(made.vertices, mug().vertices, atol=1e-4)
    measures = {"length": 33.0, "head": 13.6, "face": 2.7, "handle": 3.2}
    np.testing.assert_allclose(
        build_kind("hammer", "hammer", measures).vertices, hammer().vertices, atol=1e-9
    )


@pytest.mark.parametrize(
    ("kind", "changes", "line"),
    [
        ("mug", {"height": 95.0}, "--height 95: the height of the cup of a mug is 3 to 30 cm"),
        ("mug", {"height": float("nan")}, "--height nan"),
        ("mug", {"handle": 8.5}, "--handle 8.5 of a mug must be less than --diameter 8"),
        ("mug", {"width": 3.0}, "a mug has no --width: it takes --height, --diameter, --handle"),
        ("bottle", {"neck": 7.5}, "--neck 7.5 of a bottle must be less than --diameter 7"),
        ("bottle", {"shoulder": 25.0}, "--shoulder 25 of a bottle must be less than --height 25"),
        ("hammer", {"head": 31.0}, "--head 31 of a hammer must be less than --length 30"),
        ("paddle", {"blade_length": 30.0}, "--blade-length 30 of a paddle must be less than"),
        ("stick", {"diameter": 0.0}, "--diameter 0: the diameter of a stick is"),
    ],
)
def test_an_impossible_measure_is_refused(kind: str, changes: dict[str, float], line: str) -> None:
    with pytest.raises(SettingsError) as refused:
        build_kind("it", kind, EXAMPLES[kind] | changes)
    assert str(refused.value).startswith(line)


@pytest.mark.parametrize("kind", KINDS)
def test_a_missing_measure_is_asked_for_by_its_option_and_meaning(kind: str) -> None:
    missing, *others = EXAMPLES[kind]
    with pytest.raises(SettingsError, match=f"a {kind} needs --{missing} \\("):
        build_kind("it", kind, {name: EXAMPLES[kind][name] for name in others})


@pytest.mark.parametrize("kind", KINDS)
def test_the_least_and_the_largest_measures_that_are_let_through_make_a_closed_mesh(
    kind: str,
) -> None:
    built = 0
    for end in ("least", "largest"):
        for name, measure in KINDS[kind].measures.items():
            try:
                model = build_kind("it", kind, EXAMPLES[kind] | {name: getattr(measure, end)})
            except SettingsError:
                continue
            built += 1
            assert model.mesh.is_watertight
            assert model.mesh.volume > 0.0
    assert built > 0
