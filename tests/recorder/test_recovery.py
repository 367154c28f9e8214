"""What is left of a cut or damaged recording is saved, and nothing that is false."""

import errno
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from inhand_recorder.faults import RECOVERY_RECORD
from inhand_recorder.inspection import inspect_recording
from inhand_recorder.losses import (
    LOSSES_RECORD,
    LossCounter,
    format_losses,
)
from inhand_recorder.recovery import recover_recording
from inhand_recorder.scanning import scan
from inhand_recorder.verification import verify_recording
from inhand_runtime.recording import (
    RecordingError,
    RecordingWriter,
    read_metadata,
    read_recording,
)
from inhand_runtime.recording.part_file import PartFile
from mcap.writer import Writer
from recordings import (
    FRAME_NS,
    POSE_KEY,
    RGBD_KEY,
    START_NS,
    contents,
    damaged_copy,
    flaws,
    frame_messages,
    write_frame,
    write_recording,
)


def is_subsequence(part: list[object], sequence: list[object]) -> bool:
    rest = iter(sequence)
    return all(item in rest for item in part)


def test_a_whole_recording_recovers_to_the_same_messages(whole: Path, tmp_path: Path) -> None:
    report = recover_recording(whole, tmp_path / "again.mcap")
    assert report.output == tmp_path / "again.mcap"
    assert (report.messages, report.keys, report.skipped_bytes) == (90, 3, 0)
    assert contents(report.output) == contents(whole)
    assert flaws(report.output) == []


def test_metadata_is_kept_and_the_origin_told(whole: Path, tmp_path: Path) -> None:
    report = recover_recording(whole, tmp_path / "again.mcap")
    metadata = read_metadata(report.output)
    assert metadata["session"] == {"participant": "p01"}
    assert metadata[RECOVERY_RECORD] == {
        "source": "walk.mcap",
        "skipped_bytes": "0",
        "unchecked": "0",
        "undecodable": "0",
        "faults": "",
    }


