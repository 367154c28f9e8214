"""Any message of a recording is found by its number, without reading the others."""

from pathlib import Path

import pytest
from inhand_runtime.recording import (
    RecordedMessage,
    RecordingError,
    RecordingWriter,
    read_recording,
)
from inhand_runtime.recording.message_index import open_index
from inhand_runtime.recording.reading import in_order_of_reception
from inhand_schemas.topics import POSE, RGBD, SKELETONS
from mcap.writer import CompressionType, Writer
from recordings import FRAME_NS, RGBD_KEY, SITE, START_NS, frame_messages, write_recording

STREAMS = (RGBD.stream, SKELETONS.stream, POSE.stream)
NAMES = {RGBD.stream: "kitchen", SKELETONS.stream: "kitchen", POSE.stream: "mug"}


def read_by_number(path: Path) -> dict[str, list[RecordedMessage]]:
    """All messages by stream, the last one first, as an order in which nobody reads."""
    with open_index(path) as index:
        found = {}
        for stream in STREAMS:
            messages = index.messages(stream, NAMES[stream])
            assert sum(index.counts(stream).values()) == len(messages)
            backwards = [messages[number] for number in reversed(range(len(messages)))]
            found[stream] = backwards[::-1]
        return found


def read_in_order(path: Path) -> dict[str, list[RecordedMessage]]:
    return {stream: list(read_recording(path, streams=(stream,))) for stream in STREAMS}


def rewritten(path: Path, output: Path, *, chunked: bool, repeated: bool) -> Path:
    """The same messages as another program may write them."""
    writer = Writer(
        str(output),
        chunk_size=2000,
        compression=CompressionType.ZSTD,
        use_chunking=chunked,
        repeat_channels=repeated,
    )
    writer.start("other")
    channels = {}
    for one in read_recording(path):
        if one.key not in channels:
            channels[one.key] = writer.register_channel(one.key, "msgpack", 0)
        writer.add_message(
            channels[one.key], one.received_ns, one.payload, one.captured_ns, one.sequence
        )
    writer.finish()
    return output


def test_messages_by_number_are_those_that_a_reader_yields(tmp_path: Path) -> None:
    path = write_recording(tmp_path / "whole.mcap")
    assert read_by_number(path) == read_in_order(path)


@pytest.mark.parametrize("offsets_s", [(0.0, 0.4, 0.2, 0.5), (9.0, 9.1, 2.0, 2.1)])
def test_messages_out_of_order_are_numbered_as_they_are_read(
    offsets_s: tuple[float, ...], tmp_path: Path
) -> None:
    path = tmp_path / "late.mcap"
    with RecordingWriter(path) as writer:
        for number, seconds in enumerate(offsets_s):
            for key, message, payload in frame_messages(number, 10):
                received_ns = START_NS + int(1e9 * seconds)
                times = {"received_ns": received_ns, "captured_ns": message.time_ns}
                writer.write(key, payload, sequence=number, **times)
    assert read_by_number(path) == read_in_order(path)


@pytest.mark.parametrize(("chunked", "repeated"), [(True, True), (False, True), (True, False)])
def test_files_of_other_programs_are_read_as_well(
    chunked: bool, repeated: bool, tmp_path: Path
) -> None:
    source = write_recording(tmp_path / "whole.mcap")
    path = rewritten(source, tmp_path / "other.mcap", chunked=chunked, repeated=repeated)
    assert read_by_number(path) == read_in_order(source)


def test_stamps_and_the_message_at_a_time_need_no_payload(tmp_path: Path) -> None:
    path = write_recording(tmp_path / "whole.mcap")
    with open_index(path) as index:
        frames = index.messages("rgbd", "kitchen")
        assert frames.stamps.sequences.tolist() == list(range(30))
        assert frames.stamps.captured_ns[7] == START_NS + 7 * FRAME_NS
        assert frames.captured_at(START_NS + 7 * FRAME_NS) == 7
        assert frames.captured_at(START_NS + 8 * FRAME_NS - 1) == 7
        assert frames.captured_at(START_NS - 1) is None
        assert len(index.messages("rgbd", "attic")) == 0


