"""Training from datasets: what is refused, what is told, and what it costs."""

from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from shutil import copytree

import msgspec
import numpy as np
import pytest
from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError, load_dataset
from inhand_lab.datasets.generation import GenerationSettings, generate
from inhand_lab.training.model_summary import summarise_model
from inhand_lab.training.model_training import entries_for, model_stages, train
from inhand_lab.training.recording_checks import check_hands, check_sequence
from inhand_runtime.errors import InhandError
from inhand_runtime.recording import RecordingWriter, read_recording
from inhand_schemas.joints import JOINT_NAMES, Joint
from inhand_tracker.mapping.learning import LabelledSequence
from inhand_tracker.model.model_file import load_model

from inhand.__main__ import main

FRAMES = 60
ENTRY = DatasetEntry(file="recordings/a.mcap", interaction="drink", participant="p0", object="mug")
TURNED = np.array([0.0, 1.0, 0.0, 0.0])


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


def recording(frames: int = 20, *, left_handed: bool = False) -> LabelledSequence:
    """Somebody who stands with an object in the right hand."""
    joints = np.random.default_rng(0).normal(size=(20, 3)).repeat(frames, 0).reshape(20, frames, 3)
    joints = joints.swapaxes(0, 1).copy()
    places = joints[:, Joint.HAND_RIGHT] + [0.0, 0.0, 0.05]
    turns = np.tile([1.0, 0.0, 0.0, 0.0], (frames, 1))
    return LabelledSequence("p0", left_handed, joints, places, turns)


def without_labels(sequence: LabelledSequence, frames: int) -> LabelledSequence:
    translations = sequence.translations.copy()
    translations[:frames] = np.nan
    return replace(sequence, translations=translations)


def without_joint(sequence: LabelledSequence, name: str, frames: int) -> LabelledSequence:
    joints = sequence.joints.copy()
    joints[:frames, JOINT_NAMES.index(name)] = np.nan
    return replace(sequence, joints=joints)


def moved_at(sequence: LabelledSequence, frame: int, metres: float) -> LabelledSequence:
    translations = sequence.translations.copy()
    translations[frame, 0] += metres
    return replace(sequence, translations=translations)


def turned_at(sequence: LabelledSequence, frame: int) -> LabelledSequence:
    rotations = sequence.rotations.copy()
    rotations[frame] = TURNED
    return replace(sequence, rotations=rotations)


REFUSED: dict[str, tuple[Callable[[LabelledSequence], LabelledSequence], str]] = {
    "labels": (lambda s: without_labels(s, 11), "no label of 'mug' in 11 of 20 frames, and 50%"),
    "a place": (lambda s: moved_at(s, 7, 2.5), "jumps by 2.50 m after frame 6: mend that label"),
    "a turn": (lambda s: turned_at(s, 7), "turns by 180° after frame 6: mend that label"),
    "the pelvis": (
        lambda s: without_joint(s, "HipLeft", 11),
        "no pelvis in 11 of 20 frames, .*HipCenter, Spine, HipLeft, HipRight",
    ),
    "a joint": (
        lambda s: without_joint(s, "FootLeft", 11),
        "lacks joints in 11 of 20 frames, FootLeft most often, and 50% may",
    ),
    "everything": (
        lambda s: LabelledSequence("p0", False, s.joints[:0], s.translations[:0], s.rotations[:0]),
        "holds no skeletons",
    ),
}


@pytest.mark.parametrize("what", REFUSED)
def test_a_recording_that_cannot_be_meant_is_refused_in_one_line(what: str) -> None:
    spoil, message = REFUSED[what]
    with pytest.raises(DatasetError, match=message) as caught:
        check_sequence(ENTRY, spoil(recording()))
    assert str(caught.value).startswith("recordings/a.mcap")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "spoil",
    [
        lambda s: s,
        lambda s: without_labels(s, 10),
        lambda s: without_joint(s, "HipLeft", 10),
        lambda s: without_joint(s, "FootLeft", 10),
        lambda s: moved_at(s, 7, 1.9),
    ],
)
def test_what_may_be_missing_or_fast_is_accepted(
    spoil: Callable[[LabelledSequence], LabelledSequence],
) -> None:
    check_sequence(ENTRY, spoil(recording()))


def test_a_label_may_go_far_while_it_is_not_given() -> None:
    far = moved_at(recording(), 9, 5.0)
    far.translations[8] = far.translations[10] = np.nan
    check_sequence(ENTRY, far)


