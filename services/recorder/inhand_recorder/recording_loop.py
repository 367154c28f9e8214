"""Writes what arrives, and keeps the disk's troubles from what receives."""

import contextlib
import time
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from inhand_runtime.camera_infos import InfoWatch
from inhand_runtime.daemon import Daemon
from inhand_runtime.inbox import Received
from inhand_runtime.recording import RecordingError
from inhand_runtime.wording import counted
from inhand_schemas.errors import KeyFormatError, MessageError
from inhand_schemas.messages import RecordingState
from inhand_schemas.procedures import PAUSE, RESUME, SNAPSHOT, SPLIT, KindsOfLoss, RecorderReply
from inhand_schemas.topics import HEALTH, POSE, topic_of
from msgspec.structs import replace

from inhand_recorder.announcing import Announcer
from inhand_recorder.clock import ClockWatch
from inhand_recorder.commands import CommandDesk
from inhand_recorder.drop_causes import DropCauses
from inhand_recorder.event_clips import EventClips
from inhand_recorder.gaps import GapReporter
from inhand_recorder.journal import Journal
from inhand_recorder.provenance import Provenance
from inhand_recorder.recording_file import Entry
from inhand_recorder.retention import Retention
from inhand_recorder.stamps import entry_apart, entry_of

if TYPE_CHECKING:
    from inhand_recorder.colour_coding import ColourCoding

HAND_OVER_PERIOD_S = 0.1
"""A crash of this process loses this much, and what came meanwhile: a quarter of a second at the
most."""
SYNC_PERIOD_S = 0.75
"""A power cut loses this much and what a sync takes itself: a second at the most."""
TIDY_PERIOD_S = 5.0
IDLE_S = 0.1
CODING_S = 0.005
"""How long what arrives is waited for while colour is coded."""
FIRST_RETRY_S, LAST_RETRY_S = 1.0, 5.0
MOST_KEYS = 10_000
"""Number of keys that are recorded; a file holds 65,535 channels, and a site has some dozens."""
REFUSED_KEYS_LAST_S = 5.0


@dataclass(frozen=True)
class RecorderParts:
    """What a recorder works with: where it writes, who asks it, what is kept, what it announces,
    where files come from, clips, where any are wanted, and what codes colour, where that is."""

    journal: Journal
    desk: CommandDesk
    retention: Retention
    announcer: Announcer
    provenance: Provenance
    clips: EventClips | None = None
    colour: "ColourCoding | None" = None


