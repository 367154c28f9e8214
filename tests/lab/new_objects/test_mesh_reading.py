"""Meshes as other programs write them, whole and broken."""

from pathlib import Path

import numpy as np
import pytest
import trimesh
from inhand_lab.new_objects.mesh_reading import read_file_mesh, reduce_mesh
from inhand_lab.objects.mug import mug
from inhand_runtime.errors import InhandError, SettingsError

PLY_HEAD = "ply\nformat ascii 1.0\nelement vertex {}\n" + "".join(
    f"property float {axis}\n" for axis in "xyz"
)
FACES_HEAD = "element face {}\nproperty list uchar int vertex_indices\nend_header\n"


def ply(path: Path, vertices: list[str], faces: list[str]) -> Path:
    head = PLY_HEAD.format(len(vertices)) + FACES_HEAD.format(len(faces))
    path.write_text(head + "\n".join([*vertices, *faces]) + "\n")
    return path


def test_corners_that_triangles_share_are_joined(tmp_path: Path) -> None:
    model = mug()
    model.mesh.export(tmp_path / "mug.stl")  # which writes three corners a triangle
    mesh = read_file_mesh(tmp_path / "mug.stl")
    assert len(mesh.vertices) <= len(model.vertices)
    assert len(mesh.faces) <= len(model.faces)
    np.testing.assert_allclose(mesh.sides, np.ptp(model.vertices, axis=0), atol=1e-6)


@pytest.mark.parametrize(
    ("vertices", "faces", "line"),
    [
        (["0 0 0", "1 0 0", "0 1 0"], [], "it has no triangles"),
        ([], [], "mesh"),
        (["0 0 0", "nan 0 0", "0 1 0"], ["3 0 1 2"], "1 of its 3 vertices are no finite numbers"),
        (["0 0 0", "1 0 0", "0 inf 0"], ["3 0 1 2"], "1 of its 3 vertices are no finite numbers"),
        (["1 2 3", "1 2 3", "1 2 3"], ["3 0 1 2"], "its triangles have no area"),
        (["0 0 0", "1 0 0", "2 0 0"], ["3 0 1 2"], "its triangles have no area"),
        (["0 0 0", "1 0 0", "0 1 0"], ["3 0 1 7"], "mesh"),
    ],
)
def test_what_is_no_mesh_is_refused_in_one_line(
    vertices: list[str], faces: list[str], line: str, tmp_path: Path
) -> None:
    with pytest.raises(InhandError, match=line) as refused:
        read_file_mesh(ply(tmp_path / "bad.ply", vertices, faces))
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("name", ["empty.obj", "empty.stl", "empty.glb", "empty.ply"])
def test_an_empty_file_is_refused_in_one_line(name: str, tmp_path: Path) -> None:
    (tmp_path / name).touch()
    with pytest.raises(InhandError, match=name) as refused:
        read_file_mesh(tmp_path / name)
    assert "\n" not in str(refused.value)


def test_a_file_that_is_not_there_or_of_another_kind_is_wrong_usage(tmp_path: Path) -> None:
    with pytest.raises(SettingsError, match="is no file"):
        read_file_mesh(tmp_path / "none.stl")
    (tmp_path / "mug.step").write_text("ISO-10303-21;")
    with pytest.raises(SettingsError, match="export it as glb, obj, off, ply, stl"):
        read_file_mesh(tmp_path / "mug.step")


def test_a_missing_picture_and_material_are_no_matter(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = "mtllib gone.mtl\nusemtl paint\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n"
    (tmp_path / "a.obj").write_text(text)
    assert len(read_file_mesh(tmp_path / "a.obj").faces) == 1
    assert capsys.readouterr().err == ""


def test_a_mesh_that_is_not_closed_is_read(tmp_path: Path) -> None:
    ball = trimesh.creation.icosphere(subdivisions=2)
    ball.update_faces(np.arange(len(ball.faces)) % 5 > 0)
    ball.export(tmp_path / "open.obj")
    assert len(read_file_mesh(tmp_path / "open.obj").faces) == len(ball.faces)


@pytest.mark.long
def test_a_million_faces_are_reduced_to_a_surface_that_is_hardly_another() -> None:
    ball = trimesh.creation.icosphere(subdivisions=8, radius=0.05)
    assert len(ball.faces) > 1_000_000
    reduced = reduce_mesh(ball.vertices, ball.faces)
    assert len(reduced.faces) <= 10_000
    assert reduced.deviation_m < 1e-4
    radii = np.linalg.norm(reduced.vertices, axis=1)
    np.testing.assert_allclose(radii, 0.05, atol=2e-4)


def test_a_mesh_of_few_faces_stays_as_it_is() -> None:
    model = mug()
    vertices = model.vertices
    reduced = reduce_mesh(vertices, model.faces)
    assert reduced.vertices is vertices
    assert reduced.deviation_m == 0.0
