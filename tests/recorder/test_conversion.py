"""Recordings are merged, cut, filtered and split, and what is carried over stays true."""

from pathlib import Path

import inhand_recorder
import pytest
from inhand_recorder.attachments import read_attachments
from inhand_recorder.clock import CLOCK_RECORD
from inhand_recorder.conversion import Conversion, Selection, convert_recording
from inhand_recorder.losses import LOSSES_RECORD
from inhand_recorder.verification import verify_recording
from inhand_runtime.recording import (
    RecordingError,
    RecordingWriter,
    read_metadata,
    read_recording,
)
from inhand_schemas.keys import Site
from inhand_schemas.topics import INFO, POSE
from recordings import POSE_KEY, SKELETONS_KEY, contents, frame_messages
from small_rig import DELAY_NS, FRAME_NS, START_NS, write_rig


def convert(
    inputs: list[Path], output: Path, selection: Selection | None = None, split: float = 0.0
) -> Conversion:
    with inhand_recorder.open(inputs) as recording:
        return convert_recording(recording, output, selection or Selection(), split_seconds=split)


def frames_in(path: Path) -> list[int]:
    return [one.sequence for one in read_recording(path, streams=("rgbd",))]


def test_split_files_become_one_with_all_that_is_in_them(tmp_path: Path) -> None:
    one = write_rig(tmp_path / "one.mcap")
    two = write_rig(tmp_path / "two.mcap", first=12)
    done = convert([two, one], tmp_path / "all.mcap")
    assert verify_recording(tmp_path / "all.mcap") == []
    without_second_info = [c for c in contents(two) if "/info/" not in c[0]]
    assert contents(tmp_path / "all.mcap") == contents(one) + without_second_info
    assert [one.messages for one in done.files] == [81]
    records = read_metadata(tmp_path / "all.mcap")
    assert records["session"] == {"participant": "p01"}
    assert records[LOSSES_RECORD]["inhand/@v1/rig/rgbd/front"].startswith("received=20 lost=2 ")
    assert records["conversion"]["sources"] == "one.mcap\ntwo.mcap"
    assert "received=10 lost=0" in records["conversion"]["losses of two.mcap"]


def test_rigs_at_one_time_are_merged_in_the_order_of_time(tmp_path: Path) -> None:
    one = write_rig(tmp_path / "one.mcap")
    two = write_rig(tmp_path / "two.mcap", first=3, site=Site(rig="hall"))
    convert([one, two], tmp_path / "all.mcap")
    assert verify_recording(tmp_path / "all.mcap") == []
    times = [one.received_ns for one in read_recording(tmp_path / "all.mcap")]
    assert times == sorted(times)
    assert len(times) == 82


def test_different_messages_of_one_key_at_one_time_are_refused(tmp_path: Path) -> None:
    paths = [tmp_path / "hall.mcap", tmp_path / "kitchen.mcap"]
    for place, path in enumerate(paths):
        with RecordingWriter(path) as writer:
            for number in range(10):
                payload = frame_messages(number, 1)[2][2]
                time_ns = START_NS + number * FRAME_NS + place * 1000
                stamp = {"received_ns": time_ns, "captured_ns": time_ns, "sequence": number}
                writer.write(POSE_KEY, payload, **stamp)
    with pytest.raises(RecordingError, match=r"hall.* and .* hold different messages"):
        convert(paths, tmp_path / "all.mcap")
    assert not (tmp_path / "all.mcap").exists()


def test_a_copy_fills_what_another_file_lacks(tmp_path: Path) -> None:
    whole = write_rig(tmp_path / "whole.mcap")
    damaged = tmp_path / "damaged.mcap"
    data = bytearray(whole.read_bytes())
    payload = next(m.payload for m in read_recording(whole, streams=("pose",)) if m.sequence == 3)
    data[data.index(payload) + len(payload) - 3] ^= 0xFF
    damaged.write_bytes(data)
    assert convert([damaged, whole], tmp_path / "all.mcap").damaged == {"pose/mug": 1}
    assert contents(tmp_path / "all.mcap") == contents(whole)


