"""What a file says of where it comes from."""

import json
import time
from pathlib import Path

from inhand_recorder.journal import Journal
from inhand_recorder.provenance import PUBLISHERS_RECORD, RECORDER_RECORD, Provenance
from inhand_recorder.recording_file import Entry, FileHandling, Limits
from inhand_recorder.settings import RecorderSettings
from inhand_runtime.recording import read_metadata
from inhand_runtime.settings import load_settings
from inhand_schemas.messages import Health, TopicHealth
from recordings import POSE_KEY, RGBD_KEY, frame_messages


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