def test_a_recording_cut_in_half_gives_its_first_half(whole: Path, tmp_path: Path) -> None:
    data = whole.read_bytes()
    cut = damaged_copy(tmp_path, data[: len(data) // 2])
    with pytest.raises(RecordingError, match="was cut off: `inhand recording recover"):
        list(read_recording(cut))
    report = recover_recording(cut, tmp_path / "saved.mcap")
    saved = contents(report.output)
    assert saved == contents(whole)[: len(saved)]
    assert len(saved) > 30
    assert flaws(report.output) == []
    assert cut.read_bytes() == data[: len(data) // 2]


@settings(max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(share=st.floats(0, 1))
def test_a_cut_at_any_byte_gives_a_prefix(share: float, whole: Path, tmp_path: Path) -> None:
    data = whole.read_bytes()
    length = round(share * len(data))
    cut = damaged_copy(tmp_path, data[:length])
    output = tmp_path / "saved.mcap"
    output.unlink(missing_ok=True)
    everything = contents(whole)
    if data.index(everything[0][1]) + len(everything[0][1]) > length:
        with pytest.raises(RecordingError, match=r"holds no message|is empty"):
            recover_recording(cut, output)
        return
    recover_recording(cut, output)
    saved = contents(output)
    assert saved == everything[: len(saved)]
    assert flaws(output) == []
    assert all(
        data.index(payload) + len(payload) > length for _, payload, *_ in everything[len(saved) :]
    )


@settings(max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(share=st.floats(0, 1, exclude_max=True), flip=st.integers(1, 255))
def test_a_changed_byte_costs_at_most_its_chunk_and_is_noticed(
    share: float, flip: int, whole: Path, tmp_path: Path
) -> None:
    data = bytearray(whole.read_bytes())
    place = int(share * len(data))
    data[place] ^= flip
    damaged = damaged_copy(tmp_path, bytes(data))
    assert verify_recording(damaged) != []
    output = tmp_path / "saved.mcap"
    output.unlink(missing_ok=True)
    recover_recording(damaged, output)
    saved, everything = contents(output), contents(whole)
    assert is_subsequence(list(saved), list(everything))
    assert len(saved) >= len(everything) - 30
    assert flaws(output) == []


def test_overwritten_structure_is_skipped_to_the_next_chunk(whole: Path, tmp_path: Path) -> None:
    data = bytearray(whole.read_bytes())
    second = [s for s in scan(bytes(data)) if len(s.records) > 1][1]
    data[second.offset : second.offset + 60] = b"\xff" * 60
    report = recover_recording(damaged_copy(tmp_path, bytes(data)), tmp_path / "saved.mcap")
    everything = contents(whole)
    assert contents(report.output) == everything[:30] + everything[60:]
    assert report.skipped_bytes >= second.length


@pytest.mark.parametrize("noise", [b"\x06", b"\x06" + bytes(8), b"\x0c\xff\xff\x0f" + bytes(9)])
def test_damage_that_looks_like_records_takes_no_longer(
    noise: bytes, whole: Path, tmp_path: Path
) -> None:
    data = whole.read_bytes()
    third = [s for s in scan(data) if len(s.records) > 1][2]
    filler = noise * (4_000_000 // len(noise))
    noisy = damaged_copy(tmp_path, data[: third.offset] + filler + data[third.offset :])
    start = time.monotonic()
    report = recover_recording(noisy, tmp_path / "saved.mcap")
    assert time.monotonic() - start < 30
    assert contents(report.output) == contents(whole)
    assert report.skipped_bytes == len(filler)


def test_zeros_at_the_end_of_a_crashed_disk_are_no_messages(whole: Path, tmp_path: Path) -> None:
    data = whole.read_bytes()
    position = data.index(frame_messages(25, 200)[0][2])
    cut = damaged_copy(tmp_path, data[:position] + bytes(100_000))
    report = recover_recording(cut, tmp_path / "saved.mcap")
    assert contents(report.output) == contents(whole)[:75]
    assert flaws(report.output) == []


def test_the_part_recovers_to_the_name_that_it_was_meant_for(tmp_path: Path) -> None:
    path = write_recording(tmp_path / "walk.mcap")
    everything = contents(path)
    part = path.rename(tmp_path / "walk.mcap.part")
    report = recover_recording(part, path)
    assert contents(report.output) == everything
    assert sorted(p.name for p in tmp_path.iterdir()) == ["walk.mcap", "walk.mcap.part"]


def test_an_existing_output_is_never_overwritten(whole: Path, tmp_path: Path) -> None:
    output = tmp_path / "precious.mcap"
    output.write_bytes(b"precious")
    with pytest.raises(RecordingError, match="exists already"):
        recover_recording(whole, output)
    assert output.read_bytes() == b"precious"
    with pytest.raises(RecordingError, match="exists already"):
        recover_recording(whole, whole)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "is empty: nothing was recorded into it; delete it"),
        (bytes(4096), "is empty: nothing was recorded into it; delete it"),
        (b"\x89MCAP0\r\n", "holds no message"),
        (b"PK\x03\x04 something else entirely", "is no recording"),
        (None, "does not exist"),
    ],
)
def test_nothing_to_recover_is_told_and_leaves_no_file(
    content: bytes | None, message: str, tmp_path: Path
) -> None:
    path = tmp_path / "x.mcap.part"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(RecordingError, match=message):
        recover_recording(path, tmp_path / "out.mcap")
    assert [p.name for p in tmp_path.iterdir()] in (["x.mcap.part"], [])


def write_foreign(path: Path, topic: str) -> Path:
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start()
        for number, key in enumerate((topic, POSE_KEY)):
            channel = writer.register_channel(key, "msgpack", 0)
            payload = frame_messages(number, 1)[2][2]
            writer.add_message(channel, START_NS, payload, START_NS, number)
        writer.add_metadata(LOSSES_RECORD, {POSE_KEY: "many"})
        writer.finish()
    return path


def test_keys_of_others_are_left_out(tmp_path: Path) -> None:
    foreign = write_foreign(tmp_path / "foreign.mcap", "camera/image")
    report = recover_recording(foreign, tmp_path / "saved.mcap")
    assert (report.messages, report.keys) == (1, 1)
    assert report.skipped_bytes == len(frame_messages(0, 1)[2][2])
    assert [key for key, *_ in contents(report.output)] == [POSE_KEY]
    types = [(key.key, key.type) for key in inspect_recording(foreign).keys]
    assert types == [("camera/image", "unknown"), (POSE_KEY, "ObjectPose")]


def test_a_newer_version_is_refused_and_leaves_no_file(tmp_path: Path) -> None:
    newer = write_foreign(tmp_path / "newer.mcap", "inhand/@v2/rig/pose/mug")
    with pytest.raises(RecordingError, match=r"version 2.*update the older side"):
        recover_recording(newer, tmp_path / "saved.mcap")
    assert list(tmp_path.iterdir()) == [newer]


def test_what_the_queue_dropped_is_still_told(tmp_path: Path) -> None:
    counter = LossCounter()
    with RecordingWriter(tmp_path / "walk.mcap") as writer:
        for number in (1, 4):
            write_frame(writer, counter, number, 10)
        losses = format_losses(counter.losses({POSE_KEY: 2}))
        writer.add_metadata(LOSSES_RECORD, losses)
    report = recover_recording(writer.path, tmp_path / "saved.mcap")
    assert read_metadata(report.output)[LOSSES_RECORD] == losses


def test_a_full_disk_is_told_and_leaves_no_file(
    whole: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def write(file: PartFile, *parts: bytes) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(PartFile, "write", write)
    with pytest.raises(RecordingError, match=r"cannot write .*saved.mcap: No space left"):
        recover_recording(whole, tmp_path / "saved.mcap")
    assert list(tmp_path.iterdir()) == []


def test_a_folder_is_no_recording(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"cannot read .*Is a directory"):
        recover_recording(tmp_path, tmp_path / "saved.mcap")


def test_a_cut_recording_can_be_inspected(whole: Path, tmp_path: Path) -> None:
    cut = damaged_copy(tmp_path, whole.read_bytes()[:-600])
    info, full = inspect_recording(cut), inspect_recording(whole)
    assert (info.complete, full.complete) == (False, True)
    assert full.metadata["session"] == info.metadata["session"]
    assert full.messages == info.messages == 90
    assert full.start_ns == START_NS + 2_000_000
    assert full.duration_s == pytest.approx(29 * FRAME_NS / 1e9)
    rgbd = next(key for key in full.keys if key.key == RGBD_KEY)
    assert (rgbd.type, rgbd.messages, rgbd.lost) == ("RgbdFrame", 30, 0)
    assert rgbd.rate_hz == pytest.approx(30, abs=0.01)
    assert rgbd.bytes == sum(len(frame_messages(n, 200)[0][2]) for n in range(30))


CHILD = """
import sys, time
from pathlib import Path
from inhand_recorder.losses import LossCounter
from inhand_runtime.recording import RecordingWriter
from recordings import write_frame
writer, counter = RecordingWriter(Path(sys.argv[1])), LossCounter()
start = time.monotonic()
synced = start
for number in range(10_000):
    time.sleep(max(0, start + number / 30 - time.monotonic()))
    write_frame(writer, counter, number, 40_000)
    print(number, flush=True)
    if time.monotonic() - synced >= 1:
        writer.sync()
        synced = time.monotonic()
"""


def test_a_killed_recorder_loses_at_most_one_second(tmp_path: Path) -> None:
    path = tmp_path / "walk.mcap"
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    with subprocess.Popen(
        [sys.executable, "-c", CHILD, str(path)], stdout=subprocess.PIPE, env=environment
    ) as child:
        assert child.stdout is not None
        last = -1
        while last < 75:
            last = int(child.stdout.readline())
        time.sleep(0.01)
        child.send_signal(signal.SIGKILL)
        last = int((child.stdout.read().split() or [last])[-1])
    assert not path.exists()
    part = tmp_path / "walk.mcap.part"
    assert not inspect_recording(part).complete
    recover_recording(part, path)
    sequences = [m.sequence for m in read_recording(path, streams=["rgbd"])]
    assert sequences == list(range(len(sequences)))
    assert last - 30 <= sequences[-1] <= last + 1
    assert flaws(path) == []