def test_a_person_with_the_wrong_handedness_is_named() -> None:
    entries = [replaced(ENTRY, file=f"{name}.mcap") for name in "abc"]
    entries[1] = replaced(entries[1], handedness="left")
    sequences = [recording(), recording(left_handed=True), recording()]
    with pytest.raises(DatasetError, match=r"b\.mcap.*other hand of a left-handed") as caught:
        check_hands(entries, sequences)
    assert 'handedness = "right"' in str(caught.value)


def test_the_only_one_who_uses_the_dominant_hand_is_named() -> None:
    entries = [replaced(ENTRY, file=f"{name}.mcap", handedness="left") for name in "abc"]
    entries[2] = replaced(entries[2], handedness="right")
    sequences = [recording(left_handed=True), recording(left_handed=True), recording()]
    with pytest.raises(DatasetError, match=r"c\.mcap.*dominant hand of a right-handed"):
        check_hands(entries, sequences)


def test_an_object_in_both_hands_tells_nothing_of_handedness() -> None:
    between = recording()
    hands = between.joints[:, [Joint.HAND_RIGHT, Joint.HAND_LEFT]]
    places = hands.mean(axis=1)
    places[::2] = hands[::2, 0]
    places[1::2] = hands[1::2, 1]
    both = replace(between, translations=places)
    check_hands([ENTRY] * 3, [both, replace(both, left_handed=True), recording()])


def replaced(entry: DatasetEntry, **changes: str) -> DatasetEntry:
    return msgspec.structs.replace(entry, **changes)


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
            writer.write(
                one.key,
                payload,
                received_ns=one.received_ns,
                captured_ns=one.captured_ns,
                sequence=one.sequence,
            )


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


def test_a_mesh_without_marked_vertices_is_told(dataset: Dataset) -> None:
    description = dataset.folder / "objects" / "mug" / "object.toml"
    description.write_text('name = "mug"\n', encoding="utf-8")
    with pytest.raises(InhandError, match="marks 0 vertices"):
        train(dataset, dataset.entries)


def test_a_single_recording_is_too_few(dataset: Dataset) -> None:
    with pytest.raises(DatasetError, match="two at the least, and 1 is left"):
        train(dataset, dataset.entries[:1])


def test_an_unknown_object_or_participant_is_told_with_those_there_are(dataset: Dataset) -> None:
    with pytest.raises(DatasetError, match="no labelled recording of 'cup'; there are: mug"):
        entries_for(dataset, "cup")
    with pytest.raises(DatasetError, match=r"no participant 'anna' .* there are: p00, p01, p02"):
        entries_for(dataset, without=["anna"])


def test_participants_can_be_left_out(dataset: Dataset) -> None:
    left = entries_for(dataset, without=["p01"])
    assert [entry.participant for entry in left] == ["p00", "p02"]


def test_every_step_is_told_once(dataset: Dataset) -> None:
    told: Counter[str] = Counter()
    train(dataset, dataset.entries, lambda stage: told.update([stage]))
    assert told == model_stages(len(dataset.entries))


def test_the_command_saves_a_model_and_says_what_was_learned(
    dataset: Dataset, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "mug.model"
    assert main(["train", str(dataset.folder), "-o", str(path)]) == 0
    shown = capsys.readouterr().out
    learned = summarise_model(load_model(path).mapping)
    assert (learned.recordings, learned.participants, learned.frames) == (3, 3, 3 * FRAMES)
    for told in ("participants", "cluster radii", "re-initialise rotation", "predicted from"):
        assert told in shown
    assert f"{learned.translation_part[0]}, in" in shown


def test_a_dataset_that_is_wrong_is_one_line_and_exit_code_1(
    dataset: Dataset, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ["train", str(dataset.folder), "-o", str(tmp_path / "m"), "--without", "p00"]
    assert main([*arguments, "--without", "p01"]) == 1
    assert capsys.readouterr().err.count("\n") == 1
    assert not (tmp_path / "m").exists()


def test_what_was_learned_is_counted_over_all_frames(dataset: Dataset) -> None:
    mapping = train(dataset, dataset.entries).mapping
    frames = len(mapping.body_poses)
    half, part = np.arange(frames) < frames // 2, np.full(frames, 10)
    part[0] = 3
    learned = summarise_model(
        replace(
            mapping,
            rotation_variation=np.where(half, 0.0, 10.0),
            translation_variation=np.zeros(frames),
            proximate_part=part,
            radii=np.array([0.1, 0.2, 0.4]),
        )
    )
    assert learned.good_rotations == pytest.approx(0.5)
    assert learned.good_translations == 1.0
    assert learned.translation_part == ("HandRight", pytest.approx(1.0 - 1.0 / frames))
    assert learned.radii == pytest.approx((0.1, 0.2, 0.4))
