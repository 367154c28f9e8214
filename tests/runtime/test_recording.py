"""Recordings are written safely and read as they were written."""

import json
import os
import resource
import signal
import subprocess
import sys
from pathlib import Path

import msgpack
import pytest
from inhand_runtime.recording import (
    RecordingError,
    RecordingWriter,
    read_metadata,
    read_recording,
)
from inhand_schemas.errors import KeyFormatError, UnknownVersionError
from inhand_schemas.json_schema import json_schema
from inhand_schemas.keys import Site
from inhand_schemas.messages import ObjectPose, Skeletons
from inhand_schemas.topics import POSE, SKELETONS
from mcap.reader import make_reader
from mcap.writer import Writer

POSE_KEY = POSE.key(Site(), "mug")
SKELETONS_KEY = SKELETONS.key(Site(), "kitchen")


def pose(sequence: int) -> ObjectPose:
    return ObjectPose(
        sequence=sequence,
        time_ns=1000 + sequence,
        object="mug",
        camera="kitchen",
        state="lost",
        confidence=0.0,
    )


def write_pose(writer: RecordingWriter, sequence: int, received_ns: int | None = None) -> None:
    message = pose(sequence)
    writer.write(
        POSE_KEY,
        POSE.encode(message),
        received_ns=message.time_ns + 5 if received_ns is None else received_ns,
        captured_ns=message.time_ns,
        sequence=message.sequence,
    )


def write_foreign(path: Path, topic: str, encoding: str = "msgpack") -> None:
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start()
        channel = writer.register_channel(topic, encoding, 0)
        writer.add_message(channel, 1, b"\xc0", 1)
        writer.finish()


def test_what_is_written_is_read(tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "walk.mcap") as writer:
        write_pose(writer, 7)
    (read,) = read_recording(tmp_path / "walk.mcap")
    assert (read.key, read.topic, read.name) == (POSE_KEY, POSE, "mug")
    assert (read.received_ns, read.captured_ns, read.sequence) == (1012, 1007, 7)
    assert read.message() == pose(7)


def test_messages_come_in_the_order_of_reception(tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "walk.mcap") as writer:
        for sequence, received_ns in enumerate((50, 20, 40)):
            write_pose(writer, sequence, received_ns)
            writer.sync()
    received = [message.received_ns for message in read_recording(tmp_path / "walk.mcap")]
    assert received == [20, 40, 50]


def test_what_was_received_after_a_clock_was_set_back_comes_after(tmp_path: Path) -> None:
    hour_ns = 3600 * 10**9
    times = (hour_ns + 50, hour_ns + 20, 30, 10, hour_ns + 60)
    with RecordingWriter(tmp_path / "set.mcap") as writer:
        for sequence, received_ns in enumerate(times):
            write_pose(writer, sequence, received_ns)
            writer.sync()
    received = [message.received_ns for message in read_recording(tmp_path / "set.mcap")]
    assert received == [hour_ns + 20, hour_ns + 50, 10, 30, hour_ns + 60]


def test_streams_are_chosen_by_name(tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "walk.mcap") as writer:
        write_pose(writer, 0)
        people = Skeletons(sequence=0, time_ns=0)
        payload = SKELETONS.encode(people)
        writer.write(SKELETONS_KEY, payload, received_ns=0, captured_ns=0, sequence=0)
    chosen = list(read_recording(tmp_path / "walk.mcap", streams={"skeletons"}))
    assert [message.key for message in chosen] == [SKELETONS_KEY]
    assert list(read_recording(tmp_path / "walk.mcap", streams=[])) == []


