"""A sender that invents ever new keys fills no file's channels, and is told."""

from pathlib import Path

import pytest
from inhand_recorder import recording_loop
from inhand_recorder.announcing import Announcer
from inhand_recorder.commands import CommandDesk
from inhand_recorder.journal import Journal
from inhand_recorder.provenance import Provenance
from inhand_recorder.quotas import Quotas
from inhand_recorder.recording_file import Limits
from inhand_recorder.recording_loop import RecorderParts, RecordingLoop
from inhand_recorder.retention import Retention
from inhand_recorder.settings import RecorderSettings
from inhand_runtime.inbox import Received
from inhand_runtime.recording import read_recording
from inhand_runtime.settings import load_settings
from inhand_schemas.keys import Site
from inhand_schemas.topics import POSE
from recordings import START_NS, frame_messages
from unread_daemon import EndingDaemon


def test_keys_beyond_the_bound_are_counted_and_the_others_recorded(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(recording_loop, "MOST_KEYS", 5)
    daemon = EndingDaemon()
    lane = daemon.inbox.lane(samples=100, on_drop=daemon.health.dropped)
    payload = frame_messages(0, 1)[2][2]
    for number in range(8):
        key = POSE.key(Site(), f"thing_{number}")
        lane.put(Received(key, payload, POSE.encoding, START_NS + number))
    journal = Journal(tmp_path, "rig", Limits(), daemon.health.drops)
    announcer = Announcer(lambda event: None)
    parts = RecorderParts(
        journal,
        CommandDesk("disk"),
        Retention(tmp_path, Quotas(), announcer.deleted),
        announcer,
        Provenance(load_settings(None, "recorder", RecorderSettings)),
    )
    RecordingLoop(daemon, parts).run()  # type: ignore[arg-type]
    (path,) = tmp_path.glob("*.mcap")
    assert len(list(read_recording(path))) == 5
    report = daemon.health.report()
    assert sum(topic.refused for topic in report.topics.values()) == 3
    assert sum(topic.dropped for topic in report.topics.values()) == 0
    assert any("more than 5 keys are published" in trouble for trouble in report.troubles)
