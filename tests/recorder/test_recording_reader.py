"""Recordings are read in Python: in order of time, by topic and by time, in any state."""

import random
from pathlib import Path

import inhand_recorder
import numpy as np
import pytest
from damaged_recordings import WAYS
from inhand_recorder.recorded import RecordedImages
from inhand_runtime.errors import InhandError
from inhand_runtime.recording import RecordingError, RecordingWriter, read_recording
from inhand_schemas.keys import Site
from inhand_schemas.messages import ObjectPose, RgbdFrame
from recordings import (
    POSE_KEY,
    RGBD_KEY,
    contents,
    frame_messages,
    identity,
    write_recording,
)
from small_rig import (
    CAMERA,
    DELAY_NS,
    DEPTH_SCALE,
    FRAME_NS,
    START_NS,
    colour_of,
    depth_of,
    pose_of,
    write_rig,
)

TOPICS = {"info/front": 1, "label/mug": 10, "pose/mug": 10, "rgbd/front": 10, "skeletons/front": 10}


def test_a_loop_yields_typed_messages_in_the_order_of_reception(tmp_path: Path) -> None:
    path = write_rig(tmp_path / "one.mcap")
    with inhand_recorder.open(path) as recording:
        read = list(recording)
        assert recording.topics == TOPICS
        assert len(recording) == len(read) == 41
        assert recording.duration_s == pytest.approx((9 * FRAME_NS + 3 * DELAY_NS) / 1e9)
        assert recording.infos == {"front": CAMERA}
        assert recording.metadata()[path]["session"] == {"participant": "p01"}
    original = list(read_recording(path))
    assert [one.received_ns for one in read] == [one.received_ns for one in original]
    assert [one.message for one in read] == [one.message() for one in original]


def test_images_are_arrays_with_the_camera_s_scale(tmp_path: Path) -> None:
    with inhand_recorder.open(write_rig(tmp_path / "one.mcap")) as recording:
        for number, frame in enumerate(recording["rgbd/front"]):
            assert isinstance(frame, RecordedImages)
            np.testing.assert_array_equal(frame.depth, depth_of(number))
            assert frame.colour.shape == colour_of(number).shape
            assert frame.depth_m.dtype == np.float32
            np.testing.assert_allclose(frame.depth_m, depth_of(number) * DEPTH_SCALE, rtol=1e-6)


