"""Recordings with colour as H.264 are read as others are, from any place on, and never falsely."""

import random
import sys
from collections.abc import Callable
from pathlib import Path

import inhand_recorder
import numpy as np
import pytest
from coded_rig import CodedRig, frame, picture, recoded, record
from inhand_capture.sources.replay import ReplaySource
from inhand_recorder.colour_encoder import ColourEncoder
from inhand_recorder.conversion import Selection, convert_recording
from inhand_recorder.recorded import RecordedImages
from inhand_recorder.recovery import recover_recording
from inhand_recorder.verification import verify_recording
from inhand_runtime.pixels import decode_colour, encode_colour
from inhand_runtime.recording import (
    RecordedMessage,
    RecordingError,
    RecordingWriter,
    read_recording,
)
from inhand_runtime.recording.coded_colour import CodedPicture, ColourDecoder
from inhand_runtime.recording.copying import copy_message
from inhand_runtime.recording.message_index import open_index
from inhand_runtime.source import SourceError
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import ColourImage
from inhand_schemas.topics import RGBD
from numpy.typing import NDArray
from small_rig import DELAY_NS, FRAME_NS, START_NS, write_rig

FRAMES = 75


@pytest.fixture(scope="module")
def coded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two and a half seconds, of which every frame is H.264."""
    return record(tmp_path_factory.mktemp("coded"), FRAMES)


@pytest.fixture(scope="module")
def pictures(coded: Path) -> list[NDArray[np.uint8]]:
    """All pictures, decoded from the beginning on."""
    return [decode_colour(one.frame().colour) for one in frames_of(coded)]


def frames_of(path: Path) -> list[RecordedMessage]:
    return list(read_recording(path, streams=("rgbd",)))


def copied(source: Path, output: Path, wanted: Callable[[int], bool]) -> Path:
    """A copy without some frames, as damage leaves it."""
    with RecordingWriter(output) as writer:
        for one in read_recording(source):
            if one.topic is not RGBD or wanted(one.sequence):
                copy_message(writer, one)
    return output


def test_any_picture_is_the_same_as_from_the_beginning(
    coded: Path, pictures: list[NDArray[np.uint8]]
) -> None:
    with open_index(coded) as index:
        messages = index.messages("rgbd", "front")
        numbers = [40, 40, 41, 0, -1, 30, 31, 12, *random.Random(0).sample(range(FRAMES), 20)]
        for number in numbers:
            colour = messages[number].frame().colour
            np.testing.assert_array_equal(decode_colour(colour), pictures[number])
    with inhand_recorder.open(coded) as recording:
        middle = recording["rgbd/front"].nearest(START_NS + 50 * FRAME_NS)
        assert isinstance(middle, RecordedImages)
        np.testing.assert_array_equal(middle.colour, pictures[50])
        assert middle.message.colour.codec == "rgb8"
        read = [one.colour for one in recording.read("rgbd/*")]
        np.testing.assert_array_equal(read, pictures)


def test_a_replay_from_the_middle_shows_and_sends_what_any_daemon_reads(
    coded: Path, pictures: list[NDArray[np.uint8]], caplog: pytest.LogCaptureFixture
) -> None:
    source = ReplaySource({"file": str(coded), "rate": 0, "start": 72 * FRAME_NS / 1e9})
    played = [one for one in source.captures(lambda: True) if one is not None]
    assert [one.time_ns for one in played] == [START_NS + n * FRAME_NS for n in range(72, FRAMES)]
    for number, one in enumerate(played, 72):
        assert one.pixels is not None
        colour = one.pixels().colour
        assert isinstance(colour, np.ndarray)
        np.testing.assert_array_equal(colour, pictures[number])
    assert caplog.messages == []


def test_what_builds_on_a_lost_frame_is_refused_until_one_begins_anew(
    coded: Path, pictures: list[NDArray[np.uint8]], tmp_path: Path
) -> None:
    path = copied(coded, tmp_path / "lost.mcap", lambda number: number != 10)
    read = frames_of(path)
    with open_index(path) as index:
        messages = index.messages("rgbd", "front")
        for number, one in enumerate(read):
            for message in (one, messages[number]):
                if 10 < message.sequence < 31:
                    with pytest.raises(MessageError, match="builds on a picture that is not"):
                        message.frame()
                    assert RGBD.decode(message.payload).depth is not None
                else:
                    colour = decode_colour(message.frame().colour)
                    np.testing.assert_array_equal(colour, pictures[message.sequence])
    (problem,) = [line for line in verify_recording(path) if "H.264" in line]
    assert "the colour of 20 frames cannot be read" in problem
    with inhand_recorder.open(path) as recording:
        assert len(list(recording["rgbd/front"])) == FRAMES - 21
        assert recording.damaged == {"rgbd/front": 20}


def test_a_picture_with_another_s_predecessor_is_never_decoded(coded: Path, tmp_path: Path) -> None:
    mixed = copied(coded, tmp_path / "mixed.mcap", lambda number: number < 5 or number >= 36)
    for one in frames_of(mixed):
        if 36 <= one.sequence < 62:
            with pytest.raises(MessageError):
                one.frame()


def test_a_cut_stands_alone_and_stays_small(
    coded: Path, pictures: list[NDArray[np.uint8]], tmp_path: Path
) -> None:
    start_ns = START_NS + 20 * FRAME_NS
    with inhand_recorder.open(coded) as recording:
        convert_recording(recording, tmp_path / "cut.mcap", Selection(start_ns=start_ns))
        convert_recording(recording, tmp_path / "all.mcap", Selection())
        convert_recording(recording, tmp_path / "two.mcap", Selection(), split_seconds=1.5)
    cut = frames_of(tmp_path / "cut.mcap")
    assert [one.sequence for one in cut] == list(range(20, FRAMES))
    assert ["jpeg" if one.coded is None else "h264" for one in cut] == 11 * ["jpeg"] + 44 * ["h264"]
    for one in cut:
        decoded = decode_colour(one.frame().colour).astype(float)
        assert np.mean((decoded - pictures[one.sequence]) ** 2) < 20.0
    assert all(one.coded is not None for one in frames_of(tmp_path / "all.mcap"))
    for name in ("cut", "all", "two_000", "two_001"):
        assert verify_recording(tmp_path / f"{name}.mcap") == []
        assert all(one.frame() for one in frames_of(tmp_path / f"{name}.mcap"))


def test_what_is_recovered_of_a_cut_off_file_is_read(
    coded: Path, pictures: list[NDArray[np.uint8]], tmp_path: Path
) -> None:
    part = tmp_path / "cut.mcap.part"
    part.write_bytes(coded.read_bytes()[: coded.stat().st_size // 2])
    recover_recording(part, tmp_path / "saved.mcap")
    saved = frames_of(tmp_path / "saved.mcap")
    assert len(saved) > 10
    for one, shown in zip(saved, pictures, strict=False):
        np.testing.assert_array_equal(decode_colour(one.frame().colour), shown)
    assert verify_recording(tmp_path / "saved.mcap") == []


def test_files_that_follow_each_other_are_read_as_one(tmp_path: Path) -> None:
    rig = CodedRig(tmp_path)
    rig.record(frame(number) for number in range(8))
    rig.split()
    rig.record(frame(number) for number in range(8, 20))
    rig.split()
    with inhand_recorder.open(tmp_path) as recording:
        read = [one.sequence for one in recording["rgbd/front"]]
        assert read == list(range(20))
        assert not recording.damaged
        convert_recording(recording, tmp_path / "joined.mcap", Selection())
    assert all(one.frame() for one in frames_of(tmp_path / "joined.mcap"))


def test_data_that_is_no_h264_is_damaged(coded: Path, tmp_path: Path) -> None:
    path = tmp_path / "false.mcap"
    with RecordingWriter(path) as writer:
        for one in read_recording(coded, streams=("rgbd",)):
            payload = one.payload
            if one.coded is not None and one.sequence == 31:
                data = one.coded.image.data
                payload = payload.replace(data, bytes(len(data)))
            times = {"received_ns": one.received_ns, "captured_ns": one.captured_ns}
            writer.write(one.key, payload, sequence=one.sequence, **times)
    read = frames_of(path)
    for number in (31, 32, 61):
        with pytest.raises(MessageError):
            read[number].frame()
    assert read[30].frame()
    assert read[62].frame()


def test_a_picture_that_is_larger_than_its_message_says_is_refused_undecoded() -> None:
    large = ColourEncoder().encode(encode_colour(picture(0, 640, 480)), 0)
    of_message = ColourImage("h264", 64, 48, large.data)
    with pytest.raises(MessageError, match="Invalid data"):
        CodedPicture(of_message, lambda: None, ColourDecoder()).decoded()


def test_a_chain_without_a_beginning_takes_no_memory(coded: Path, tmp_path: Path) -> None:
    headless = copied(coded, tmp_path / "headless.mcap", lambda number: 0 < number < 31)
    for one in frames_of(headless):
        with pytest.raises(MessageError):
            one.frame()


def test_without_pyav_the_mend_is_said_and_copies_are_made_all_the_same(
    coded: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "av", None)
    with pytest.raises(RecordingError, match=r'pip install "inhand\[h264\]"'):
        frames_of(coded)[3].frame()
    with pytest.raises(SourceError, match=r'pip install "inhand\[h264\]"'):
        ReplaySource({"file": str(coded), "rate": 0})
    with inhand_recorder.open(coded) as recording:
        assert recording.topics["rgbd/front"] == FRAMES
        convert_recording(recording, tmp_path / "all.mcap", Selection())
    assert verify_recording(tmp_path / "all.mcap") == []


def test_a_file_of_both_is_read_in_order(tmp_path: Path) -> None:
    path = recoded(write_rig(tmp_path / "one.mcap"), tmp_path / "coded.mcap")
    assert verify_recording(path) == []
    with inhand_recorder.open(path) as recording:
        assert [one.received_ns for one in recording] == sorted(
            one.received_ns for one in recording
        )
        first = recording["rgbd/front"][0]
        assert first.received_ns == START_NS + DELAY_NS
