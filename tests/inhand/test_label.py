"""``inhand label``: from keyframes to a recording that trains."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest
from changed_recordings import write_messages
from inhand_lab.datasets.recorded_frames import load_frames
from inhand_lab.datasets.tracks import true_track
from inhand_lab.labelling.keyframes import save_keyframes
from inhand_recorder.verification import verify_recording
from inhand_runtime.recording import read_metadata, read_recording
from inhand_schemas.messages import Message, Skeletons
from keyframed import dataset, file_of, key, pose, unlabelled
from waving import messages, write_dataset

from inhand.__main__ import main

KEYS = key(0, pose()), key(10, pose(x=0.1)), key(15, None), key(20, None)


def label(recording: Path, contents: Any, *options: str) -> int:
    keyframes = recording.parent / "box.json"
    save_keyframes(keyframes, contents)
    command = ["label", str(recording), "--object", "box", "--keyframes", str(keyframes)]
    return main([*command, *options])


def test_a_copy_beside_the_recording_holds_its_messages_and_the_labels(tmp_path: Path) -> None:
    recording = dataset(tmp_path)
    before = recording.read_bytes()
    assert label(recording, file_of(*KEYS)) == 0
    output = recording.with_name("wave.labelled.mcap")
    assert recording.read_bytes() == before
    assert verify_recording(output) == []
    kept = [one for one in read_recording(output) if one.topic.stream != "label"]
    assert kept == list(read_recording(recording))
    track = true_track(load_frames(output, "box"))
    assert np.flatnonzero(track.given).tolist() == list(range(11))
    np.testing.assert_allclose(track.translations[5], [0.05, 0.0, 2.0])
    states = [frame.label and frame.label.state for frame in load_frames(output, "box")]
    assert states[15:21] == ["lost"] * 6
    assert {*states[11:15], *states[21:]} == {None}
    assert {frame.label.person for frame in load_frames(output, "box") if frame.label} == {1}
    assert read_metadata(output)["labels"]["object"] == "box"


def test_labels_that_are_there_stay_unless_they_are_to_be_replaced(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    recording = dataset(tmp_path, list(messages(31, 0)))
    assert label(recording, file_of(*KEYS)) == 1
    assert "has labels of box already: add --replace" in capsys.readouterr().err
    assert label(recording, file_of(*KEYS), "--replace") == 0
    labels = list(read_recording(recording.with_name("wave.labelled.mcap"), streams=("label",)))
    assert len(labels) == 17


def test_a_copy_that_is_there_is_not_written_over(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    recording = dataset(tmp_path)
    recording.with_name("wave.labelled.mcap").write_bytes(b"mine")
    assert label(recording, file_of(*KEYS)) == 1
    assert "wave.labelled.mcap exists already: choose another name" in capsys.readouterr().err


def without_skeletons(shown: list[Message]) -> list[Message]:
    return [one for one in shown if not isinstance(one, Skeletons)]


WRONG: dict[str, tuple[Callable[[list[Message]], list[Message]], Any, str]] = {
    "skeletons": (without_skeletons, file_of(*KEYS), "`inhand recording skeletons` adds them"),
    "info": (lambda shown: shown[1:], file_of(*KEYS), "lacks the info of camera camera"),
    "outside": (list, file_of(key(0, pose()), key(31, pose())), "has frames 0 to 30, and there is"),
    "times": (list, file_of(msgspec.structs.replace(KEYS[0], time_ns=7)), "its keyframe says 7: t"),
    "object": (list, file_of(*KEYS, object="mug"), "give --object mug, or the keyframes of box"),
    "camera": (
        list,
        file_of(*KEYS, camera="side"),
        "no skeletons of camera 'side': choose one of camera",
    ),
    "poses": (list, file_of(key(0, None)), "has a pose: set two or more"),
}


@pytest.mark.parametrize("case", WRONG)
def test_what_cannot_be_labelled_gets_one_line_and_leaves_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], case: str
) -> None:
    change, contents, line = WRONG[case]
    recording = dataset(tmp_path, change(unlabelled()))
    assert label(recording, contents) == 1
    told = capsys.readouterr().err
    assert line in told
    assert told.count("\n") == 1
    assert sorted(one.name for one in recording.parent.iterdir()) == ["box.json", "wave.mcap"]


def test_half_a_recording_and_an_object_that_is_not_there_get_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    recording = dataset(tmp_path)
    assert label(recording, file_of(*KEYS), "--dataset", str(tmp_path / "none")) == 1
    assert "none/objects/box" in capsys.readouterr().err
    recording.write_bytes(recording.read_bytes()[:3000])
    assert label(recording, file_of(*KEYS)) == 1
    assert "was cut off: `inhand recording recover" in capsys.readouterr().err


def test_in_a_recording_of_two_cameras_the_keyframes_camera_is_labelled(tmp_path: Path) -> None:
    recording = dataset(tmp_path)
    both = recording.with_name("both.mcap")
    write_messages(both, unlabelled(), also="side")
    assert label(both, file_of(*KEYS, camera="side")) == 0
    frames = load_frames(recording.with_name("both.labelled.mcap"), "box")
    assert {frame.label.camera for frame in frames if frame.label} == {"side"}


def test_where_nothing_can_be_written_is_said_before_the_work(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    recording = dataset(tmp_path)
    assert label(recording, file_of(*KEYS), "-o", str(tmp_path / "none" / "out.mcap")) == 1
    assert "none is no folder: make it, or choose another one" in capsys.readouterr().err
    assert label(recording, file_of(*KEYS), "-o", "/proc/nowhere/out.mcap") == 2
    assert "cannot write /proc/nowhere/out.mcap" in capsys.readouterr().err


@pytest.mark.long
def test_what_is_labelled_trains(tmp_path: Path) -> None:
    folder = tmp_path / "waving"
    for entry in write_dataset(folder, 3).entries:
        path = folder / entry.file
        frames = load_frames(path, "box")
        marks = [
            key(index, frame.label.camera_from_object, relative_to="right forearm")
            for index, frame in enumerate(frames)
            if frame.label is not None and index % 5 == 0
        ]
        assert label(path, file_of(*marks), "--replace") == 0
    table = folder / "dataset.toml"
    table.write_text(table.read_text().replace(".mcap", ".labelled.mcap"))
    assert main(["train", str(folder), "-o", str(tmp_path / "box.model")]) == 0
    assert (tmp_path / "box.model").exists()


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--assisted"], "--assisted is for labels between keyframes: give --keyframes"),
        (["--keyframes", "box.json"], "give --object NAME as well"),
        (["--object", "mug"], "object.toml"),
    ],
)
def test_options_that_do_not_belong_together_are_refused_before_a_page_is_served(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], options: list[str], said: str
) -> None:
    assert main(["label", str(dataset(tmp_path)), *options]) != 0
    assert said in capsys.readouterr().err
    assert main(["label", str(tmp_path / "none.mcap")]) == 2