def test_messages_are_found_by_time_of_capture(tmp_path: Path) -> None:
    with inhand_recorder.open(str(write_rig(tmp_path / "one.mcap"))) as recording:
        poses = recording["pose/mug"]
        third_ns = START_NS + 3 * FRAME_NS
        assert poses.times_ns.tolist() == [START_NS + n * FRAME_NS for n in range(10)]
        assert poses.nearest(third_ns + FRAME_NS // 3).sequence == 3
        assert poses.nearest(third_ns + FRAME_NS * 2 // 3).sequence == 4
        assert poses.nearest(third_ns + 9, within_ns=8) is None
        assert poses.latest(third_ns + FRAME_NS - 1).sequence == 3
        assert poses.latest(START_NS - 1) is None
        part = poses.between(third_ns, third_ns + 2 * FRAME_NS)
        assert [one.sequence for one in part] == [3, 4]
        assert [one.sequence for one in poses[2:8:3]] == [2, 5]
        assert poses[-1].sequence == 9
        assert poses[3].message.camera_from_object == pose_of(3)
        with pytest.raises(IndexError, match="has 10 messages"):
            poses[10]


def test_split_files_are_one_recording_with_one_info(tmp_path: Path) -> None:
    write_rig(tmp_path / "b.mcap")
    write_rig(tmp_path / "a.mcap", first=10)
    with inhand_recorder.open(tmp_path) as recording:
        assert [path.name for path in recording.paths] == ["b.mcap", "a.mcap"]
        assert recording.topics == {**dict.fromkeys(TOPICS, 20), "info/front": 1}
        read = list(recording)
        assert len(read) == len(recording) == 81
        frames = [one.sequence for one in read if isinstance(one.message, RgbdFrame)]
        assert frames == list(range(20))
        assert recording["pose/mug"].nearest(START_NS + 15 * FRAME_NS).sequence == 15
        assert len(recording["info/front"]) == 1


def test_what_stands_in_two_files_is_read_once(tmp_path: Path) -> None:
    write_rig(tmp_path / "a.mcap", frames=8)
    write_rig(tmp_path / "b.mcap", first=5, frames=5)
    with inhand_recorder.open([tmp_path / "b.mcap", tmp_path / "a.mcap"]) as recording:
        read = list(recording)
        assert recording.topics == TOPICS
        assert len(read) == 41
        assert [one.received_ns for one in read] == sorted(one.received_ns for one in read)
        assert [one.sequence for one in recording["pose/mug"]] == list(range(10))


def test_more_files_than_may_be_open_are_read_in_order(tmp_path: Path) -> None:
    for number in range(20):
        write_rig(tmp_path / f"{number}.mcap", first=number, frames=1)
    with inhand_recorder.open(tmp_path) as recording:
        assert [one.sequence for one in recording["rgbd/front"]] == list(range(20))
        assert [one.sequence for one in recording.read("pose/*")] == list(range(20))


def test_a_file_that_was_cut_off_is_read_and_said(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    whole = write_rig(tmp_path / "whole.mcap").read_bytes()
    (tmp_path / "whole.mcap").unlink()
    part = tmp_path / "part.mcap.part"
    part.write_bytes(whole[: len(whole) // 2])
    (tmp_path / "power.mcap.part").write_bytes(b"")
    with inhand_recorder.open(tmp_path) as recording:
        read = [one.sequence for one in recording["rgbd/front"]]
        assert 3 <= len(read) < 10
        assert read == list(range(len(read)))
        assert any("part.mcap.part was cut off" in note for note in recording.notes)
        assert any(note.startswith("left out: ") and "empty" in note for note in recording.notes)
        assert "cut off" in caplog.text


def test_damaged_messages_are_passed_over_and_counted(tmp_path: Path) -> None:
    path = write_recording(tmp_path / "damaged.mcap")
    data = bytearray(path.read_bytes())
    payload = next(one.payload for one in read_recording(path) if one.sequence == 12)
    data[data.index(payload) + len(payload) - 3] ^= 0xFF
    path.write_bytes(data)
    with inhand_recorder.open(path) as recording:
        assert [one.sequence for one in recording["rgbd/kitchen"]] == [
            n for n in range(30) if n != 12
        ]
        assert recording.damaged == {"rgbd/kitchen": 1}
        with pytest.raises(RecordingError, match="checksum"):
            recording[RGBD_KEY][12]
        assert len(list(recording)) == 89


@pytest.mark.long
def test_no_damage_makes_it_yield_what_was_not_recorded(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level("ERROR")
    draw, data = random.Random(0), write_recording(tmp_path / "whole.mcap").read_bytes()
    known = set(contents(tmp_path / "whole.mcap"))
    path, read = tmp_path / "damaged.mcap", 0
    for _ in range(100):
        path.write_bytes(WAYS[draw.choice(list(WAYS))](draw, data))
        try:
            with inhand_recorder.open(path) as recording:
                found = {identity(one) for one in recording.messages(recording.keys)}
                assert found <= known
                assert len(list(recording)) == len(found)
                read += len(found)
        except InhandError:
            continue
    assert read > 1000


def test_what_cannot_be_decoded_is_counted_as_well(tmp_path: Path) -> None:
    path = tmp_path / "foreign.mcap"
    with RecordingWriter(path) as writer:
        for number in range(3):
            payload = frame_messages(number, 1)[2][2] if number != 1 else b"\xc0"
            stamp = {"received_ns": START_NS + number, "captured_ns": START_NS, "sequence": number}
            writer.write(POSE_KEY, payload, **stamp)
    with inhand_recorder.open(path) as recording:
        assert [one.sequence for one in recording.read("pose/*")] == [0, 2]
        assert recording.damaged == {"pose/mug": 1}


def test_a_topic_of_two_rigs_is_asked_for_by_its_key(tmp_path: Path) -> None:
    write_rig(tmp_path / "a.mcap", frames=2)
    write_rig(tmp_path / "b.mcap", frames=2, site=Site(rig="hall"))
    with inhand_recorder.open(tmp_path) as recording:
        with pytest.raises(RecordingError, match="of several rigs"):
            recording["pose/mug"]
        poses = [one.message for one in recording["inhand/@v1/hall/pose/mug"]]
        assert len(poses) == 2
        assert isinstance(poses[0], ObjectPose)
        assert set(recording.infos) == {
            "inhand/@v1/hall/info/front",
            "inhand/@v1/rig/info/front",
        }
        frame = recording["inhand/@v1/hall/rgbd/front"][0]
        assert isinstance(frame, RecordedImages)
        assert frame.info == CAMERA
        assert len(list(recording.read("rgbd/front"))) == 4


def test_wrong_names_are_said_with_what_there_is(tmp_path: Path) -> None:
    path = write_rig(tmp_path / "a.mcap", frames=1)
    with inhand_recorder.open(path) as recording:
        assert "pose/mug" in recording
        assert "pose/cup" not in recording
        for ask in (lambda: recording["pose/cup"], lambda: list(recording.read("pose/c*"))):
            with pytest.raises(RecordingError, match="there are: info/front, label/mug"):
                ask()
    with pytest.raises(RecordingError, match="does not exist"):
        inhand_recorder.open(tmp_path / "none.mcap")
    (tmp_path / "empty").mkdir()
    with pytest.raises(RecordingError, match="holds no recording"):
        inhand_recorder.open(tmp_path / "empty")
    with pytest.raises(RecordingError, match="no recording is named"):
        inhand_recorder.open([])
