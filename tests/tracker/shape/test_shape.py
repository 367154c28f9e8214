from pathlib import Path

import numpy as np
import pytest
from inhand_runtime.errors import InhandError
from inhand_tracker.shape.shape import ObjectShape, Symmetry, load_shape, save_shape
from people import wedge

OBJECT_TOML = """
marked_vertices = [[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0]]
mirror_normal = [0, 3, 4]
[[symmetries]]
axis = [0, 0, 1]
"""
TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"


def folder_with(tmp_path: Path, toml: str = OBJECT_TOML, **meshes: str | bytes) -> Path:
    folder = tmp_path / "mug"
    folder.mkdir()
    (folder / "object.toml").write_text(toml, encoding="utf-8")
    for suffix, content in (meshes or {"obj": TRIANGLE}).items():
        data = content.encode() if isinstance(content, str) else content
        (folder / f"mesh.{suffix}").write_bytes(data)
    return folder


def assert_same(first: ObjectShape, second: ObjectShape) -> None:
    assert first.name == second.name
    np.testing.assert_allclose(first.vertices, second.vertices, atol=1e-6)
    np.testing.assert_array_equal(first.faces, second.faces)
    np.testing.assert_array_equal(first.marked_vertices, second.marked_vertices)
    np.testing.assert_allclose(first.mirror_normal, second.mirror_normal, atol=1e-15)
    assert first.symmetries == second.symmetries


def test_a_shape_is_read_as_it_was_written(tmp_path: Path) -> None:
    save_shape(wedge(), tmp_path / "objects" / "wedge")
    assert_same(load_shape(tmp_path / "objects" / "wedge"), wedge())


def test_a_hand_written_folder_is_read(tmp_path: Path) -> None:
    shape = load_shape(folder_with(tmp_path))
    assert shape.name == "mug"
    assert shape.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    assert shape.faces.tolist() == [[0, 1, 2]]
    assert shape.mirror_normal.tolist() == [0.0, 0.6, 0.8]
    assert shape.symmetries == (Symmetry((0.0, 0.0, 1.0), (0.0, 0.0, 0.0), 0),)


FIRST_LINE = "marked_vertices = [[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0]]\n"


def test_what_is_not_said_has_a_default(tmp_path: Path) -> None:
    shape = load_shape(folder_with(tmp_path, FIRST_LINE))
    assert shape.mirror_normal.tolist() == [1.0, 0.0, 0.0]
    assert shape.symmetries == ()


