"""The recorder's daemon: what it is made of, and what it subscribes to."""

import time
from dataclasses import replace
from functools import lru_cache

from inhand_runtime.daemon import Daemon, running_daemon
from inhand_runtime.settings import Settings
from inhand_schemas.topics import EVENT, RGBD, TOPICS

from inhand_recorder.announcing import Announcer
from inhand_recorder.commands import CommandDesk
from inhand_recorder.event_clips import event_clips
from inhand_recorder.journal import Journal
from inhand_recorder.provenance import Provenance
from inhand_recorder.recording_file import FileHandling, Limits
from inhand_recorder.recording_loop import MOST_KEYS, RecorderParts, RecordingLoop
from inhand_recorder.retention import Retention
from inhand_recorder.settings import RecorderSettings, check

QUEUE_SAMPLES = 1 << 16
FRAMES_WEIGHT = 3 * (len(TOPICS) - 1)


def run(settings: Settings[RecorderSettings]) -> None:
    """Record until SIGTERM or SIGINT.

    Raises SettingsError before anything starts, InhandError when there is no session, and
    RecordingError when the end could not be written.
    """
    chosen = settings.service
    check(settings)
    with running_daemon("recorder", settings) as daemon:
        parts = _parts(daemon, settings)
        if chosen.start_paused:
            parts.journal.pause(time.time_ns())
        _subscribe(daemon, chosen)
        parts.desk.open(daemon)
        RecordingLoop(daemon, parts).run()


def _parts(daemon: Daemon, settings: Settings[RecorderSettings]) -> RecorderParts:
    chosen = settings.service
    provenance = Provenance(settings)
    announcer = Announcer(daemon.publisher(EVENT, daemon.instance).put)
    retention = Retention(chosen.folder, chosen.quotas, announcer.deleted)
    colour = None
    if chosen.colour == "h264":
        # It loads NumPy, which no other recorder needs.
        from inhand_recorder.colour_coding import ColourCoding

        colour = ColourCoding(daemon.health, time.monotonic)
    files = FileHandling(
        records=lambda: {**provenance.records(), **(colour.records() if colour else {})},
        meshes=provenance.meshes,
        make_room=retention.make_room,
        unwritten=daemon.health.unwritten_counts,
    )
    journal = Journal(
        chosen.folder,
        settings.site.rig,
        Limits(chosen.split_bytes, chosen.split_seconds),
        daemon.health.drops,
        files=files,
    )
    return RecorderParts(
        journal,
        CommandDesk(daemon.instance),
        retention,
        announcer,
        provenance,
        event_clips(daemon, settings, replace(files, records=provenance.records)),
        colour,
    )


def _subscribe(daemon: Daemon, chosen: RecorderSettings) -> None:
    """Let what is chosen arrive."""
    subscriptions = chosen.chosen.subscriptions()
    wanted = lru_cache(MOST_KEYS)(chosen.chosen.holds)
    streams = tuple(topic.stream for topic in subscriptions)
    sizes = queue_shares(streams, chosen.queue_bytes)
    for topic, names in subscriptions.items():
        size = sizes[topic.stream] // len(names)
        for name in names:
            daemon.subscribe(topic, name, samples=QUEUE_SAMPLES, size=size, wanted=wanted)


def queue_shares(streams: tuple[str, ...], queue_bytes: int) -> dict[str, int]:
    """How many bytes of each stream may wait: three quarters are for frames among all streams.

    Small messages have room of their own, so that no flood of frames pushes a pose out.
    """
    weights = {stream: FRAMES_WEIGHT if stream == RGBD.stream else 1 for stream in streams}
    total = sum(weights.values())
    return {stream: queue_bytes * weight // total for stream, weight in weights.items()}
