"""Training models from datasets: what is refused, and what a command shows."""

from collections import Counter
from collections.abc import Callable
from pathlib import Path
from shutil import copytree

import msgspec
import numpy as np
import pytest
import trimesh
from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError, load_dataset
from inhand_lab.datasets.generation import GenerationSettings, generate
from inhand_lab.training.model_summary import summarise_model
from inhand_lab.training.model_training import entries_for, model_stages, train
from inhand_runtime.errors import InhandError
from inhand_runtime.recording import RecordingWriter, read_recording
from inhand_runtime.recording.copying import write_beside
from inhand_tracker.model.model_file import load_model
from waving import write_dataset

from inhand.__main__ import main

FRAMES = 60


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Dataset:
    folder = tmp_path_factory.mktemp("made") / "people"
    return generate(
        folder, GenerationSettings(["drinkFromMug"], 3, 5, FRAMES, images=False), lambda: None
    )


@pytest.fixture
def dataset(made: Dataset, tmp_path: Path) -> Dataset:
    """A copy to spoil."""
    return load_dataset(copytree(made.folder, tmp_path / "people"))


def rewrite_labels(path: Path, change: Callable[[dict], None]) -> None:
    """Change the labels of a recording as bare MessagePack, as a foreign tool could."""
    messages = list(read_recording(path))
    path.unlink()
    with RecordingWriter(path) as writer:
        for one in messages:
            payload = bytes(one.payload)
            if "/label/" in one.key:
                values = msgspec.msgpack.decode(payload)
                change(values)
                payload = msgspec.msgpack.encode(values)
            write_beside(writer, one.key, one, payload)


def test_a_label_that_is_not_a_number_is_one_line_that_names_the_file(dataset: Dataset) -> None:
    def spoil(label: dict) -> None:
        if label["sequence"] == 17:
            label["camera_from_object"]["translation"][1] = float("nan")

    entry = dataset.entries[1]
    rewrite_labels(dataset.path(entry), spoil)
    with pytest.raises(DatasetError, match="not finite") as caught:
        train(dataset, dataset.entries)
    assert entry.file in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_mesh_without_marked_vertices_is_refused(dataset: Dataset) -> None:
    description = dataset.folder / "objects" / "mug" / "object.toml"
    description.write_text('name = "mug"\n', encoding="utf-8")
    with pytest.raises(InhandError, match="marks 0 vertices"):
        train(dataset, dataset.entries)