@pytest.mark.parametrize(
    ("toml", "message"),
    [
        ("", "marks 0 vertices"),
        ("marked_vertices = [[0, 0, 0], [1, 0, 0]]", "marks 2 vertices"),
        ("marked_vertices = [[0, 0], [1, 0], [0, 1], [1, 1], [2, 1], [3, 1]]", "three numbers"),
        ("marked_vertices = [0, 0, 0, 1, 0, 0, 0, 1, 0]", "three numbers"),
        ("marked_vertices = [[0, 0, 0], [1, 0]]", "object.toml"),
        ('marked_vertices = "all"', "object.toml"),
        ("marked_vertices = 3", "three numbers"),
        ("marked_vertices = [[0, 0, nan], [1, 0, 0], [0, 1, 0]]", "not finite"),
        ("marked_vertices = [[0, 0, inf], [1, 0, 0], [0, 1, 0]]", "not finite"),
        (f"marked_vertices = [[0, 0, 1{'0' * 400}], [1, 0, 0], [0, 1, 0]]", "object.toml"),
        (FIRST_LINE + "mirror_normal = [0, 0, 0]", "mirror_normal"),
        (FIRST_LINE + "mirror_normal = [0, 1]", "three numbers"),
        (FIRST_LINE + "mirror_normal = [nan, 0, 1]", "not finite"),
        (FIRST_LINE + 'name = "My Mug"', "name"),
        (FIRST_LINE + "name = 3.5", "3.5"),
        (FIRST_LINE + "[[symmetries]]\norder = 2", "axis"),
        (FIRST_LINE + "[[symmetries]]\naxis = [0, 0, 1, 0, 0, 1]", "object.toml"),
        (FIRST_LINE + "[[symmetries]]\naxis = [0, 0, 1]\norder = inf", "object.toml"),
        (FIRST_LINE + "symmetries = [1, 2]", "object.toml"),
        (FIRST_LINE + "symmetries = 4", "object.toml"),
        (FIRST_LINE + "symmetries = [1, 2]", "write [[symmetries]]"),
        (FIRST_LINE + "[[symmetries]]\norder = 2", "lacks its axis"),
        (FIRST_LINE + "[[symmetries]]\naxis = [0, 0, 0]", "axis has no length"),
        (FIRST_LINE + "[[symmetries]]\naxis = [0, 0, 1]\norder = -3", "order is -3: write a whole"),
        (FIRST_LINE + "[[symmetries]]\naxis = [0, 0, 1]\norder = 2.7", "order is 2.7"),
        (FIRST_LINE + "[[symmetries]]\naxis = [0, 0, 1]\norder = true", "order is True"),
        (FIRST_LINE + '[[symmetries]]\naxis = [0, 0, 1]\norder = "2"', "order is '2'"),
        (FIRST_LINE + "[[symmetries]]\naxis = [0, 0, 1]\norder = nan", "order is nan"),
        (FIRST_LINE + 'units = "mm"', "unknown key units: mesh and marked_vertices are in metres"),
        (FIRST_LINE + "Scale = 0.001", "unknown key Scale: mesh and marked_vertices are in metres"),
        (
            FIRST_LINE + "mirror_norml = [0, 1, 0]",
            "unknown key mirror_norml (did you mean mirror_normal?)",
        ),
        (
            FIRST_LINE + "colour = 3",
            "colour (there are: name, mirror_normal, marked_vertices, symmetries)",
        ),
        (
            FIRST_LINE + "[[symmetries]]\naxis = [0, 0, 1]\ncenter = [0, 0, 0]",
            "unknown key symmetries.center (did you mean centre?)",
        ),
        ("marked_vertices = [[", "no TOML"),
    ],
)
def test_a_wrong_description_is_refused_with_its_file(
    tmp_path: Path, toml: str, message: str
) -> None:
    with pytest.raises(InhandError, match=r"object\.toml") as caught:
        load_shape(folder_with(tmp_path, toml))
    assert message in str(caught.value)


def test_a_description_with_a_byte_order_mark_is_read(tmp_path: Path) -> None:
    assert load_shape(folder_with(tmp_path, "\ufeff" + FIRST_LINE)).name == "mug"


def test_an_order_that_is_written_as_a_whole_float_is_read(tmp_path: Path) -> None:
    toml = FIRST_LINE + "[[symmetries]]\naxis = [0, 0, 1]\norder = 2.0"
    assert load_shape(folder_with(tmp_path, toml)).symmetries[0].order == 2


def test_text_that_is_no_utf8_is_refused(tmp_path: Path) -> None:
    folder = folder_with(tmp_path)
    (folder / "object.toml").write_bytes(b"name = '\xff\xfe'")
    with pytest.raises(InhandError, match="no TOML"):
        load_shape(folder)


def test_a_missing_folder_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InhandError, match=r"cannot read .*nowhere"):
        load_shape(tmp_path / "nowhere")


def test_a_folder_without_a_mesh_is_refused(tmp_path: Path) -> None:
    folder = folder_with(tmp_path)
    (folder / "mesh.obj").unlink()
    with pytest.raises(InhandError, match="holds no mesh"):
        load_shape(folder)


PLY = """ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
element face 1
property list uchar int vertex_indices
end_header
0 0 0
1 0 0
0 1 {}
3 0 1 {}
"""


@pytest.mark.parametrize(
    "mesh",
    [
        {"obj": ""},
        {"obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\n"},
        {"ply": b"\x00\x01\x02"},
        {"ply": b"ply\nformat ascii 1.0\n"},
        {"stl": b"solid \xff"},
        {"xyz": b"0 0 0\n"},
        {"unheard_of": b"0 0 0\n"},
        {"ply": PLY.format("nan", 2)},
        {"ply": PLY.format("0", 900_000)},
        {"ply": PLY.format("0", -7)},
    ],
)
def test_a_mesh_that_cannot_be_used_is_refused(
    tmp_path: Path, mesh: dict[str, str | bytes]
) -> None:
    with pytest.raises(InhandError, match=r"mesh\."):
        load_shape(folder_with(tmp_path, **mesh))