def test_any_mcap_reader_finds_schemas_and_plain_msgpack(tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "walk.mcap") as writer:
        write_pose(writer, 3)
    with (tmp_path / "walk.mcap").open("rb") as file:
        reader = make_reader(file, validate_crcs=True)
        assert reader.get_header().profile == "inhand"
        ((schema, channel, message),) = reader.iter_messages()
    assert schema is not None
    assert (schema.name, schema.encoding) == ("ObjectPose.v1", "jsonschema")
    assert json.loads(schema.data) == json_schema(ObjectPose)
    assert (channel.topic, channel.message_encoding) == (POSE_KEY, "msgpack")
    assert (message.log_time, message.publish_time, message.sequence) == (1008, 1003, 3)
    assert msgpack.unpackb(message.data)["object"] == "mug"


def test_sequences_keep_their_lowest_32_bits(tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "walk.mcap") as writer:
        write_pose(writer, 2**40 + 9)
    (read,) = read_recording(writer.path)
    assert read.sequence == 9
    assert read.message().sequence == 2**40 + 9


def test_metadata_is_kept_and_the_last_of_a_name_counts(tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "walk.mcap") as writer:
        writer.add_metadata("session", {"participant": "p01"})
        writer.add_metadata("losses", {"a": "1"})
        writer.add_metadata("losses", {"a": "2"})
    assert read_metadata(writer.path) == {"session": {"participant": "p01"}, "losses": {"a": "2"}}


def test_the_name_is_final_only_when_the_file_is_whole(tmp_path: Path) -> None:
    writer = RecordingWriter(tmp_path / "walk.mcap")
    write_pose(writer, 0)
    assert [path.name for path in tmp_path.iterdir()] == ["walk.mcap.part"]
    assert writer.close() == tmp_path / "walk.mcap"
    assert [path.name for path in tmp_path.iterdir()] == ["walk.mcap"]
    assert writer.close() == tmp_path / "walk.mcap"


def test_synced_messages_are_in_the_file(tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "walk.mcap") as writer:
        write_pose(writer, 0)
        before = writer.bytes_written
        writer.sync()
        part = tmp_path / "walk.mcap.part"
        assert writer.bytes_written == part.stat().st_size > before
        assert POSE.encode(pose(0)) in part.read_bytes()


def test_an_exception_leaves_the_part_with_all_messages(tmp_path: Path) -> None:
    def record_and_fail() -> None:
        with RecordingWriter(tmp_path / "walk.mcap") as writer:
            write_pose(writer, 0)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        record_and_fail()
    assert [path.name for path in tmp_path.iterdir()] == ["walk.mcap.part"]
    assert POSE.encode(pose(0)) in (tmp_path / "walk.mcap.part").read_bytes()


def test_a_closed_writer_refuses_messages(tmp_path: Path) -> None:
    writer = RecordingWriter(tmp_path / "walk.mcap")
    writer.close()
    with pytest.raises(RecordingError, match="is closed"):
        write_pose(writer, 0)


def test_a_foreign_key_is_refused(tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "walk.mcap") as writer:
        with pytest.raises(KeyFormatError):
            writer.write("camera/image", b"", received_ns=0, captured_ns=0, sequence=0)
        write_pose(writer, 0)
    assert len(list(read_recording(writer.path))) == 1


def test_existing_files_are_never_overwritten(tmp_path: Path) -> None:
    (tmp_path / "walk.mcap").write_bytes(b"precious")
    with pytest.raises(RecordingError, match="exists already: choose another name"):
        RecordingWriter(tmp_path / "walk.mcap")
    (tmp_path / "run.mcap.part").write_bytes(b"precious")
    with pytest.raises(RecordingError, match="inhand recording recover"):
        RecordingWriter(tmp_path / "run.mcap")
    assert {path.read_bytes() for path in tmp_path.iterdir()} == {b"precious"}


