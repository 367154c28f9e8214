"""An object's folder is written whole or not at all."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.new_objects.object_folder import new_folder, write_object
from inhand_lab.objects.handled_shapes import build_box
from inhand_lab.world.messages import shape_of
from inhand_tracker.shape.shape import load_shape

BOX = shape_of(build_box("box", 0.20, 0.12, 0.05))


def test_what_a_try_left_that_was_ended_in_the_middle_is_no_matter(tmp_path: Path) -> None:
    left = tmp_path / "objects/.box.part"
    left.mkdir(parents=True)
    (left / "mesh.ply").write_text("half a file")
    folder = new_folder(tmp_path, "box")
    write_object(BOX, folder)
    np.testing.assert_allclose(load_shape(folder).vertices, BOX.vertices, atol=1e-6)
    assert [path.name for path in folder.parent.iterdir()] == ["box"]


def test_an_empty_folder_may_be_there(tmp_path: Path) -> None:
    (tmp_path / "objects/box").mkdir(parents=True)
    write_object(BOX, new_folder(tmp_path, "box"))
    assert (tmp_path / "objects/box/object.toml").is_file()


def test_what_training_would_refuse_is_not_written(tmp_path: Path) -> None:
    large = replace(BOX, vertices=30.0 * BOX.vertices, marked_vertices=30.0 * BOX.marked_vertices)
    with pytest.raises(DatasetError, match="the mesh is 6 m long"):
        write_object(large, new_folder(tmp_path, "box"))
    assert not (tmp_path / "objects").exists()
