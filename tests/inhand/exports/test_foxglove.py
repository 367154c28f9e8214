"""Foxglove's schemas, decoded by an independent reader, with the figures of the recording."""

import re
import subprocess
import sys
from collections import defaultdict
from pathlib import Path
from typing import Any

import av
import numpy as np
import pytest
from coded_rig import recoded
from exported import export
from inhand_recorder.conversion import Selection
from inhand_runtime.errors import InhandError
from inhand_runtime.pixels import encode_colour
from inhand_runtime.recording import RecordingWriter, read_recording
from inhand_runtime.recording.copying import copy_message
from inhand_schemas.messages import CameraInfo, Event
from inhand_schemas.topics import EVENT, INFO
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory
from msgspec.structs import replace
from small_rig import CAMERA, FRAME_NS, SITE, START_NS, colour_of, depth_of, pose_of, write_rig

from inhand.exports.foxglove import export_foxglove


def decoded(path: Path) -> dict[str, list[tuple[str, Any, Any]]]:
    """Schema, record and message of all that stands on each topic."""
    found = defaultdict(list)
    with path.open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        for schema, channel, record, message in reader.iter_decoded_messages():
            found[channel.topic].append((schema.name, record, message))
    return found


def nanoseconds(stamp: Any) -> int:
    return stamp.seconds * 1_000_000_000 + stamp.nanos


def numbers(place: Any, rotation: Any) -> list[float]:
    return [place.x, place.y, place.z, rotation.w, rotation.x, rotation.y, rotation.z]