@pytest.mark.parametrize("suffix", [".mcap", ".mcap.part"])
def test_a_file_that_was_cut_anywhere_shows_what_is_whole(suffix: str, tmp_path: Path) -> None:
    source = write_recording(tmp_path / "whole.mcap")
    whole, data = read_in_order(source), source.read_bytes()
    shown = []
    for end in range(3000, len(data), 397):
        path = tmp_path / f"cut{suffix}"
        path.write_bytes(data[:end] + bytes(100 * (end % 2)))
        found = read_by_number(path)
        for stream in STREAMS:
            assert found[stream] == whole[stream][: len(found[stream])]
        with open_index(path) as index:
            assert "inhand recording recover" in str(index.note)
        shown.append(sum(map(len, found.values())))
    assert shown == sorted(shown)
    assert shown[-1] == 90


def frames_that_fail(path: Path) -> list[int]:
    """The numbers of frames that cannot be read, of which each is told with its mend."""
    failing = []
    with open_index(path) as index:
        messages = index.messages("rgbd", "kitchen")
        for number in range(len(messages)):
            try:
                messages[number]
            except RecordingError as error:
                failing += [number] * ("is damaged" in str(error) and "recover" in str(error))
    return failing


def test_one_damaged_byte_costs_the_message_it_is_in_and_no_other(tmp_path: Path) -> None:
    path = write_recording(tmp_path / "whole.mcap")
    data = bytearray(path.read_bytes())
    payload = RGBD.encode(frame_messages(12, 200)[0][1])  # type: ignore[arg-type]
    data[data.index(payload) + 100] ^= 1
    path.write_bytes(data)
    assert frames_that_fail(path) == [12]


def test_a_damaged_chunk_of_another_program_is_told(tmp_path: Path) -> None:
    source = write_recording(tmp_path / "whole.mcap")
    path = rewritten(source, tmp_path / "other.mcap", chunked=True, repeated=True)
    data = bytearray(path.read_bytes())
    data[len(data) // 3] ^= 1
    path.write_bytes(data)
    assert frames_that_fail(path)


@pytest.mark.parametrize(
    ("data", "line"),
    [(None, "does not exist"), (b"", "is empty"), (b"text and more", "no recording")],
)
def test_what_is_no_recording_is_told(data: bytes | None, line: str, tmp_path: Path) -> None:
    path = tmp_path / "none.mcap"
    if data is not None:
        path.write_bytes(data)
    with pytest.raises(RecordingError, match=line), open_index(path):
        pass


def test_a_camera_of_two_rigs_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "two.mcap"
    with RecordingWriter(path) as writer:
        for rig in ("one", "other"):
            key = RGBD.key(type(SITE)("inhand", rig), "kitchen")
            _, message, payload = frame_messages(0, 10)[0]
            writer.write(key, payload, received_ns=1, captured_ns=message.time_ns, sequence=0)
    with open_index(path) as index, pytest.raises(RecordingError, match="on 2 keys"):
        index.messages("rgbd", "kitchen")


def bytes_read() -> int:
    """Bytes that this process has read so far, by Linux."""
    lines = dict(line.split(": ") for line in Path("/proc/self/io").read_text().splitlines())
    return int(lines["rchar"])


@pytest.mark.long
def test_two_hours_open_and_jump_by_reading_a_small_part(tmp_path: Path) -> None:
    """What short files cannot show: that nothing grows with the pixels."""
    path, frames = tmp_path / "long.mcap", 216_000
    with RecordingWriter(path) as writer:
        _, _, payload = frame_messages(0, 2000)[0]
        for number in range(frames):
            time_ns = START_NS + number * FRAME_NS
            writer.write(
                RGBD_KEY, payload, received_ns=time_ns, captured_ns=time_ns, sequence=number
            )
    size, before = path.stat().st_size, bytes_read()
    with open_index(path) as index:
        messages = index.messages("rgbd", "kitchen")
        listed = bytes_read()
        assert listed - before < 0.03 * size
        assert messages[171_717].sequence == 171_717
        assert bytes_read() - listed < 100_000
        assert messages.captured_at(START_NS + 171_717 * FRAME_NS) == 171_717


def test_a_damaged_time_before_1970_ends_no_reader() -> None:
    timed = [(5, "a"), (-(2**62), "b"), (6, "c")]
    assert sorted(in_order_of_reception(timed)) == ["a", "b", "c"]
