"""The recorder's daemon: takes what arrives, and keeps the disk's troubles from what receives."""

import time
from functools import lru_cache
from pathlib import Path

from inhand_runtime.camera_infos import InfoWatch
from inhand_runtime.daemon import Daemon, running_daemon
from inhand_runtime.inbox import Received
from inhand_runtime.recording import RecordingError
from inhand_runtime.settings import Settings
from inhand_runtime.wording import counted
from inhand_schemas.errors import KeyFormatError, MessageError
from inhand_schemas.messages import RecordingState
from inhand_schemas.procedures import PAUSE, RESUME, SNAPSHOT, SPLIT, RecorderReply
from inhand_schemas.topics import RGBD, TOPICS, topic_of
from msgspec.structs import replace

from inhand_recorder.clock import ClockWatch
from inhand_recorder.commands import CommandDesk
from inhand_recorder.event_clips import EventClips, event_clips
from inhand_recorder.gaps import GapReporter
from inhand_recorder.journal import Journal
from inhand_recorder.recording_file import Entry, Limits
from inhand_recorder.settings import RecorderSettings, check
from inhand_recorder.stamps import entry_apart, entry_of

SYNC_PERIOD_S = 0.75
"""A crash loses this much and what a sync takes itself: a second at the most."""
IDLE_S = 0.1
FIRST_RETRY_S, LAST_RETRY_S = 1.0, 30.0
QUEUE_SAMPLES = 1 << 16
MOST_KEYS = 10_000
"""Number of keys that are recorded; a file holds 65,535 channels, and a site has some dozens."""
REFUSED_KEYS_LAST_S = 5.0
FRAMES_WEIGHT = 3 * (len(TOPICS) - 1)


def run(settings: Settings[RecorderSettings]) -> None:
    """Record until SIGTERM or SIGINT.

    Raises SettingsError before anything starts, InhandError when there is no session, and
    RecordingError when the end could not be written.
    """
    chosen = settings.service
    check(settings)
    with running_daemon("recorder", settings) as daemon:
        journal = Journal(
            chosen.folder,
            settings.site.rig,
            Limits(chosen.split_bytes, chosen.split_seconds),
            daemon.health.drops,
        )
        if chosen.start_paused:
            journal.pause(time.time_ns())
        _subscribe(daemon, chosen)
        desk = CommandDesk(daemon.instance)
        desk.open(daemon)
        _Recorder(daemon, journal, desk, event_clips(daemon, settings)).run()


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


