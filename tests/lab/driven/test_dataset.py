"""Datasets of recorded people who hold simulated objects."""

from pathlib import Path

import numpy as np
import pytest
from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError
from inhand_lab.datasets.dataset_writer import DatasetWriter
from inhand_lab.datasets.labelled_sequence import labelled_sequence
from inhand_lab.datasets.recorded_frames import load_frames
from inhand_lab.driven.dataset import DrivenSettings, generate_driven, pairs_for, recorded_body
from inhand_lab.world.messages import person_message
from inhand_lab.world.simulation import Simulation
from inhand_runtime.recording import RecordingWriter
from inhand_schemas.keys import Site
from inhand_schemas.messages import Message, Skeletons
from inhand_schemas.topics import SKELETONS
from msgspec.structs import replace
from recorded_bodies import source


def skeletons(simulation: Simulation, frames: range) -> list[Message]:
    return [
        Skeletons(
            sequence=number,
            time_ns=number * 33_333_333,
            people=(person_message(simulation, frame),) if frame % 100 < 60 else (),
            convention="kinect_v1",
        )
        for number, frame in enumerate(frames)
    ]


@pytest.fixture
def bodies(tmp_path: Path) -> Dataset:
    """Three people who sweep, out of sight for 40 of 100 frames, and one who juggles."""
    writer = DatasetWriter(tmp_path / "bodies")
    for number in range(3):
        entry = DatasetEntry(
            file=f"recordings/take_{number}.mcap",
            interaction="sweepFloor",
            participant=f"s{number}",
        )
        writer.add_recording(entry, skeletons(source(participant=number), range(100, 280)))
    entry = DatasetEntry(file="recordings/take_3.mcap", interaction="juggle", participant="s0")
    writer.add_recording(entry, skeletons(source(), range(100, 160)))
    return writer.finish({})


def test_every_fitting_recording_becomes_a_labelled_one(tmp_path: Path, bodies: Dataset) -> None:
    driven = generate_driven(
        tmp_path / "driven", bodies, DrivenSettings(None, 4, images=False), lambda: None
    )
    assert [(e.interaction, e.participant, e.object) for e in driven.entries] == [
        ("sweepFloor", f"s{number}", "broom") for number in range(3)
    ]
    frames = load_frames(driven.path(driven.entries[0]), "broom")
    original = load_frames(bodies.path(bodies.entries[0]), None)
    assert len(frames) == 60
    assert frames[7].people[0].joints == original[7].people[0].joints
    assert {frame.convention for frame in frames} == {"kinect_v1"}
    assert all(frame.label is not None and frame.label.contact == "both_hands" for frame in frames)
    assert np.isfinite(labelled_sequence(driven, driven.entries[0]).translations).all()


def test_chosen_objects_go_with_every_recording(bodies: Dataset) -> None:
    pairs = pairs_for(bodies, ["drinkFromMug", "putOnGlasses"])
    assert len(pairs) == 8
    assert {interaction for _, interaction in pairs} == {"drinkFromMug", "putOnGlasses"}


def test_where_nothing_fits_the_choice_is_asked_for(bodies: Dataset) -> None:
    jugglers = Dataset(bodies.folder, bodies.entries[3:])
    with pytest.raises(DatasetError, match="choose with --interactions"):
        pairs_for(jugglers, None)


def test_a_recording_without_a_body_is_refused(tmp_path: Path) -> None:
    writer = DatasetWriter(tmp_path / "empty")
    entry = DatasetEntry(file="recordings/a.mcap", interaction="sweepFloor", participant="s0")
    writer.add_recording(entry, [Skeletons(sequence=0, time_ns=0)])
    with pytest.raises(DatasetError, match="all twenty joints"):
        recorded_body(writer.finish({}), entry, participant=0, recording=0)


def with_nobody(bodies: Dataset, chosen: range) -> Dataset:
    """The first recording again, with skeletons that are all zero in the chosen frames."""
    entry = bodies.entries[0]
    messages = skeletons(source(), range(100, 160))
    for number in chosen:
        message = messages[number]
        assert isinstance(message, Skeletons)
        zeros = replace(message.people[0], joints=((0.0, 0.0, 0.0),) * 20, states=("tracked",) * 20)
        messages[number] = replace(message, people=(zeros,))
    bodies.path(entry).unlink()
    with RecordingWriter(bodies.path(entry)) as writer:
        for message in messages:
            writer.write(
                SKELETONS.key(Site(), "camera"),
                SKELETONS.encode(message),
                received_ns=message.time_ns,
                captured_ns=message.time_ns,
                sequence=message.sequence,
            )
    return Dataset(bodies.folder, (entry, bodies.entries[1]))


def test_frames_whose_skeleton_is_all_zero_are_out_of_sight(
    tmp_path: Path, bodies: Dataset
) -> None:
    gaps = with_nobody(bodies, range(20, 25))
    settings = DrivenSettings(None, 4, images=False)
    driven = generate_driven(tmp_path / "driven", gaps, settings, lambda: None)
    joints = labelled_sequence(driven, driven.entries[0]).joints
    assert len(joints) == 60
    assert np.isnan(joints[20:25]).all()
    assert np.isfinite(joints[25:]).any()


def test_a_recording_that_shows_nobody_is_named_and_left_out(
    tmp_path: Path, bodies: Dataset, caplog: pytest.LogCaptureFixture
) -> None:
    nobody = with_nobody(bodies, range(60))
    settings = DrivenSettings(None, 4, images=False)
    driven = generate_driven(tmp_path / "driven", nobody, settings, lambda: None)
    assert [entry.participant for entry in driven.entries] == ["s1"]
    assert "recordings/take_0.mcap shows nobody" in caplog.text
    alone = Dataset(nobody.folder, nobody.entries[:1])
    with pytest.raises(DatasetError, match=r"take_0\.mcap shows nobody"):
        generate_driven(tmp_path / "alone", alone, settings, lambda: None)