def test_a_folder_that_is_not_there_is_told(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"cannot create .*No such file or directory: use a"):
        RecordingWriter(tmp_path / "missing" / "walk.mcap")


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (None, "does not exist: check the path"),
        (b"", "is empty: nothing was recorded into it; delete it"),
        (b"\x89MCAP0\r\n", "was cut off: `inhand recording recover .*` saves what is left"),
        (b"\x89MCAP0\r\n" * 2, "cannot read|is damaged"),
        (b"not a recording at all", "is no recording: give a .mcap file"),
    ],
)
def test_what_is_no_whole_recording_is_told_in_one_line(
    content: bytes | None, message: str, tmp_path: Path
) -> None:
    path = tmp_path / "walk.mcap"
    if content is not None:
        path.write_bytes(content)
    for read in (lambda: list(read_recording(path)), lambda: read_metadata(path)):
        with pytest.raises(RecordingError, match=message) as raised:
            read()
        assert "\n" not in str(raised.value)


def test_damage_anywhere_is_an_error_or_harmless(tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "walk.mcap") as writer:
        for sequence in range(3):
            write_pose(writer, sequence)
    whole = writer.path.read_bytes()
    damaged = tmp_path / "damaged.mcap"
    payloads = {POSE.encode(pose(sequence)) for sequence in range(3)}
    for place in range(0, len(whole), 7):
        data = bytearray(whole)
        data[place] ^= 0xFF
        damaged.write_bytes(data)
        try:
            assert {message.payload for message in read_recording(damaged)} <= payloads
        except (RecordingError, UnknownVersionError):
            continue


@pytest.mark.parametrize("topic", ["camera/image", "inhand/@v1/rig/unheard/mug", "inhand/rig"])
def test_foreign_keys_are_passed_over(topic: str, tmp_path: Path) -> None:
    write_foreign(tmp_path / "foreign.mcap", topic)
    assert list(read_recording(tmp_path / "foreign.mcap")) == []


def test_a_key_in_another_encoding_is_passed_over(tmp_path: Path) -> None:
    write_foreign(tmp_path / "foreign.mcap", POSE_KEY, "json")
    assert list(read_recording(tmp_path / "foreign.mcap")) == []


def test_an_unknown_version_is_told(tmp_path: Path) -> None:
    write_foreign(tmp_path / "newer.mcap", "inhand/@v2/rig/pose/mug")
    with pytest.raises(UnknownVersionError, match="version 2"):
        list(read_recording(tmp_path / "newer.mcap"))


FILL_THE_DISK = """
import sys
from pathlib import Path
from inhand_runtime.recording import RecordingError, RecordingWriter
from inhand_schemas.messages import Preview
from inhand_schemas.topics import PREVIEW
writer = RecordingWriter(Path(sys.argv[1]))
for sequence in range(400):
    message = Preview(sequence=sequence, time_ns=sequence, width=64, height=48, jpeg=bytes(10_000))
    times = {"received_ns": sequence, "captured_ns": sequence}
    try:
        writer.write(
            "inhand/@v1/rig/preview/a", PREVIEW.encode(message), sequence=sequence, **times
        )
        if sequence % 30 == 29:
            writer.sync()
    except RecordingError as error:
        print(error)
        break
for again in (writer.sync, writer.close, writer.close):
    try:
        again()
    except RecordingError as error:
        print(error)
"""


def limit_file_size() -> None:
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1_000_000, 1_000_000))


def test_a_full_disk_is_told_each_time_and_leaves_a_recoverable_part(tmp_path: Path) -> None:
    path = tmp_path / "walk.mcap"
    finished = subprocess.run(
        [sys.executable, "-W", "error", "-c", FILL_THE_DISK, str(path)],
        env=os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)},
        preexec_fn=limit_file_size,
        capture_output=True,
        text=True,
        check=True,
    )
    lines = finished.stdout.splitlines()
    assert len(lines) == 4
    assert len(set(lines)) == 1
    assert lines[0].startswith(f"cannot write {path}.part: File too large: make room")
    assert finished.stderr == ""
    assert [p.name for p in tmp_path.iterdir()] == ["walk.mcap.part"]
    assert (tmp_path / "walk.mcap.part").stat().st_size == 1_000_000