def test_a_mesh_in_millimetres_is_one_line_and_no_model(
    dataset: Dataset, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = dataset.folder / "objects" / "mug" / "mesh.ply"
    mesh = trimesh.load_mesh(path, process=False)
    mesh.apply_scale(1000.0)
    mesh.export(path)
    assert main(["train", str(dataset.folder), "-o", str(tmp_path / "m")]) == 1
    refusal = capsys.readouterr().err
    assert refusal.count("\n") == 1
    assert "121 m long" in refusal
    assert not (tmp_path / "m").exists()


def test_a_single_recording_is_too_few(dataset: Dataset) -> None:
    with pytest.raises(DatasetError, match="two at the least, and 1 is left"):
        train(dataset, dataset.entries[:1])


def test_an_unknown_object_or_participant_is_refused_with_those_there_are(dataset: Dataset) -> None:
    with pytest.raises(DatasetError, match="no labelled recording of 'cup'; there are: mug"):
        entries_for(dataset, "cup")
    with pytest.raises(DatasetError, match=r"no participant 'anna' .* there are: p00, p01, p02"):
        entries_for(dataset, without=["anna"])


def test_participants_can_be_left_out(dataset: Dataset) -> None:
    left = entries_for(dataset, without=["p01"])
    assert [entry.participant for entry in left] == ["p00", "p02"]


def test_every_step_is_reported_once(dataset: Dataset) -> None:
    steps: Counter[str] = Counter()
    train(dataset, dataset.entries, lambda stage: steps.update([stage]))
    assert steps == model_stages(len(dataset.entries))


def test_the_command_saves_a_model_and_says_what_was_learned(
    dataset: Dataset, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "mug.model"
    assert main(["train", str(dataset.folder), "-o", str(path)]) == 0
    shown = capsys.readouterr().out
    learned = summarise_model(load_model(path).mapping)
    assert (learned.recordings, learned.participants, learned.frames) == (3, 3, 3 * FRAMES)
    for row in ("participants", "cluster radii", "re-initialise rotation", "predicted from"):
        assert row in shown
    assert f"{learned.translation_part[0]}, in" in shown


@pytest.mark.long
def test_one_long_take_of_one_person_gives_a_model_and_says_what_it_is_of(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_dataset(tmp_path / "take", 1, frames=400)
    assert main(["train", str(tmp_path / "take"), "-o", str(tmp_path / "m")]) == 0
    shown = " ".join(capsys.readouterr().out.split())
    assert "one person (p0) in one take" in shown
    model = load_model(tmp_path / "m")
    assert list(model.mapping.starts) == [0, 170, 340]
    assert model.prior is not None
    assert np.isfinite(model.prior.errors).all()


def test_a_dataset_that_is_wrong_is_one_line_and_exit_code_1(
    dataset: Dataset, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ["train", str(dataset.folder), "-o", str(tmp_path / "m"), "--without", "p00"]
    assert main([*arguments, "--without", "p01"]) == 1
    assert capsys.readouterr().err.count("\n") == 1
    assert not (tmp_path / "m").exists()


def no_recording(dataset: Dataset, entry: DatasetEntry) -> None:
    dataset.path(entry).write_bytes(b"no recording")


def cut_off(dataset: Dataset, entry: DatasetEntry) -> None:
    path = dataset.path(entry)
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def without_labels(dataset: Dataset, entry: DatasetEntry) -> None:
    path = dataset.path(entry)
    messages = [one for one in read_recording(path) if "/label/" not in one.key]
    path.unlink()
    with RecordingWriter(path) as writer:
        for one in messages:
            write_beside(writer, one.key, one, bytes(one.payload))


def with_a_nan(dataset: Dataset, entry: DatasetEntry) -> None:
    def spoil(label: dict) -> None:
        label["camera_from_object"]["translation"][1] = float("nan")

    rewrite_labels(dataset.path(entry), spoil)


@pytest.mark.parametrize("spoil", [no_recording, cut_off, without_labels, with_a_nan])
def test_one_bad_recording_is_named_and_passed_over_and_the_exit_code_says_so(
    dataset: Dataset,
    tmp_path: Path,
    caplog: pytest.LogCaptureFixture,
    spoil: Callable[[Dataset, DatasetEntry], None],
) -> None:
    bad = dataset.entries[0]
    spoil(dataset, bad)
    path = tmp_path / "mug.model"
    assert main(["train", str(dataset.folder), "-o", str(path)]) == 1
    warned = caplog.text
    assert Path(bad.file).name in warned
    assert "1 of 3 recordings passed over" in warned
    learned = load_model(path)
    assert learned.mapping.participants == ("p01", "p02")


def test_where_too_few_recordings_are_good_the_first_bad_one_is_the_error(
    dataset: Dataset, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for entry in dataset.entries[1:]:
        no_recording(dataset, entry)
    assert main(["train", str(dataset.folder), "-o", str(tmp_path / "m")]) == 1
    refusal = capsys.readouterr().err
    assert Path(dataset.entries[1].file).name in refusal
    assert refusal.count("\n") == 1
    assert not (tmp_path / "m").exists()


def test_a_bad_recording_of_ones_own_is_passed_over_where_another_is_good(
    dataset: Dataset, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    start = tmp_path / "start.model"
    assert main(["train", str(dataset.folder), "-o", str(start)]) == 0
    no_recording(dataset, dataset.entries[1])
    adapting = ["train", str(dataset.folder), "--from", str(start), "--without", "p00"]
    assert main([*adapting, "-o", str(tmp_path / "own.model")]) == 1
    assert "1 of 2 recordings passed over" in caplog.text
    assert load_model(tmp_path / "own.model").mapping.participants[-1] == "own p02"
