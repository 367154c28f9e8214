"""A recorder on a disk that is full: a small tmpfs of its own."""

import contextlib
import subprocess
import sys
import time
from pathlib import Path

import pytest
from inhand_runtime.inbox import Received
from inhand_schemas.messages import Event
from inhand_schemas.topics import EVENT
from recordings import flaws
from running_recorder import RGBD_KEY, numbers
from running_rig import Process, RunningRig, eventually
from wire import Wire

OWN_DISK = 'mount -t tmpfs -o size=24m none "$0" && exec "$@"'
UNSHARED = ("unshare", "--map-root-user", "--mount", "sh", "-c")

pytestmark = pytest.mark.long


def start_on_small_disk(rig: RunningRig, settings: str) -> tuple[Process, Path]:
    """A recorder that is up, and where it writes, as long as it lives: 24 MiB."""
    folder = rig.folder / "disk"
    folder.mkdir()
    if subprocess.run([*UNSHARED, OWN_DISK, folder, "true"], capture_output=True).returncode:
        pytest.skip("this user may mount nothing, not even in a namespace of its own")
    rig.configure(f'[recorder.disk]\nfolder = "{folder}"\n{settings}')
    command = (sys.executable, "-m", "inhand", "recorder", "--config", rig.config)
    recorder = rig.command(*UNSHARED, OWN_DISK, folder, *command)
    recorder.said("is up")
    return recorder, Path(f"/proc/{recorder.pid}/root") / folder.relative_to("/")


def kinds(events: list[Received]) -> list[str]:
    return [event.kind for event in map(decoded, events)]


def decoded(event: Received) -> Event:
    return EVENT.decode(event.payload, event.encoding)


def make_whole(rig: RunningRig) -> None:
    assert rig.done("recorder", "pause", "--config", rig.config).popen.returncode == 0


def arrived(rig: RunningRig, last: int) -> int:
    """How many of the frames up to the ``last`` came, once all have that ever will; none may have
    found the queue full."""

    def all_came() -> int:
        topic = rig.health("disk")["topics"].get(RGBD_KEY, {"received": 0, "lost": 0})
        assert topic.get("dropped", 0) == 0
        return int(topic["received"]) if topic["received"] + topic["lost"] > last else 0

    return int(eventually("all frames", all_came))


def test_it_stops_before_the_disk_is_full_and_goes_on_by_itself_without_a_loss(
    rig: RunningRig, wire: Wire
) -> None:
    recorder, folder = start_on_small_disk(rig, 'free_bytes = "8 MiB"')
    events = wire.hear(EVENT)
    rig.publisher("--frame-bytes", "300000", "--frames", "80")
    recorder.said("(free_bytes): make room")
    eventually("the event", lambda: kinds(events) == ["recording_stopped"])
    assert rig.health("disk")["state"] == "degraded"
    (first,) = folder.iterdir()
    assert flaws(first) == []
    before = numbers([first])
    first.unlink()
    eventually("the event", lambda: kinds(events) == ["recording_stopped", "recording_resumed"])
    came = arrived(rig, last=79)
    make_whole(rig)
    after = numbers(sorted(folder.iterdir()))
    assert max(before) < min(after)
    assert len(before) + len(after) == came


def test_with_delete_oldest_it_never_stops_and_never_deletes_a_clip(
    rig: RunningRig, wire: Wire
) -> None:
    settings = (
        'free_bytes = "4 MiB"\nwhen_full = "delete-oldest"\nring_seconds = 0.3\n'
        'after_seconds = 0\nring_events = ["now"]'
    )
    _, folder = start_on_small_disk(rig, settings)
    events = wire.hear(EVENT)
    rig.publisher("--frame-bytes", "300000", "--frames", "180")
    eventually("a deletion", lambda: events)
    wire.publisher(EVENT, "now").put(Event(sequence=0, time_ns=time.time_ns(), kind="now"))
    (clip,) = eventually("a clip", lambda: list(folder.glob("clips/*.mcap")))
    with contextlib.suppress(OSError), (folder / "foreign").open("wb", buffering=0) as file:
        while file.write(bytes(1 << 16)) == 1 << 16:  # another program fills the disk at once
            pass
    (folder / "foreign").unlink()
    arrived(rig, last=179)
    make_whole(rig)
    assert list(folder.glob("*.part")) == []
    assert set(kinds(events)) == {"recording_deleted", "now"}
    assert flaws(clip) == []
    recorded = numbers(sorted(folder.glob("*.mcap")))
    assert recorded[-1] == 179
    shown = rig.done("status", "--config", rig.config).stdout
    assert "recorder disk: its quotas have deleted" in shown
