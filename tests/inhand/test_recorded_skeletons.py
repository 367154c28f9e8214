"""Recordings of colour and depth that get skeletons."""

from pathlib import Path

import numpy as np
import pytest
from inhand_recorder.verification import verify_recording
from inhand_runtime.errors import InhandError
from inhand_runtime.pixels import encode_colour, encode_depth
from inhand_runtime.recording import RecordingError, RecordingWriter, read_recording
from inhand_schemas.joints import Joint
from inhand_schemas.messages import ObjectPose, Person, Pose, RgbdFrame, Skeletons
from inhand_schemas.topics import INFO, LABEL, RGBD, SKELETONS
from posed_person import INFO as CAMERA
from posed_person import ToldNetwork, depth_of, seen, standing
from recordings import write_message

from inhand.recorded_skeletons import add_skeletons, true_skeletons

TRUTH = standing()
COLOUR = encode_colour(np.zeros((480, 640, 3), np.uint8))
DEPTH = encode_depth(depth_of(TRUTH))
FRAMES = 4
SOMEBODY = Person(
    id=7, joints=((0.0, 0.0, 2.0),) * 20, states=("tracked",) * 20, confidences=(1.0,) * 20
)


def recorded(path: Path, *, info: bool = True, depth: bool = True, skeletons: bool = False) -> Path:
    with RecordingWriter(path) as writer:
        if info:
            write_message(writer, INFO, "front", CAMERA)
        for number in range(FRAMES):
            stamp = {"sequence": 10 + number, "time_ns": 10**9 + number * 33_000_000}
            if skeletons:
                write_message(writer, SKELETONS, "front", Skeletons(**stamp, people=(SOMEBODY,)))
            write_message(
                writer,
                RGBD,
                "front",
                RgbdFrame(**stamp, colour=COLOUR, depth=DEPTH if depth else None),
            )
    return path


def network() -> ToldNetwork:
    return ToldNetwork([[seen(TRUTH)], [], [seen(TRUTH)]])


def skeletons_in(path: Path) -> list[Skeletons]:
    messages = (one.message() for one in read_recording(path, streams=("skeletons",)))
    return [one for one in messages if isinstance(one, Skeletons)]


def test_each_frame_gets_skeletons_of_its_number_and_time(tmp_path: Path) -> None:
    path, output = recorded(tmp_path / "walk.mcap"), tmp_path / "whole.mcap"
    done = add_skeletons(path, output, network, convention="blazepose")
    assert (done["front"].frames, done["front"].with_people) == (FRAMES, FRAMES - 1)
    found = skeletons_in(output)
    assert {one.convention for one in found} == {"blazepose"}
    frames = [one.message() for one in read_recording(path, streams=("rgbd",))]
    assert [(one.sequence, one.time_ns) for one in found] == [
        (one.sequence, one.time_ns) for one in frames
    ]
    assert [len(one.people) for one in found] == [1, 0, 1, 1]
    head = found[0].people[0].joints[Joint.HEAD]
    assert np.linalg.norm(np.array(head) - TRUTH[Joint.HEAD]) < 0.06
    assert len(list(read_recording(output))) == len(list(read_recording(path))) + FRAMES
    assert verify_recording(output) == []


def test_skeletons_that_are_there_stay_unless_they_are_to_be_replaced(tmp_path: Path) -> None:
    path, output = recorded(tmp_path / "walk.mcap", skeletons=True), tmp_path / "new.mcap"
    with pytest.raises(RecordingError, match="has skeletons already: add --replace"):
        add_skeletons(path, output, network)
    assert not output.exists()
    add_skeletons(path, output, network, replace=True)
    assert {person.id for one in skeletons_in(output) for person in one.people} == {0}
    assert len(skeletons_in(output)) == FRAMES


@pytest.mark.parametrize(
    ("lacking", "line"),
    [
        ({"info": False}, "lacks the info of camera front: `inhand recording repair` adds it"),
        ({"depth": False}, "camera front: no skeletons without depth"),
    ],
    ids=["info", "depth"],
)
def test_what_a_recording_lacks_is_said_in_one_line(
    tmp_path: Path, lacking: dict[str, bool], line: str
) -> None:
    path = recorded(tmp_path / "walk.mcap", **lacking)
    with pytest.raises((RecordingError, InhandError), match=line):
        add_skeletons(path, tmp_path / "out.mcap", network)
    assert list(tmp_path.iterdir()) == [path]


def test_a_file_that_another_writes_stays(tmp_path: Path) -> None:
    path, part = recorded(tmp_path / "walk.mcap"), tmp_path / "out.mcap.part"
    part.write_bytes(b"being recorded")
    with pytest.raises(RecordingError):
        add_skeletons(path, tmp_path / "out.mcap", network)
    assert part.read_bytes() == b"being recorded"


def labelled(path: Path) -> Path:
    """A recording of what labels know better: the first two frames of four have true joints."""
    truth = tuple((x, y, z) for x, y, z in np.nan_to_num(TRUTH).tolist())
    with RecordingWriter(path) as writer:
        for number in range(FRAMES):
            stamp = {"sequence": 10 + number, "time_ns": 10**9 + number * 33_000_000}
            write_message(writer, SKELETONS, "front", Skeletons(**stamp, people=(SOMEBODY,)))
            joints = truth if number < 2 else None
            pose = Pose(translation=(0.0, 0.0, 2.0), rotation=(1.0, 0.0, 0.0, 0.0))
            label = ObjectPose(
                **stamp,
                object="mug",
                camera="front",
                state="tracked",
                confidence=1.0,
                camera_from_object=pose,
                person_joints=joints,
            )
            write_message(writer, LABEL, "mug", label)
    return path


def test_true_joints_of_labels_stand_in_place_of_skeletons(tmp_path: Path) -> None:
    path, output = labelled(tmp_path / "walk.mcap"), tmp_path / "true.mcap"
    assert true_skeletons(path, output) == 2
    found = skeletons_in(output)
    assert [one.sequence for one in found] == [10, 11]
    assert {one.convention for one in found} == {"simulated"}
    for one in found:
        (person,) = one.people
        assert person.id == SOMEBODY.id
        np.testing.assert_array_equal(person.joints, np.nan_to_num(TRUTH))
    assert verify_recording(output) == []


def test_true_joints_of_a_recording_without_any_are_refused(tmp_path: Path) -> None:
    path, output = recorded(tmp_path / "walk.mcap", skeletons=True), tmp_path / "true.mcap"
    with pytest.raises(RecordingError, match="holds no true joints: only labels of simulated"):
        true_skeletons(path, output)
    assert not output.exists()
