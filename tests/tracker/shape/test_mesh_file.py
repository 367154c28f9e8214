"""Meshes as other programs name and write them."""

import logging
from pathlib import Path

import numpy as np
import pytest
import trimesh
from inhand_runtime.errors import InhandError
from inhand_tracker.shape.mesh_file import find_mesh, read_mesh

BOX = trimesh.creation.box((0.1, 0.2, 0.3))


@pytest.mark.parametrize(
    "name", ["mesh.ply", "mesh.STL", "mesh.OBJ", "Mesh.ply", "MESH.GLB", "Mesh.Off"]
)
def test_a_mesh_is_found_and_read_in_capitals_too(tmp_path: Path, name: str) -> None:
    (tmp_path / "mesh.toml").write_text("")
    (tmp_path / "mesh.mtl").write_text("")
    data = BOX.export(file_type=name[-3:].lower())
    (tmp_path / name).write_bytes(data.encode() if isinstance(data, str) else data)
    assert find_mesh(tmp_path).name == name
    vertices, faces = read_mesh(tmp_path / name)
    np.testing.assert_allclose(np.ptp(vertices, axis=0), BOX.extents, atol=1e-6)
    assert len(faces) == 12


@pytest.mark.parametrize(
    "names", [("mesh.glb", "mesh.ply"), ("Mesh.ply", "mesh.ply"), ("mesh.STL", "mesh.obj")]
)
def test_of_two_meshes_none_is_taken(tmp_path: Path, names: tuple[str, str]) -> None:
    for name in names:
        (tmp_path / name).write_bytes(b"")
    with pytest.raises(InhandError, match="holds 2 meshes") as caught:
        find_mesh(tmp_path)
    assert all(name in str(caught.value) for name in names)


def test_a_mesh_of_another_name_is_named(tmp_path: Path) -> None:
    (tmp_path / "mug.STL").write_bytes(b"")
    with pytest.raises(InhandError, match=r"holds no mesh: add mesh\.ply.*or rename mug\.STL"):
        find_mesh(tmp_path)


def save_ply(folder: Path) -> Path:
    named = b"\ncomment TextureFile not there.jpg\nelement vertex"
    path = folder / "mesh.ply"
    path.write_bytes(BOX.export(file_type="ply").replace(b"\nelement vertex", named, 1))
    return path


def save_obj(folder: Path, *, with_materials: bool) -> Path:
    path = folder / "mesh.obj"
    corners = "".join(f"v {x} {y} {z}\n" for x, y, z in BOX.vertices) + "vt 0 0\n"
    faces = "".join("f " + " ".join(f"{v + 1}/1" for v in face) + "\n" for face in BOX.faces)
    path.write_text("mtllib mesh.mtl\n" + corners + "usemtl skin\n" + faces)
    if with_materials:
        (folder / "mesh.mtl").write_text("newmtl skin\nmap_Kd not_there.png\n")
    return path


def save_gltf(folder: Path) -> Path:
    skin = trimesh.visual.TextureVisuals(uv=np.zeros((8, 2)))
    files = trimesh.Scene(trimesh.Trimesh(BOX.vertices, BOX.faces, visual=skin)).export(
        file_type="gltf"
    )
    for name, data in files.items():
        text = data.replace(b"{", b'{"images": [{"uri": "not_there.png"}],', 1)
        (folder / name).write_bytes(text if name.endswith("gltf") else data)
    return (folder / "model.gltf").rename(folder / "mesh.gltf")


@pytest.mark.parametrize(
    "save",
    [
        save_ply,
        lambda folder: save_obj(folder, with_materials=False),
        lambda folder: save_obj(folder, with_materials=True),
        save_gltf,
    ],
    ids=["ply", "obj without materials", "obj without picture", "gltf"],
)
def test_a_picture_that_is_not_there_is_passed_over(
    tmp_path: Path, caplog: pytest.LogCaptureFixture, save: object
) -> None:
    path = save(tmp_path)  # type: ignore[operator]
    with caplog.at_level(logging.INFO):
        _, faces = read_mesh(path)
    assert len(faces) == 12
    assert caplog.text == ""
