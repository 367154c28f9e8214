"""Recordings of several hosts are made one: nothing is lost, and all is in one clock's order."""

from dataclasses import replace
from pathlib import Path

import inhand_recorder
import pytest
from inhand_recorder.attachments import attach_mesh, meshes_in, read_attachments
from inhand_recorder.conversion import Selection, convert_recording
from inhand_recorder.conversion_records import records_of
from inhand_recorder.losses import LOSSES_RECORD, LossCounter
from inhand_recorder.merging import (
    MERGE_RECORD,
    HostClock,
    Merged,
    clock_of_shared,
    hosts_of,
    merge_recordings,
    shared_receptions,
)
from inhand_recorder.provenance import PUBLISHERS_RECORD, with_publisher
from inhand_recorder.verification import verify_recording
from inhand_runtime.recording import (
    RecordedMessage,
    RecordingError,
    RecordingWriter,
    read_metadata,
    read_recording,
)
from inhand_runtime.recording.copying import copy_message, write_beside
from inhand_schemas.keys import Site
from inhand_schemas.messages import ObjectPose
from inhand_schemas.topics import LABEL, POSE
from msgspec import structs
from small_rig import FRAME_NS, START_NS, write_rig

OWN = HostClock(0, "its own")
LATE_NS = 1_500_000_000


def merge(
    paths: list[Path], output: Path, clocks: list[HostClock], exclude: tuple[str, ...] = ()
) -> Merged:
    recordings = [inhand_recorder.open([path]) for path in paths]
    try:
        return merge_recordings(hosts_of(recordings, exclude), clocks, output)
    finally:
        for one in recordings:
            one.close()


def shifted(path: Path, output: Path, later_ns: int, camera: str | None = None) -> Path:
    """Write a recording again as a host with another clock received it, or another camera."""
    with RecordingWriter(output) as writer:
        for one in read_recording(path):
            payload, message = one.payload, one.message()
            if camera is not None and isinstance(message, ObjectPose):
                payload = LABEL.encode(structs.replace(message, camera=camera))
                captured_ns = one.captured_ns + 1
            else:
                captured_ns = one.captured_ns
            if camera is None or one.topic is LABEL:
                writer.write(
                    one.key,
                    payload,
                    received_ns=one.received_ns + later_ns,
                    captured_ns=captured_ns,
                    sequence=one.sequence,
                )
    return output


def test_two_rigs_become_one_file_in_the_order_of_the_first_ones_clock(tmp_path: Path) -> None:
    one = write_rig(tmp_path / "one.mcap")
    late = write_rig(tmp_path / "late.mcap", first=45, site=Site(rig="hall"))
    clock = HostClock(-LATE_NS, "somebody said so", 1000)
    merged = merge([one, late], tmp_path / "all.mcap", [OWN, clock])
    assert verify_recording(tmp_path / "all.mcap") == []
    read = list(read_recording(tmp_path / "all.mcap"))
    times = [message.received_ns for message in read]
    assert times == sorted(times)

    def bare(message: RecordedMessage, later_ns: int = 0) -> RecordedMessage:
        return replace(message, received_ns=message.received_ns + later_ns)

    expected = [*map(bare, read_recording(one))]
    expected += [bare(message, -LATE_NS) for message in read_recording(late)]
    assert sorted(read, key=str) == sorted(expected, key=str)
    assert merged.by_source == {"one.mcap": 41, "late.mcap": 41}
    records = read_metadata(tmp_path / "all.mcap")
    assert records["session"] == {"participant": "p01"}
    assert records[MERGE_RECORD]["sources"] == "one.mcap\nlate.mcap"
    said = records[MERGE_RECORD]["clock of late.mcap"]
    assert said == "offset_ns=-1500000000 deviation_ns=1000: somebody said so"
    assert "received=10 lost=0" in records[MERGE_RECORD]["losses of late.mcap"]
    assert records[LOSSES_RECORD]["inhand/@v1/hall/rgbd/front"].startswith("received=10 lost=0")


def test_a_clock_that_drifts_is_followed() -> None:
    clock = HostClock(500, "people", drift=1e-3, at_ns=10_000)
    assert [clock.of_first(time_ns) for time_ns in (9_500, 19_500)] == [10_000, 20_010]


def test_what_both_hosts_received_says_their_clocks_and_is_there_once(tmp_path: Path) -> None:
    one = write_rig(tmp_path / "one.mcap")
    two = shifted(write_rig(tmp_path / "more.mcap", frames=14), tmp_path / "two.mcap", LATE_NS)
    with inhand_recorder.open([one]) as first, inhand_recorder.open([two]) as other:
        hosts = hosts_of([first, other])
        clock = clock_of_shared(shared_receptions(*hosts), hosts[0].name)
        assert clock is not None
        assert (clock.offset_ns, clock.deviation_ns) == (-LATE_NS, 0)
        assert clock.evidence.startswith("41 messages that one.mcap received too")
        merged = merge_recordings(hosts, [OWN, clock], tmp_path / "all.mcap")
    assert merged.repeated == 41
    whole = [(m.key, m.sequence, m.received_ns) for m in read_recording(tmp_path / "more.mcap")]
    read = [(m.key, m.sequence, m.received_ns) for m in read_recording(tmp_path / "all.mcap")]
    assert sorted(read) == sorted(whole)