class _Recorder:
    def __init__(
        self,
        daemon: Daemon,
        journal: Journal,
        desk: CommandDesk,
        clips: EventClips | None = None,
    ) -> None:
        self._daemon = daemon
        self._journal = journal
        self._desk = desk
        self._clips = clips
        self._gaps = GapReporter(daemon.health.error)
        self._keys: set[str] = set()
        self._clock = ClockWatch()
        self._infos = InfoWatch(daemon.health)

    def run(self) -> None:
        """Write until stopped; while the disk fails, what arrives waits in the inbox."""
        health, delay = self._daemon.health, FIRST_RETRY_S
        while not self._daemon.stop.is_set():
            try:
                self._write_until_stopped()
            except RecordingError as error:
                failed_before = health.state != "running"
                delay = min(2 * delay, LAST_RETRY_S) if failed_before else FIRST_RETRY_S
                health.state = "degraded"
                health.trouble("disk", str(error))
                self._wait(delay)
        self._write_the_rest()

    def _wait(self, seconds: float) -> None:
        end = time.monotonic() + seconds
        while (rest := end - time.monotonic()) > 0.0:
            self._daemon.health.came_round()
            self._desk.serve(self._do)
            if self._daemon.stop.wait(min(rest, IDLE_S)):
                return

    def _write_until_stopped(self) -> None:
        self._journal.sync()
        self._show_state()
        self._daemon.health.state = "running"
        self._daemon.health.well("disk")
        next_sync = time.monotonic() + SYNC_PERIOD_S
        while not self._daemon.stop.is_set():
            self._desk.serve(self._do)
            sample = self._daemon.receive(IDLE_S)
            if sample is not None:
                self._write(sample)
            if self._clips is not None:
                self._clips.clips.step(time.monotonic(), all_came=sample is None)
            if time.monotonic() >= next_sync:
                if (step := self._clock.step()) is not None:
                    self._journal.note_clock_step(*step)
                self._journal.sync()
                self._gaps.report()
                self._infos.check(time.monotonic())
                self._show_state()
                next_sync = time.monotonic() + SYNC_PERIOD_S

    def _do(self, verb: str) -> RecorderReply:
        """Do what was asked for; what fails on the disk is tried again as all writing is."""
        finished: Path | None = None
        problem: str | None = None
        try:
            if verb == PAUSE.verb:
                finished = self._journal.pause(time.time_ns())
            elif verb == RESUME.verb:
                self._journal.resume(time.time_ns())
            elif verb == SPLIT.verb:
                finished = self._journal.close()
            elif verb == SNAPSHOT.verb and self._clips is None:
                problem = "it holds no seconds to make a clip of: set ring_seconds in its settings"
            elif verb == SNAPSHOT.verb and self._clips is not None:
                self._clips.clips.trigger("snapshot", time.time_ns(), time.monotonic())
        except RecordingError as error:
            problem = str(error)
            self._daemon.health.error(problem)
        return RecorderReply(
            recorder=self._daemon.instance,
            recording=self._show_state(),
            finished=None if finished is None else finished.name,
            problem=problem,
        )

    def _show_state(self) -> RecordingState:
        """Show in the health what the recorder does, and return it."""
        state = self._journal.state
        if self._clips is not None:
            clips = self._clips.clips
            state = replace(
                state,
                ring_seconds=clips.ring.seconds,
                ring_bytes=clips.ring.bytes,
                clip=clips.under_way,
            )
        self._daemon.health.recording = state
        return state

    def _write_the_rest(self) -> None:
        self._daemon.inbox.close()
        try:
            try:
                self._write_all()
            except RecordingError as error:
                self._daemon.health.error(f"{error}; trying a last time in another file")
                self._write_all()
                raise
        finally:
            self._count_what_is_left()

    def _write_all(self) -> None:
        while (sample := self._daemon.inbox.get(0)) is not None:
            self._write(sample)
        self._journal.close()
        if self._clips is not None:
            self._clips.clips.close(time.monotonic())
        self._gaps.report()

    def _write(self, sample: Received) -> None:
        try:
            topic, parsed = topic_of(sample.key)
        except KeyFormatError as error:
            self._daemon.health.malformed(sample.key, error)
            return
        if sample.key not in self._keys and len(self._keys) >= MOST_KEYS:
            self._refuse_key(sample.key)
            return
        self._keys.add(sample.key)
        try:
            entry = entry_of(sample)
        except (MessageError, KeyFormatError) as error:
            self._daemon.health.malformed(sample.key, error)
            self._keep(sample, entry_apart(sample))
            return
        counted = entry.sequence if topic.gaps_are_losses else None
        self._daemon.health.received(entry.key, counted)
        if not entry.kept:
            self._daemon.health.arrived(entry.key, entry.received_ns - entry.captured_ns)
        if counted is not None:
            self._gaps.count(entry.key, counted)
        self._infos.note(topic.stream, parsed.name, time.monotonic())
        self._keep(sample, entry)

    def _keep(self, sample: Received, entry: Entry) -> None:
        if self._clips is not None:
            self._clips.take(sample, entry)
        self._journal.write(entry)

    def _refuse_key(self, key: str) -> None:
        self._daemon.health.refused(key)
        self._daemon.health.trouble(
            "keys",
            f"more than {counted(MOST_KEYS, 'key')} are published: what comes on new ones is not "
            "recorded; some program invents names",
            lasts_s=REFUSED_KEYS_LAST_S,
        )

    def _count_what_is_left(self) -> None:
        left = self._journal.waiting
        while (sample := self._daemon.inbox.get(0)) is not None:
            left[sample.key] += 1
        for key, messages in left.items():
            for _ in range(messages):
                self._daemon.health.dropped(key)
        if left:
            self._daemon.health.error(
                f"could not be written any more: {counted(left.total(), 'message')}"
            )