def test_an_independent_reader_finds_the_recording_s_figures(tmp_path: Path) -> None:
    source = write_rig(tmp_path / "one.mcap")
    counts = export(export_foxglove, source, tmp_path / "fox.mcap")
    assert counts["damaged images"] == 0
    found = decoded(tmp_path / "fox.mcap")
    assert {topic: (of[0][0], len(of)) for topic, of in found.items()} == {
        "/front/calibration": ("foxglove.CameraCalibration", 1),
        "/front/colour": ("foxglove.CompressedImage", 10),
        "/front/depth": ("foxglove.RawImage", 10),
        "/label/mug": ("foxglove.PoseInFrame", 10),
        "/pose/mug": ("foxglove.PoseInFrame", 8),
        "/skeletons/front": ("foxglove.SceneUpdate", 10),
        "/tf": ("foxglove.FrameTransforms", 19),
    }
    times = [one.received_ns for one in read_recording(source, streams=("rgbd",))]
    for number, (_, record, image) in enumerate(found["/front/colour"]):
        assert image.data == encode_colour(colour_of(number)).data
        assert nanoseconds(image.timestamp) == record.publish_time == START_NS + number * FRAME_NS
        assert (record.log_time, record.sequence) == (times[number], number)
    for number, (_, _, image) in enumerate(found["/front/depth"]):
        assert (image.encoding, image.frame_id) == ("16UC1", "front")
        pixels = np.frombuffer(image.data, "<u2").reshape(image.height, image.step // 2)
        np.testing.assert_array_equal(pixels, depth_of(number))
    for number, (_, _, placed) in enumerate(found["/label/mug"]):
        shown = numbers(placed.pose.position, placed.pose.orientation)
        assert shown == [*pose_of(number).translation, *pose_of(number).rotation]
        assert nanoseconds(placed.timestamp) == START_NS + number * FRAME_NS


def test_frames_hang_together_from_the_rig_to_the_object(tmp_path: Path) -> None:
    export(export_foxglove, write_rig(tmp_path / "one.mcap", frames=2), tmp_path / "fox.mcap")
    found = decoded(tmp_path / "fox.mcap")
    transforms = [message.transforms[0] for _, _, message in found["/tf"]]
    assert [(one.parent_frame_id, one.child_frame_id) for one in transforms] == [
        ("rig", "front"),
        *[("front", "mug_label"), ("front", "mug")] * 2,
    ]
    shown = numbers(transforms[0].translation, transforms[0].rotation)
    assert shown == [*CAMERA.rig_from_camera.translation, *CAMERA.rig_from_camera.rotation]
    ((_, _, lens),) = found["/front/calibration"]
    assert list(lens.K) == [60.0, 0.0, 31.5, 0.0, 61.0, 23.5, 0.0, 0.0, 1.0]
    (person,) = found["/skeletons/front"][0][2].entities
    assert (person.id, person.frame_id, len(person.spheres)) == ("person 7", "front", 19)
    assert len(person.lines[0].points) == 2 * 18


def test_depth_of_another_scale_is_metres(tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "fine.mcap") as writer:
        for one in read_recording(write_rig(tmp_path / "one.mcap", frames=1)):
            if one.topic is INFO and isinstance(info := one.message(), CameraInfo):
                payload = INFO.encode(replace(info, depth_scale=0.0001))
                stamp = {"received_ns": one.received_ns, "captured_ns": one.captured_ns}
                writer.write(one.key, payload, sequence=0, **stamp)
            else:
                copy_message(writer, one)
    export(export_foxglove, tmp_path / "fine.mcap", tmp_path / "fox.mcap")
    ((_, _, image),) = decoded(tmp_path / "fox.mcap")["/front/depth"]
    assert image.encoding == "32FC1"
    pixels = np.frombuffer(image.data, "<f4").reshape(48, 64)
    np.testing.assert_allclose(pixels, depth_of(0) * 0.0001, rtol=1e-6)


def test_events_are_log_lines(tmp_path: Path) -> None:
    event = Event(sequence=3, time_ns=START_NS, kind="drank", description="drank from the mug")
    with RecordingWriter(tmp_path / "one.mcap") as writer:
        stamp = {"received_ns": START_NS + 5, "captured_ns": START_NS, "sequence": 3}
        writer.write(EVENT.key(SITE, "drank"), EVENT.encode(event), **stamp)
    export(export_foxglove, tmp_path / "one.mcap", tmp_path / "fox.mcap")
    ((schema, _, line),) = decoded(tmp_path / "fox.mcap")["/events"]
    assert (schema, line.message, line.name) == (
        "foxglove.Log",
        "drank from the mug",
        "event/drank",
    )


SMALL_FILES = """
import resource, sys
resource.setrlimit(resource.RLIMIT_FSIZE, (10_000, 10_000))
from inhand.__main__ import main
sys.exit(main(sys.argv[1:]))
"""


def test_where_no_room_is_left_it_is_said_and_nothing_stays(tmp_path: Path) -> None:
    path = write_rig(tmp_path / "one.mcap")
    verb = ("recording", "export", str(path), "--to", "foxglove", "-o", str(tmp_path / "fox.mcap"))
    done = subprocess.run(
        [sys.executable, "-c", SMALL_FILES, *verb], capture_output=True, text=True, check=False
    )
    assert done.returncode == 1
    assert re.search(r"cannot write .*fox.mcap: File too large", done.stderr)
    with pytest.raises(InhandError, match="exists already"):
        export(export_foxglove, path, path)
    assert [one.name for one in tmp_path.iterdir()] == ["one.mcap"]


def test_h264_stays_a_video_that_others_decode(tmp_path: Path) -> None:
    source = recoded(write_rig(tmp_path / "jpeg.mcap"), tmp_path / "one.mcap")
    export(export_foxglove, source, tmp_path / "fox.mcap")
    video = decoded(tmp_path / "fox.mcap")["/front/video"]
    assert [(name, message.format) for name, _, message in video] == [
        ("foxglove.CompressedVideo", "h264")
    ] * 10
    codec = av.CodecContext.create("h264", "r")
    codec.thread_count = 1
    for number, (_, _, message) in enumerate(video):
        (picture,) = codec.decode(av.Packet(message.data))
        shown = picture.to_ndarray(format="rgb24").astype(float)
        assert np.mean((shown - colour_of(number)) ** 2) < 60.0


def test_h264_whose_beginning_is_cut_off_is_exported_as_pictures(tmp_path: Path) -> None:
    source = recoded(write_rig(tmp_path / "jpeg.mcap"), tmp_path / "one.mcap")
    selection = Selection(start_ns=START_NS + 4 * FRAME_NS)
    counts = export(export_foxglove, source, tmp_path / "fox.mcap", selection)
    found = decoded(tmp_path / "fox.mcap")
    assert "/front/video" not in found
    assert len(found["/front/colour"]) == counts["CompressedImage"] == 6
