"""``inhand object new``: what it writes, and what it refuses."""

from pathlib import Path

import numpy as np
import pytest
from inhand_lab.training.shape_checks import check_shape
from inhand_tracker.model.model_file import load_model
from inhand_tracker.shape.shape import load_shape

from inhand.__main__ import main

MUG = ["--kind", "mug", "--height", "9.5", "--diameter", "8", "--handle", "2.5"]


def new(folder: Path, *arguments: str, name: str = "my_mug") -> int:
    return main(["object", "new", name, "--dataset", str(folder), *arguments])


def line_of(capsys: pytest.CaptureFixture[str]) -> str:
    (line,) = capsys.readouterr().err.splitlines()
    return line


@pytest.mark.long
def test_a_mug_by_three_measures_becomes_an_object_with_a_picture(tmp_path: Path) -> None:
    assert new(tmp_path / "data", *MUG) == 0
    folder = tmp_path / "data/objects/my_mug"
    shape = load_shape(folder)
    check_shape(shape, folder)
    assert shape.name == "my_mug"
    np.testing.assert_allclose(np.ptp(shape.vertices, axis=0), [0.08, 0.1048, 0.095], atol=1e-4)
    assert (folder / "picture.png").stat().st_size > 10_000


@pytest.mark.long
def test_what_is_chosen_is_written(tmp_path: Path) -> None:
    marks = [*["--mark", "4", "0", "4", "--mark", "-4", "0", "4", "--mark", "0", "-4", "-4"]]
    choices = [*marks, "--symmetry", "z:4", "--symmetry", "x:2", "--mirror", "y"]
    picture = tmp_path / "a.jpg"
    assert new(tmp_path, *MUG, *choices, "--picture", str(picture)) == 0
    shape = load_shape(tmp_path / "objects/my_mug")
    expected = [(0.04, 0.0, 0.04), (-0.04, 0.0, 0.04), (0.0, -0.04, -0.04)]
    np.testing.assert_allclose(shape.marked_vertices, expected, atol=1e-3)
    np.testing.assert_array_equal(shape.mirror_normal, [0.0, 1.0, 0.0])
    assert [(one.axis, one.order) for one in shape.symmetries] == [
        ((0.0, 0.0, 1.0), 4),
        ((1.0, 0.0, 0.0), 2),
    ]
    assert picture.is_file()


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        ([], "say what it is: --mesh FILE, --from RECORD"),
        (
            ["--kind", "mug", "--height", "9.5"],
            "a mug needs --diameter (outer diam",
        ),
        ([*MUG, "--width", "3"], "a mug has no --width"),
        ([*MUG, "--mark", "1", "2", "3"], "--mark names 1 point: mark three or more"),
        ([*MUG, "--symmetry", "none", "--symmetry", "z"], "--symmetry none stands alone"),
        ([*MUG, "--picture", "a.txt"], "a.txt is no picture's name"),
    ],
)
def test_what_cannot_be_made_is_refused_in_one_line_and_nothing_is_written(
    arguments: list[str], line: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert new(tmp_path / "data", *arguments) == 2
    assert line_of(capsys).startswith(f"inhand object: {line}")
    assert not (tmp_path / "data").exists()


@pytest.mark.parametrize("text", ["q", "z:1", "z:", "z:2.5", "z:-2", ""])
def test_a_symmetry_that_is_none_is_wrong_usage(
    text: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as end:
        new(tmp_path, *MUG, "--symmetry", text)
    assert end.value.code == 2
    assert "is no symmetry: write x, y or z" in capsys.readouterr().err


def test_an_object_that_is_there_already_is_kept(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "objects/my_mug"
    folder.mkdir(parents=True)
    (folder / "object.toml").write_text("mine")
    assert new(tmp_path, *MUG) == 2
    assert "is there already: choose another name" in line_of(capsys)
    assert (folder / "object.toml").read_text() == "mine"


def test_a_name_that_is_no_key_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert new(tmp_path, *MUG, name="My-mug") == 2
    assert "'My-mug' is no name" in line_of(capsys)


@pytest.mark.long
def test_marks_that_training_would_refuse_are_refused_before_anything_is_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    marks = [*["--mark", "4", "0", "4", "--mark", "4", "0", "2", "--mark", "4", "0", "-3"]]
    assert new(tmp_path / "data", *MUG, *marks) == 1
    assert "lie on one line" in line_of(capsys)
    assert not (tmp_path / "data").exists()


@pytest.mark.long
def test_recordings_of_people_train_a_model_of_the_new_mug(tmp_path: Path) -> None:
    people = tmp_path / "people"
    simulated = ["simulate", str(people), "--interactions", "drinkFromMug", "--participants", "3"]
    assert main([*simulated, "--frames", "150", "--no-images"]) == 0
    (people / "objects/mug").rename(tmp_path / "the_simulators")
    assert new(people, *MUG, name="mug") == 0
    model = tmp_path / "mug.model"
    assert main(["train", str(people), "-o", str(model)]) == 0
    shape = load_model(model).shape
    np.testing.assert_array_equal(
        shape.vertices, load_shape(people / "objects/mug").vertices.astype(shape.vertices.dtype)
    )
