"""Whose fault a loss is."""

import threading
from pathlib import Path

from inhand_recorder.announcing import Announcer
from inhand_recorder.commands import CommandDesk
from inhand_recorder.drop_causes import DropCauses
from inhand_recorder.journal import Journal
from inhand_recorder.losses import LOSSES_RECORD, Losses, format_losses, parse_losses
from inhand_recorder.provenance import Provenance
from inhand_recorder.quotas import Quotas
from inhand_recorder.recording_file import FileHandling, Limits
from inhand_recorder.recording_loop import RecorderParts, RecordingLoop
from inhand_recorder.retention import Retention
from inhand_recorder.settings import RecorderSettings
from inhand_runtime.inbox import Received
from inhand_runtime.recording import read_metadata, read_recording
from inhand_runtime.settings import load_settings
from inhand_schemas.messages import Event
from inhand_schemas.topics import RGBD
from recordings import RGBD_KEY, START_NS, frame_messages
from running_rig import eventually
from unread_daemon import UnreadDaemon


def test_what_is_dropped_while_the_disk_fails_is_its_fault_and_nothing_else_is() -> None:
    drops = {"a": 3}
    blamed: dict[str, int] = {}
    causes = DropCauses(lambda: drops, lambda key, count: blamed.update({key: count}))
    causes.note(disk_failed=False)
    drops.update(a=5, b=2)
    causes.note(disk_failed=True)
    drops.update(a=9)
    causes.note(disk_failed=False)
    assert blamed == {"a": 2, "b": 2}


def test_each_message_is_recorded_or_counted_by_whose_fault_it_is(tmp_path: Path) -> None:
    folder = tmp_path / "disk"
    folder.write_text("in the way")
    daemon, events = UnreadDaemon(), list[Event]()
    lane = daemon.inbox.lane(samples=10, on_drop=daemon.health.overflowed)
    provenance, announcer = (
        Provenance(load_settings(None, "recorder", RecorderSettings)),
        Announcer(events.append),
    )
    files = FileHandling(provenance.records, unwritten=daemon.health.unwritten_counts)
    journal = Journal(folder, "rig", Limits(), daemon.health.drops, files=files)
    retention = Retention(folder, Quotas(), announcer.deleted)
    parts = RecorderParts(journal, CommandDesk("disk"), retention, announcer, provenance)
    loop = RecordingLoop(daemon, parts)  # type: ignore[arg-type]

    def put(numbers: range) -> None:
        for number in numbers:
            payload = frame_messages(number, 100)[0][2]
            lane.put(Received(RGBD_KEY, payload, RGBD.encoding, START_NS + number))

    put(range(15))  # nobody reads yet: five come too fast
    thread = threading.Thread(target=loop.run)
    thread.start()
    eventually("a stop", lambda: daemon.health.state == "degraded")
    put(range(15, 40))
    eventually("the disk's fault", lambda: daemon.health.unwritten_counts())
    folder.unlink()
    eventually("recording", lambda: daemon.health.state == "running")
    daemon.stop.set()
    thread.join()
    (path,) = folder.iterdir()
    recorded = len(list(read_recording(path)))
    written = parse_losses(read_metadata(path)[LOSSES_RECORD])[RGBD_KEY]
    assert written.dropped - written.unwritten == 5
    assert written.unwritten > 0
    assert recorded + written.dropped == 40
    topic = daemon.health.report().topics[RGBD_KEY]
    assert (topic.dropped, topic.unwritten) == (written.dropped, written.unwritten)
    assert [event.kind for event in events] == ["recording_stopped", "recording_resumed"]


def test_the_disk_s_fault_is_read_back_and_files_of_before_have_none() -> None:
    losses = {"a": Losses(9, 3, 0, 2, 1), "b": Losses(1, 0, 0, 0)}
    assert parse_losses(format_losses(losses)) == losses
    assert format_losses(losses)["b"] == "received=1 lost=0 restarts=0 dropped=0"
