"""What a file says of where it comes from."""

import json
import shutil
import time
from io import BytesIO
from pathlib import Path

import inhand_recorder
import numpy as np
import trimesh
from inhand_recorder.attachments import attach_mesh, meshes_in
from inhand_recorder.journal import Journal
from inhand_recorder.provenance import (
    OBJECTS_RECORD,
    PUBLISHERS_RECORD,
    RECORDER_RECORD,
    Provenance,
)
from inhand_recorder.recording_file import Entry, FileHandling, Limits
from inhand_recorder.recovery import recover_recording
from inhand_recorder.settings import RecorderSettings
from inhand_recorder.verification import verify_recording
from inhand_runtime.recording import RecordingWriter, read_metadata
from inhand_runtime.settings import load_settings
from inhand_schemas.messages import Health, TopicHealth
from mcap.reader import make_reader
from recordings import POSE_KEY, RGBD_KEY, frame_messages

GOLDEN_MODEL = Path(__file__).parents[1] / "tracker" / "golden" / "drinkFromMug.model"


def health(service: str, instance: str, **published: int) -> Health:
    topics = {key: TopicHealth(published=count) for key, count in published.items()}
    return Health(
        sequence=0,
        time_ns=time.time_ns(),
        service=service,
        instance=instance,
        state="running",
        uptime_s=1.0,
        resident_bytes=1,
        topics=topics,
    )


def test_each_file_says_by_what_it_was_made_and_who_published_what(tmp_path: Path) -> None:
    config = tmp_path / "rig.toml"
    config.write_text('rig = "attic"\n[recorder.disk]\nfolder = "private"\nkeep_days = 3\n')
    provenance = Provenance(load_settings(config, "recorder", RecorderSettings))
    files = FileHandling(provenance.records)
    journal = Journal(tmp_path / "disk", "attic", Limits(), dict, files=files)
    key, message, payload = frame_messages(0, 1)[2]
    journal.write(Entry(key, payload, message.time_ns, message.time_ns, 0))
    provenance.hear(health("tracker", "mug", **{POSE_KEY: 5, RGBD_KEY: 0}))
    provenance.hear(health("capture", "kitchen", **{RGBD_KEY: 5}))
    path = journal.close()
    assert path is not None
    records = read_metadata(path)
    about = records[RECORDER_RECORD]
    assert about["software"].startswith("inhand ")
    assert (about["realm"], about["rig"], about["recorder"]) == ("inhand", "attic", "disk")
    assert json.loads(about["settings"])["keep_days"] == 3
    assert "private" not in about["settings"]
    assert records[PUBLISHERS_RECORD] == {POSE_KEY: "tracker mug", RGBD_KEY: "capture kitchen"}


def attachments(path: Path) -> dict[str, bytes]:
    with path.open("rb") as file:
        return {one.name: one.data for one in make_reader(file).iter_attachments()}


def test_meshes_of_this_host_s_models_are_attached_and_others_are_said_not_to_be_there(
    tmp_path: Path,
) -> None:
    config = tmp_path / "rig.toml"
    config.write_text(
        '[recorder.disk]\n[tracker.a]\nmodels = ["mug.model", "absent.model", "broken.model"]\n'
    )
    shutil.copyfile(GOLDEN_MODEL, tmp_path / "mug.model")
    (tmp_path / "broken.model").write_bytes(b"PK nothing")
    provenance = Provenance(load_settings(config, "recorder", RecorderSettings))
    files = FileHandling(provenance.records, meshes=provenance.meshes)
    journal = Journal(tmp_path / "disk", "rig", Limits(), dict, files=files)
    key, message, payload = frame_messages(0, 1)[2]
    provenance.follow("broom")
    journal.write(Entry(key, payload, message.time_ns, message.time_ns, 0))
    path = journal.close()
    assert path is not None
    assert verify_recording(path) == []
    (ply,) = attachments(path).values()
    mesh = trimesh.load_mesh(BytesIO(ply), file_type="ply", process=False)
    with np.load(GOLDEN_MODEL) as model:
        np.testing.assert_array_equal(mesh.vertices, model["shape.vertices"])
        np.testing.assert_array_equal(mesh.faces, model["shape.faces"])
    assert read_metadata(path)[OBJECTS_RECORD] == {
        "broom": "no model of it on the recorder's host",
        "mug": "its model is mug.model",
    }
    saved = tmp_path / "saved.mcap"
    recover_recording(path, saved)
    assert attachments(saved) == {"objects/mug/mesh.ply": ply}


def test_a_damaged_attachment_is_told_and_not_saved(tmp_path: Path) -> None:
    path = tmp_path / "damaged.mcap"
    with RecordingWriter(path) as writer:
        writer.add_attachment("objects/mug/mesh.ply", "model/ply", b"a" * 500, received_ns=1)
        key, message, payload = frame_messages(0, 1)[2]
        writer.write(
            key, payload, received_ns=message.time_ns, captured_ns=message.time_ns, sequence=0
        )
    path.write_bytes(path.read_bytes().replace(b"a" * 500, b"a" * 250 + b"b" + b"a" * 249))
    problems = "".join(verify_recording(path))
    assert "attachment objects/mug/mesh.ply is damaged" in problems
    saved = tmp_path / "saved.mcap"
    recover_recording(path, saved)
    assert attachments(saved) == {}


def test_the_meshes_of_a_file_that_was_cut_off_or_grows_are_read(tmp_path: Path) -> None:
    whole, part = tmp_path / "whole.mcap", tmp_path / "cut.mcap.part"
    with RecordingWriter(whole) as writer:
        writer.add_metadata("session", {"participant": "p01"})
        for name in ("mug", "broom"):
            attach_mesh(writer, name, name.encode() * 100, 1)
        key, message, payload = frame_messages(0, 1)[2]
        stamp = {"received_ns": message.time_ns, "captured_ns": message.time_ns, "sequence": 0}
        writer.write(key, payload, **stamp)
    data = bytearray(whole.read_bytes())
    data[data.index(b"broombroom")] ^= 1
    part.write_bytes(data[: data.index(payload) + len(payload)])
    with inhand_recorder.open(part) as recording:
        assert meshes_in(recording.attachments()) == {"mug": b"mug" * 100}