class RecordingLoop:
    """Takes what arrives one by one, and writes it; what is asked is done in between."""

    def __init__(self, daemon: Daemon, parts: RecorderParts) -> None:
        self._daemon = daemon
        self._parts = parts
        self._journal = parts.journal
        self._clips = parts.clips
        self._colour = parts.colour
        self._gaps = GapReporter(daemon.health.error)
        self._keys: set[str] = set()
        self._clock = ClockWatch()
        self._infos = InfoWatch(daemon.health)
        self._drops = DropCauses(daemon.health.drops, daemon.health.unwritten)
        self._stopped = False
        self._next_tidy = 0.0

    def run(self) -> None:
        """Write until stopped; while the disk fails, what arrives waits in the inbox.

        Raises RecordingError when the end could not be written.
        """
        delay = FIRST_RETRY_S
        while not self._daemon.stop.is_set():
            try:
                self._write_until_stopped()
            except RecordingError as error:
                delay = min(2 * delay, LAST_RETRY_S) if self._stopped else FIRST_RETRY_S
                self._stop_writing(str(error))
                self._wait(delay)
        self._write_the_rest()

    def _stop_writing(self, why: str) -> None:
        """Say that nothing is written until the disk is well."""
        health = self._daemon.health
        health.state = "degraded"
        health.trouble("disk", why)
        if not self._stopped:
            self._parts.announcer.stopped(why, self._parts.retention.free_bytes)
        self._stopped = True
        self._show_state()

    def _go_on(self) -> None:
        """Say that all is well."""
        self._daemon.health.state = "running"
        self._daemon.health.well("disk")
        if self._stopped:
            self._parts.announcer.resumed(self._parts.retention.free_bytes)
        self._stopped = False
        self._show_state()

    def _wait(self, seconds: float) -> None:
        """Wait while the disk takes nothing: what is dropped meanwhile is its fault."""
        self._drops.note(disk_failed=False)
        end = time.monotonic() + seconds
        while (rest := end - time.monotonic()) > 0.0:
            self._daemon.health.came_round()
            self._parts.desk.serve(self._do)
            stops = self._daemon.stop.wait(min(rest, IDLE_S))
            self._drops.note(disk_failed=True)
            if stops:
                return

    def _write_until_stopped(self) -> None:
        self._next_tidy = 0.0
        self._tidy()
        self._require_room()
        self._journal.sync()
        self._go_on()
        next_hand_over = time.monotonic() + HAND_OVER_PERIOD_S
        next_sync = time.monotonic() + SYNC_PERIOD_S
        while not self._daemon.stop.is_set():
            self._parts.desk.serve(self._do)
            coding = self._colour is not None and self._colour.under_way
            sample = self._daemon.receive(CODING_S if coding else IDLE_S)
            if sample is not None:
                self._write(sample)
            if self._colour is not None:
                self._write_coded(self._colour.ready())
            if self._clips is not None:
                self._clips.clips.step(time.monotonic(), all_came=sample is None)
            if time.monotonic() >= next_hand_over:
                self._journal.hand_over()
                next_hand_over = time.monotonic() + HAND_OVER_PERIOD_S
            if time.monotonic() >= next_sync:
                self._look_after()
                next_sync = time.monotonic() + SYNC_PERIOD_S

    def _look_after(self) -> None:
        """Bring all to the disk, hold the quotas, and say how things are."""
        if (step := self._clock.step()) is not None:
            self._journal.note_clock_step(*step)
        self._journal.sync()
        self._tidy()
        self._require_room()
        self._drops.note(disk_failed=False)
        self._gaps.report()
        self._infos.check(time.monotonic())
        self._show_state()

    def _tidy(self) -> None:
        """Delete what has to go, every few seconds, or at once where the disk is nearly full."""
        retention = self._parts.retention
        if time.monotonic() >= self._next_tidy or retention.short():
            retention.tidy(time.time_ns())
            self._next_tidy = time.monotonic() + TIDY_PERIOD_S
        self._journal.file_limit = retention.file_limit()
        if retention.problem is None:
            self._daemon.health.well("quota")
        else:
            self._daemon.health.trouble("quota", retention.problem)

    def _require_room(self) -> None:
        """Raise RecordingError, with all files whole, where the disk is so full that recording has
        to stop."""
        problem = self._parts.retention.too_full(stopped=self._stopped)
        if problem is not None and not self._journal.paused:
            self._journal.close()
            raise RecordingError(problem)

    def _do(self, verb: str) -> RecorderReply:
        """Do what was asked for; what fails on the disk is tried again as all writing is."""
        finished: Path | None = None
        problem: str | None = None
        try:
            if verb in (PAUSE.verb, SPLIT.verb) and self._colour is not None:
                self._write_coded(self._colour.all())
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
            losses=self._losses(),
            finished=None if finished is None else finished.name,
            problem=problem,
        )

    def _losses(self) -> dict[str, KindsOfLoss]:
        """What is missing in recordings, by key and kind."""
        health = self._daemon.health
        lost, dropped, unwritten = health.lost_counts(), health.drops(), health.unwritten_counts()
        return {
            key: KindsOfLoss(
                transport=lost.get(key, 0),
                queue=dropped.get(key, 0) - unwritten.get(key, 0),
                disk=unwritten.get(key, 0),
            )
            for key in sorted(lost.keys() | dropped.keys())
        }

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
        if self._colour is not None:
            state = replace(state, colour=dict(self._colour.counts))
        retention = self._parts.retention
        state = replace(
            state,
            folder_bytes=retention.folder_bytes,
            free_bytes=retention.free_bytes,
            deleted=retention.deleted,
            unmanaged=retention.foreign.files,
            unmanaged_bytes=retention.foreign.bytes,
            clips_bytes=retention.clips.bytes,
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
        if self._colour is not None:
            self._write_coded(self._colour.all())
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
        if topic is POSE:
            self._parts.provenance.follow(parsed.name)
        if topic is HEALTH:
            with contextlib.suppress(MessageError):  # in another's name: recorded, not believed
                self._parts.provenance.hear(HEALTH.received(sample.key, sample.payload))
        self._keep(sample, entry)

    def _keep(self, sample: Received, entry: Entry) -> None:
        if self._clips is not None:
            self._clips.take(sample, entry)
        if self._colour is None or self._journal.paused:
            self._journal.write(entry)
        else:
            self._write_coded(self._colour.take(entry))

    def _write_coded(self, entries: Iterable[Entry]) -> None:
        for entry in entries:
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
        if self._colour is not None:
            left += self._colour.waiting
        while (sample := self._daemon.inbox.get(0)) is not None:
            left[sample.key] += 1
        for key, messages in left.items():
            self._daemon.health.dropped(key, messages)
            self._daemon.health.unwritten(key, messages)
        if left:
            self._daemon.health.error(
                f"could not be written any more: {counted(left.total(), 'message')}"
            )
