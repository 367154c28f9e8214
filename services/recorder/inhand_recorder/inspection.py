"""What is in a recording, in whatever state it is."""

from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from inhand_runtime.recording import APART_ENCODING
from inhand_runtime.recording.checksums import CHECKSUMS_RECORD
from inhand_runtime.recording.layout import PROFILE
from inhand_schemas.errors import KeyFormatError
from inhand_schemas.topics import topic_of
from mcap.records import Channel, Header, Message, Metadata

from inhand_recorder.clock import CLOCK_RECORD, parse_clock_steps
from inhand_recorder.faults import UNCHECKED, FaultLedger
from inhand_recorder.losses import LossCounter
from inhand_recorder.reception import ReceptionTimes
from inhand_recorder.scanning import Stretch, channels, is_complete, opened, scan

UNDECODABLE = " (undecodable)"
"""Stands behind the key of messages that a recording keeps apart."""


@dataclass(frozen=True)
class KeyInfo:
    """What a recording holds of one key.

    ``type`` is the message type's name, or "unknown" for keys that are not this release's.
    ``rate_hz`` is over the time from its first message to its last; ``lost`` is what the
    sequence numbers in the file say, 0 for keys whose messages are not numbered one by one.
    """

    key: str
    type: str
    messages: int
    bytes: int
    rate_hz: float
    lost: int


@dataclass(frozen=True)
class RecordingInfo:
    """What a recording holds; times are of reception, in nanoseconds since the epoch.

    ``duration_s`` is the seconds from the first message to the last, by a clock that nobody set:
    steps of the wall clock are taken out, and each is told in ``clock``. ``complete`` says that it
    was finished and nothing in it is unreadable; ``faults`` name in lines what is missing or
    unchecked. ``metadata`` holds the named records, ``losses`` (as the recorder wrote them) among
    them.
    """

    path: Path
    bytes: int
    start_ns: int
    end_ns: int
    keys: tuple[KeyInfo, ...]
    complete: bool
    unread_bytes: int
    metadata: dict[str, dict[str, str]]
    duration_s: float
    clock: tuple[str, ...]
    faults: tuple[str, ...]

    @property
    def messages(self) -> int:
        """Messages of all keys."""
        return sum(key.messages for key in self.keys)


@dataclass
class _Contents:
    keys: dict[int, str]
    faults: FaultLedger
    sizes: Counter[str] = field(default_factory=Counter)
    times: ReceptionTimes = field(default_factory=ReceptionTimes)
    counter: LossCounter = field(default_factory=LossCounter)
    metadata: dict[str, dict[str, str]] = field(default_factory=dict)
    unread_bytes: int = 0

    def take(self, stretch: Stretch) -> None:
        self.unread_bytes += stretch.unread_bytes
        self.faults.take(stretch)
        for record in (*stretch.records, *stretch.doubtful):
            if isinstance(record, Message) and record.channel_id in self.keys:
                key = self.keys[record.channel_id]
                self.sizes[key] += len(record.data)
                self.times.add(key, record.log_time)
                self.counter.count(key, record.sequence)
            elif isinstance(record, Metadata) and record.name != CHECKSUMS_RECORD:
                self.metadata[record.name] = record.metadata
            elif isinstance(record, Header):
                self.times.in_order = record.profile == PROFILE
        for record in stretch.doubtful:
            self.faults.note(record, UNCHECKED)


def inspect_recording(path: Path) -> RecordingInfo:
    """Read all of ``path``, whole, cut off or damaged; raises RecordingError when it is none."""
    with opened(path) as data:
        size, complete = len(data), is_complete(data)
        keys = {number: _shown_key(channel) for number, channel in channels(data).items()}
        contents = _Contents(keys, FaultLedger(keys))
        for stretch in scan(data):
            contents.take(stretch)
    losses = contents.counter.losses()
    spans, duration_s, clock = contents.times.without_steps(
        parse_clock_steps(contents.metadata.get(CLOCK_RECORD, {}))
    )
    return RecordingInfo(
        path=path,
        bytes=size,
        start_ns=min(contents.times.received_ns, default=0),
        end_ns=max(contents.times.received_ns, default=0),
        keys=tuple(
            KeyInfo(
                key,
                _type(key),
                span.messages,
                contents.sizes[key],
                span.rate_hz,
                losses[key].lost if _is_numbered(key) else 0,
            )
            for key, span in sorted(spans.items())
        ),
        complete=complete and contents.unread_bytes == 0,
        unread_bytes=contents.unread_bytes,
        metadata=contents.metadata,
        duration_s=duration_s,
        clock=clock,
        faults=tuple(contents.faults.lines()),
    )


def _shown_key(channel: Channel) -> str:
    apart = channel.message_encoding == APART_ENCODING
    return channel.topic + UNDECODABLE if apart else channel.topic


def _is_numbered(key: str) -> bool:
    """Whether a gap between a key's messages is a loss."""
    try:
        topic, _ = topic_of(key.removesuffix(UNDECODABLE))
    except KeyFormatError:
        return True
    return topic.gaps_are_losses


def _type(key: str) -> str:
    if key.endswith(UNDECODABLE):
        return "unreadable"
    try:
        topic, _ = topic_of(key)
    except KeyFormatError:
        return "unknown"
    return topic.message_type.__name__
