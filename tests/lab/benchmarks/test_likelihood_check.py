"""The likelihood on real frames, and the shapes that it is checked with."""

import json
from pathlib import Path

import numpy as np
import pytest
import trimesh
from inhand_lab.benchmarks.likelihood_check import check_likelihood
from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.importers.completed_shapes import complete_box, complete_cup
from real_data import DATA

from inhand.__main__ import main

YCB = DATA / "ycb-video"

needs_real_data = pytest.mark.skipif(
    not YCB.is_dir(), reason=f"the real data are not on this machine: no {YCB}"
)


def test_three_sides_of_a_box_tell_all_of_it() -> None:
    box = trimesh.creation.box((0.1, 0.2, 0.3))
    points, faces = trimesh.sample.sample_surface(box, 20_000, seed=0)
    seen = (box.face_normals[faces] @ [1.0, 2.0, 2.0]) > 0.0
    turn = trimesh.transformations.rotation_matrix(0.7, [1.0, 1.0, 0.3], [0.2, 0.0, 0.1])
    shape = complete_box("box", trimesh.transform_points(points[seen], turn))
    whole = trimesh.Trimesh(shape.vertices, shape.faces)
    assert whole.volume == pytest.approx(0.006, rel=0.02)
    expected = trimesh.transform_points(np.zeros((1, 3)), turn)[0]
    np.testing.assert_allclose(whole.center_mass, expected, atol=0.002)


def test_a_third_of_a_cups_side_and_its_rim_tell_the_cup() -> None:
    random = np.random.default_rng(0)
    angles = random.uniform(-1.0, 1.0, 4000)
    rim = random.uniform(-np.pi, np.pi, 500)
    side = np.column_stack((np.cos(angles), np.sin(angles))) * 0.04
    lip = np.column_stack((np.cos(rim), np.sin(rim))) * 0.043
    points = np.concatenate(
        (
            np.column_stack((side, random.uniform(-0.04, 0.037, 4000))),
            np.column_stack((lip, np.full(500, 0.04))),
        )
    ) + np.array([0.01, -0.02, 0.0])
    shape = complete_cup("cup", points)
    (symmetry,) = shape.symmetries
    np.testing.assert_allclose(symmetry.centre[:2], [0.01, -0.02], atol=0.001)
    radius = np.linalg.norm(shape.vertices[:, :2] - [0.01, -0.02], axis=1)
    assert radius.max() == pytest.approx(0.043, abs=0.001)
    # Hollow: something of the bottom lies within, above the lowest point.
    assert trimesh.Trimesh(shape.vertices, shape.faces).volume < 0.3 * np.pi * 0.04**2 * 0.08


@needs_real_data
@pytest.mark.long
def test_real_objects_are_found_to_millimetres_and_the_truth_ranks_high() -> None:
    checks = check_likelihood(YCB, starts=6, scattered=3000)
    assert {check.shape for check in checks} == {"box", "cup"}
    assert len(checks) == 3
    for check in checks:
        assert check.frames == 10
        assert check.translation_mm < 5.0
        assert check.rotation_deg < 2.5
        assert check.worst_rank < 0.01


@needs_real_data
def test_the_verb_writes_what_it_shows(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        "inhand.bench.check_likelihood", lambda source: check_likelihood(source, 1, 10)
    )
    assert main(["bench", "likelihood", str(YCB), "--json", str(tmp_path / "out.json")]) == 0
    objects = json.loads((tmp_path / "out.json").read_text())["objects"]
    assert [one["name"] for one in objects] == ["009_gelatin_box", "025_mug", "061_foam_brick"]
    assert all(one["frames"] == 10 for one in objects)


def test_a_folder_without_frames_is_refused(tmp_path: Path) -> None:
    with pytest.raises(DatasetError, match="name the folder of YCB-Video"):
        check_likelihood(tmp_path)


@pytest.mark.parametrize("words", [["likelihood"], ["tracker", "somewhere"]])
def test_a_source_is_for_the_likelihood_alone(
    words: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["bench", *words]) == 2
    assert "SOURCE" in capsys.readouterr().err