def test_a_cut_begins_with_the_cameras_infos(tmp_path: Path) -> None:
    path = write_rig(tmp_path / "long.mcap", frames=30)
    start_ns = START_NS + 10 * FRAME_NS
    convert(
        [path], tmp_path / "cut.mcap", Selection(start_ns=start_ns, end_ns=start_ns + 5 * FRAME_NS)
    )
    assert verify_recording(tmp_path / "cut.mcap") == []
    first, *others = read_recording(tmp_path / "cut.mcap")
    assert first.topic is INFO
    assert first.received_ns == START_NS + 10 * FRAME_NS + DELAY_NS
    assert frames_in(tmp_path / "cut.mcap") == [10, 11, 12, 13, 14]
    assert {one.topic for one in others} & {INFO} == set()
    about = read_metadata(tmp_path / "cut.mcap")["conversion"]
    assert about["start_ns"] == str(start_ns)


def test_topics_are_included_and_excluded_by_pattern(tmp_path: Path) -> None:
    path = write_rig(tmp_path / "one.mcap")
    convert(
        [path], tmp_path / "few.mcap", Selection(include=("*/mug", "info/*"), exclude=("label/*",))
    )
    assert verify_recording(tmp_path / "few.mcap") == []
    assert {one.topic for one in read_recording(tmp_path / "few.mcap")} == {INFO, POSE}
    with pytest.raises(RecordingError, match="there is no topic 'poses/\\*'"):
        convert([path], tmp_path / "none.mcap", Selection(exclude=("poses/*",)))
    with pytest.raises(RecordingError, match="no topic is left"):
        convert([path], tmp_path / "none.mcap", Selection(exclude=("*",)))


def test_a_split_is_several_files_that_stand_alone(tmp_path: Path) -> None:
    path = write_rig(tmp_path / "long.mcap", frames=30)
    done = convert([path], tmp_path / "part.mcap", split=0.4)
    names = [one.path.name for one in done.files]
    assert names == ["part_000.mcap", "part_001.mcap", "part_002.mcap"]
    assert [n for name in names for n in frames_in(tmp_path / name)] == list(range(30))
    for name in names:
        assert verify_recording(tmp_path / name) == []
        assert next(iter(read_recording(tmp_path / name))).topic is INFO
    with inhand_recorder.open([tmp_path / name for name in names]) as recording:
        assert len(recording) == len(contents(path))


def test_steps_of_the_clock_and_drops_are_carried_over(tmp_path: Path) -> None:
    path = tmp_path / "stepped.mcap"
    with RecordingWriter(path) as writer:
        for number in (0, 1, 4):
            time_ns = START_NS + number * FRAME_NS
            stamp = {"received_ns": time_ns, "captured_ns": time_ns, "sequence": number}
            writer.write(POSE_KEY, frame_messages(number, 1)[2][2], **stamp)
        writer.add_metadata(CLOCK_RECORD, {str(START_NS + FRAME_NS): "+500000000", "5": "-1"})
        losses = {POSE_KEY: "received=3 lost=2 restarts=0 dropped=1"}
        writer.add_metadata(LOSSES_RECORD, losses)
    convert([path], tmp_path / "all.mcap")
    assert read_metadata(tmp_path / "all.mcap")[LOSSES_RECORD] == losses
    convert([path], tmp_path / "cut.mcap", Selection(end_ns=START_NS + 2 * FRAME_NS))
    records = read_metadata(tmp_path / "cut.mcap")
    assert records[CLOCK_RECORD] == {str(START_NS + FRAME_NS): "+500000000"}
    assert records[LOSSES_RECORD] == {POSE_KEY: "received=2 lost=0 restarts=0 dropped=0"}
    assert "dropped=1" in records["conversion"]["losses of stepped.mcap"]


