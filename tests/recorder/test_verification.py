"""A recording's promises are checked."""

from pathlib import Path

import pytest
from inhand_recorder.losses import LOSSES_RECORD, LossCounter, Losses, format_losses
from inhand_recorder.verification import verify_recording
from inhand_runtime.recording import RecordingError, RecordingWriter
from recordings import POSE_KEY, START_NS, flaws, frame_messages, write_frame, write_recording


def write(writer: RecordingWriter, payload: bytes, sequence: int, received_ns: int) -> None:
    writer.write(
        POSE_KEY, payload, received_ns=received_ns, captured_ns=START_NS, sequence=sequence
    )


def pose(number: int) -> bytes:
    return frame_messages(number, 1)[2][2]


def test_a_whole_recording_has_no_problem(tmp_path: Path) -> None:
    assert flaws(write_recording(tmp_path / "walk.mcap")) == []


def test_a_recording_without_messages_has_no_problem(tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "empty.mcap") as writer:
        pass
    assert flaws(writer.path) == []


def test_a_cut_recording_is_told_with_the_mend(tmp_path: Path) -> None:
    path = write_recording(tmp_path / "walk.mcap")
    path.write_bytes(path.read_bytes()[:-1])
    problems = verify_recording(path)
    assert any("inhand recording recover" in problem for problem in problems)


def test_a_changed_byte_in_a_payload_is_told_with_its_place(tmp_path: Path) -> None:
    path = write_recording(tmp_path / "walk.mcap")
    data = bytearray(path.read_bytes())
    data[data.index(pose(15)) + 5] ^= 1
    path.write_bytes(data)
    problems = verify_recording(path)
    assert any(
        "part from byte" in line and "1 of its 30 messages lost" in line for line in problems
    )
    assert any(f"{POSE_KEY} number 15, received" in line for line in problems)
    assert any("checksum of the whole file" in problem for problem in problems)
    assert any("index counts 90 messages, and 89 can be read" in problem for problem in problems)


def test_a_payload_of_another_type_is_told_with_its_key(tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "walk.mcap") as writer:
        write(writer, pose(0), 0, 10)
        write(writer, b"\xc0", 1, 20)
        write(writer, b"\x81", 2, 30)
    (problem,) = verify_recording(writer.path)
    assert problem.startswith(f"{POSE_KEY}: 2 messages, numbers 1-2, received from ")
    assert ": undecodable; the first: no valid ObjectPose: " in problem


def test_times_of_reception_that_go_back_are_told(tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "walk.mcap") as writer:
        for number, received_ns in enumerate((10, 30, 20, 40)):
            write(writer, pose(number), number, received_ns)
    (problem,) = verify_recording(writer.path)
    assert problem == f"{POSE_KEY}: the time of reception goes back 1 time"


def test_losses_that_disagree_with_the_numbers_are_told(tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "walk.mcap") as writer:
        for number in (0, 1, 4):
            write(writer, pose(number), number, 10 * number)
        writer.add_metadata(LOSSES_RECORD, format_losses({POSE_KEY: Losses(received=5, lost=0)}))
    assert verify_recording(writer.path) == [
        f"{POSE_KEY}: received is written as 5, and the file shows 3",
        f"{POSE_KEY}: lost is written as 0, and the file shows 2",
    ]


def test_true_losses_are_no_problem(tmp_path: Path) -> None:
    counter = LossCounter()
    with RecordingWriter(tmp_path / "walk.mcap") as writer:
        for number in (3, 4, 9):
            write_frame(writer, counter, number, 100)
        dropped = dict.fromkeys(counter.losses(), 4)
        writer.add_metadata(LOSSES_RECORD, format_losses(counter.losses(dropped)))
    assert flaws(writer.path) == []


def test_keys_that_a_copy_has_beyond_the_recorder_s_are_no_problem(tmp_path: Path) -> None:
    counter = LossCounter()
    with RecordingWriter(tmp_path / "walk.mcap") as writer:
        write_frame(writer, counter, 0, 100)
        losses = {key: one for key, one in counter.losses().items() if key != POSE_KEY}
        writer.add_metadata(LOSSES_RECORD, format_losses(losses))
    assert flaws(writer.path) == []


def test_losses_in_a_foreign_form_are_told(tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "walk.mcap") as writer:
        write(writer, pose(0), 0, 10)
        writer.add_metadata(LOSSES_RECORD, {POSE_KEY: "none"})
    (problem,) = verify_recording(writer.path)
    assert "'none'" in problem


def test_a_foreign_file_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "photo.mcap"
    path.write_bytes(b"\xff\xd8\xff\xe0 a photo")
    with pytest.raises(RecordingError, match="is no recording"):
        verify_recording(path)
