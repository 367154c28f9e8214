"""What can be learned of a dataset."""

from pathlib import Path

import pytest
from inhand_lab.datasets.dataset import DatasetEntry, DatasetError, load_dataset
from inhand_lab.datasets.new_entry import add_entry
from inhand_runtime.recording import RecordingWriter
from inhand_schemas.keys import Site
from inhand_schemas.messages import ObjectPose
from inhand_schemas.topics import LABEL
from inhand_studio.training_page.lessons import dataset_of, lessons_of


def _recording(dataset: Path, name: str, labelled: str | None, object_name: str | None) -> None:
    file = f"recordings/{name}.mcap"
    (dataset / "recordings").mkdir(parents=True, exist_ok=True)
    with RecordingWriter(dataset / file) as writer:
        if labelled is not None:
            label = ObjectPose(
                sequence=0, time_ns=1, object=labelled, camera="front", state="lost", confidence=0.0
            )
            key = LABEL.key(Site(), labelled)
            writer.write(key, LABEL.encode(label), received_ns=1, captured_ns=1, sequence=0)
    entry = DatasetEntry(
        file=file, interaction="drink", participant=name.title(), object=object_name
    )
    add_entry(dataset, entry)


def test_recordings_are_grouped_by_object_and_those_without_labels_of_it_are_named(
    tmp_path: Path,
) -> None:
    _recording(tmp_path, "ada", "mug", "mug")
    _recording(tmp_path, "bob", None, "mug")
    _recording(tmp_path, "cyd", "jug", "mug")
    _recording(tmp_path, "dan", None, None)
    (lesson,) = lessons_of(tmp_path)
    assert lesson.title == "mug in drink"
    assert [entry.participant for entry in lesson.entries] == ["Ada", "Bob", "Cyd"]
    assert set(lesson.unusable) == {"recordings/bob.mcap", "recordings/cyd.mcap"}
    assert "no labels of mug" in lesson.unusable["recordings/bob.mcap"]


def test_a_lesson_is_a_dataset_of_the_chosen_recordings_and_is_gone_after(tmp_path: Path) -> None:
    _recording(tmp_path, "ada", "mug", "mug")
    _recording(tmp_path, "bob", "mug", "mug")
    (tmp_path / "objects").mkdir()
    (lesson,) = lessons_of(tmp_path)
    with dataset_of(tmp_path, lesson.entries[:1]) as folder:
        (entry,) = load_dataset(folder).entries
        assert (folder / entry.file).samefile(tmp_path / "recordings/ada.mcap")
        assert (folder / "objects").samefile(tmp_path / "objects")
    assert not folder.exists()
    assert (tmp_path / "objects").is_dir()
    with pytest.raises(DatasetError, match="choose"), dataset_of(tmp_path, ()):
        pass