def test_nothing_stays_of_a_conversion_that_fails_and_no_file_is_changed(tmp_path: Path) -> None:
    path = write_rig(tmp_path / "long.mcap", frames=30)
    before = path.read_bytes()
    with pytest.raises(RecordingError, match="exists already"):
        convert([path], path)
    (tmp_path / "part_002.mcap").write_bytes(b"mine")
    with pytest.raises(RecordingError, match=r"part_002.* exists already"):
        convert([path], tmp_path / "part.mcap", split=0.4)

    def interrupt() -> None:
        if len(list(tmp_path.rglob("other_*"))) > 1:
            assert list(tmp_path.glob("other_*")) == []  # none looks finished before all are
            raise KeyboardInterrupt

    other = tmp_path / "other.mcap"
    with inhand_recorder.open(path) as recording, pytest.raises(KeyboardInterrupt):
        convert_recording(recording, other, Selection(), split_seconds=0.4, on_message=interrupt)
    with pytest.raises(RecordingError, match="no message is left"):
        convert([path], tmp_path / "early.mcap", Selection(end_ns=5))
    assert sorted(one.name for one in tmp_path.iterdir()) == ["long.mcap", "part_002.mcap"]
    assert path.read_bytes() == before


def test_pauses_publishers_and_meshes_are_carried_over_and_joined(tmp_path: Path) -> None:
    values = (
        {"pauses": {"7": ""}, "publishers": {POSE_KEY: "tracker mug"}},
        {"pauses": {"7": "9"}, "objects": {"mug": "its model is mug.model"}},
    )
    for number, records in enumerate(values):
        with RecordingWriter(tmp_path / f"{number}.mcap") as writer:
            time_ns = START_NS + number * FRAME_NS
            stamp = {"received_ns": time_ns, "captured_ns": time_ns, "sequence": number}
            writer.write(POSE_KEY, frame_messages(number, 1)[2][2], **stamp)
            mesh = ("objects/mug/mesh.ply", "application/ply", b"ply")
            writer.add_attachment(*mesh, received_ns=time_ns)
            for name, record in records.items():
                writer.add_metadata(name, record)
    convert([tmp_path / "0.mcap", tmp_path / "1.mcap"], tmp_path / "all.mcap")
    assert verify_recording(tmp_path / "all.mcap") == []
    records = read_metadata(tmp_path / "all.mcap")
    assert records["pauses"] == {"7": "9"}
    assert records["publishers"] == {POSE_KEY: "tracker mug"}
    assert records["objects"] == {"mug": "its model is mug.model"}
    (attached,) = read_attachments(tmp_path / "all.mcap")
    assert (attached.name, attached.data) == ("objects/mug/mesh.ply", b"ply")


def apart_in(path: Path) -> list[tuple[str, int, bytes]]:
    """What a file keeps apart, and that it is so in a channel that readers pass over."""
    read = read_recording(path, apart=True)
    return [(one.key, one.received_ns, one.payload) for one in read if one.apart]


def write_with_apart(path: Path, first: int = 0) -> Path:
    """Ten poses; the third could not be read, and nothing of the skeletons could."""
    with RecordingWriter(path) as writer:
        for number in range(first, first + 10):
            time_ns = START_NS + number * FRAME_NS
            if number % 10 == 2:
                for key in (POSE_KEY, SKELETONS_KEY):
                    writer.write_apart(key, bytes([0xC1, number]), received_ns=time_ns)
                continue
            stamp = {"received_ns": time_ns, "captured_ns": time_ns, "sequence": number}
            writer.write(POSE_KEY, frame_messages(number, 1)[2][2], **stamp)
    return path


def test_what_could_not_be_read_when_it_was_recorded_is_kept_apart_again(tmp_path: Path) -> None:
    paths = [write_with_apart(tmp_path / f"{first}.mcap", first) for first in (0, 10)]
    recorded = [one for path in paths for one in apart_in(path)]
    output = tmp_path / "all.mcap"
    assert convert([*paths, paths[0]], output).apart == 4
    assert apart_in(output) == recorded
    assert len(contents(output)) == 18
    assert verify_recording(output) == []
    copy = tmp_path / "copy.mcap"
    copy.write_bytes(paths[0].read_bytes())
    assert convert([copy, *paths], tmp_path / "once.mcap").apart == 4
    end_ns = START_NS + 10 * FRAME_NS
    chosen = Selection(include=("pose/*",), end_ns=end_ns)
    assert convert(paths, tmp_path / "part.mcap", chosen).apart == 1
    assert apart_in(tmp_path / "part.mcap") == recorded[:1]
    files = convert(paths, tmp_path / "split.mcap", split=0.33).files
    assert [one for file in files for one in apart_in(file.path)] == recorded