def test_different_messages_of_one_key_are_refused_with_the_mend(tmp_path: Path) -> None:
    one = write_rig(tmp_path / "one.mcap")
    other = write_rig(tmp_path / "other.mcap", first=300)
    with pytest.raises(RecordingError, match=r"--exclude 'pose/mug'.*or record each host"):
        merge([one, other], tmp_path / "all.mcap", [OWN, OWN], ("label/*", "info/*"))
    assert not list(tmp_path.glob("all*"))
    exclude = ("pose/*", "rgbd/*", "skeletons/*", "info/*")
    with pytest.raises(RecordingError, match=r"different messages of .*label/mug"):
        merge([one, other], tmp_path / "all.mcap", [OWN, OWN], exclude)


def other_poses(path: Path, output: Path) -> Path:
    """Write a recording again with all times and numbers as they are, and other poses."""
    with RecordingWriter(output) as writer:
        for one in read_recording(path):
            message, payload = one.message(), one.payload
            if isinstance(message, ObjectPose) and one.topic is POSE:
                payload = POSE.encode(structs.replace(message, confidence=0.125))
            write_beside(writer, one.key, one, payload)
    return output


def test_different_messages_of_one_number_and_time_are_no_copies(tmp_path: Path) -> None:
    one = write_rig(tmp_path / "one.mcap")
    other = other_poses(one, tmp_path / "other.mcap")
    with pytest.raises(RecordingError, match=r"different messages of .*pose/mug"):
        merge([one, other], tmp_path / "all.mcap", [OWN, OWN])
    with (
        inhand_recorder.open([one, other]) as both,
        pytest.raises(RecordingError, match=r"different messages of .*pose/mug"),
    ):
        convert_recording(both, tmp_path / "all.mcap", Selection())
    assert not list(tmp_path.glob("all*"))


def test_meshes_of_one_name_that_differ_are_kept_and_named(tmp_path: Path) -> None:
    paths = []
    for rig in ("hall", "attic"):
        path = tmp_path / f"{rig}.mcap"
        with RecordingWriter(path) as writer:
            attach_mesh(writer, "mug", rig.encode(), START_NS)
            attach_mesh(writer, "jug", b"alike", START_NS)
            for one in read_recording(write_rig(tmp_path / "rig.mcap", site=Site(rig=rig))):
                copy_message(writer, one)
        (tmp_path / "rig.mcap").unlink()
        paths.append(path)
    merged = merge(paths, tmp_path / "all.mcap", [OWN, OWN])
    assert merged.unlike == {"objects/mug/mesh.ply": "attic.mcap"}
    kept = read_attachments(tmp_path / "all.mcap")
    assert sorted(one.data for one in kept) == [b"alike", b"attic", b"hall"]
    assert meshes_in(kept)["mug"] == b"attic"


def test_a_recording_that_is_given_twice_is_refused(tmp_path: Path) -> None:
    one = write_rig(tmp_path / "one.mcap")
    (tmp_path / "link.mcap").symlink_to(one)
    with pytest.raises(RecordingError, match=r"link\.mcap is given twice"):
        merge([one, tmp_path / "link.mcap"], tmp_path / "all.mcap", [OWN, OWN])


def test_labels_of_one_object_in_cameras_of_two_hosts_are_no_clash(tmp_path: Path) -> None:
    one = write_rig(tmp_path / "one.mcap")
    left = shifted(one, tmp_path / "left.mcap", FRAME_NS // 2, camera="left")
    assert merge([one, left], tmp_path / "all.mcap", [OWN, OWN]).messages == 41 + 10
    labels = [m.message() for m in read_recording(tmp_path / "all.mcap", streams=("label",))]
    cameras = [label.camera for label in labels if isinstance(label, ObjectPose)]
    assert cameras[:4] == ["front", "left", "front", "left"]


def test_a_pattern_of_nothing_and_an_output_that_is_there_are_refused(tmp_path: Path) -> None:
    one = write_rig(tmp_path / "one.mcap")
    hall = write_rig(tmp_path / "hall.mcap", site=Site(rig="hall"))
    with pytest.raises(RecordingError, match="no topic matches 'rgdb/"):
        merge([one, hall], tmp_path / "all.mcap", [OWN, OWN], ("rgdb/*",))
    with pytest.raises(RecordingError, match="exists already"):
        merge([one, hall], one, [OWN, OWN])


def test_files_of_one_name_are_refused_as_their_records_could_not_be_told_apart(
    tmp_path: Path,
) -> None:
    one = write_rig(tmp_path / "kitchen" / "rig.mcap")
    hall = write_rig(tmp_path / "hall" / "rig.mcap", site=Site(rig="hall"))
    with pytest.raises(RecordingError, match="have one name: name files after their hosts"):
        merge([one, hall], tmp_path / "all.mcap", [OWN, OWN])


def test_a_key_of_several_publishers_names_them_all() -> None:
    assert with_publisher("", "capture front") == "capture front"
    assert with_publisher("capture front", "capture front") == "capture front"
    both = with_publisher("capture front", "capture left, capture front")
    assert both == "capture front, capture left"
    sources = {
        Path("a.mcap"): {PUBLISHERS_RECORD: {"label/mug": "capture front"}},
        Path("b.mcap"): {PUBLISHERS_RECORD: {"label/mug": "capture left"}},
    }
    joined = records_of(sources, LossCounter(), None)[PUBLISHERS_RECORD]
    assert joined == {"label/mug": "capture front, capture left"}
