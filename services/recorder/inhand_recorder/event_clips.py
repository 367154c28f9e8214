"""Begins clips when events come."""

from dataclasses import dataclass
from fnmatch import fnmatchcase

from inhand_runtime.daemon import Daemon
from inhand_runtime.inbox import Received
from inhand_runtime.settings import Settings
from inhand_schemas.topics import EVENT, topic_of

from inhand_recorder.clips import CLIPS_FOLDER, Clips, ClipsFolder
from inhand_recorder.recording_file import Entry, FileHandling
from inhand_recorder.ring import RingBounds
from inhand_recorder.settings import RecorderSettings


@dataclass(frozen=True)
class EventClips:
    """Clips, and the patterns of the events that make one; never this recorder's own."""

    clips: Clips
    patterns: tuple[str, ...]
    recorder: str

    def take(self, sample: Received, entry: Entry) -> None:
        """Hold what came, and begin a clip where it is such an event."""
        self.clips.take(sample.arrived, entry)
        if self.patterns and not entry.apart and (event := self._event(sample)) is not None:
            self.clips.trigger(event, sample.received_ns, sample.arrived)

    def _event(self, sample: Received) -> str | None:
        topic, parsed = topic_of(sample.key)
        if topic is not EVENT or parsed.name == self.recorder:
            return None
        kind = EVENT.decode(sample.payload).kind
        names = (parsed.name, kind)
        if not any(fnmatchcase(name, one) for name in names for one in self.patterns):
            return None
        return f"event {kind}" if kind == parsed.name else f"event {kind} of {parsed.name}"


def event_clips(
    daemon: Daemon, settings: Settings[RecorderSettings], files: FileHandling
) -> EventClips | None:
    """What makes clips; None where no ring is wanted."""
    chosen = settings.service
    if not chosen.ring_seconds:
        return None

    def report(problem: str | None) -> None:
        if problem is None:
            daemon.health.well("clip")
        else:
            daemon.health.trouble("clip", problem)

    path = chosen.folder / CLIPS_FOLDER
    folder = ClipsFolder(path, settings.site.rig, chosen.after_seconds, files)
    clips = Clips(folder, RingBounds(chosen.ring_seconds, chosen.ring_bytes), report)
    return EventClips(clips, chosen.ring_events, daemon.instance)
