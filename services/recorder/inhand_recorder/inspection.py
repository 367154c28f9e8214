"""What is in a recording, in whatever state it is."""

from dataclasses import dataclass, field
from pathlib import Path

from inhand_runtime.recording import APART_ENCODING
from inhand_runtime.recording.checksums import CHECKSUMS_RECORD
from inhand_schemas.errors import KeyFormatError
from inhand_schemas.topics import topic_of
from mcap.records import Channel, Message, Metadata

from inhand_recorder.losses import LossCounter
from inhand_recorder.scanning import channels, is_complete, opened, scan

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

    ``complete`` says that it was finished and nothing in it is unreadable. ``metadata`` holds the
    named records, ``losses`` (as the recorder wrote them) among them.
    """

    path: Path
    bytes: int
    start_ns: int
    end_ns: int
    keys: tuple[KeyInfo, ...]
    complete: bool
    unread_bytes: int
    metadata: dict[str, dict[str, str]]

    @property
    def duration_s(self) -> float:
        """Seconds from the first message to the last."""
        return (self.end_ns - self.start_ns) / 1e9

    @property
    def messages(self) -> int:
        """Messages of all keys."""
        return sum(key.messages for key in self.keys)


@dataclass
class _Tally:
    messages: int = 0
    bytes: int = 0
    start_ns: int = 0
    end_ns: int = 0

    def add(self, message: Message) -> None:
        first = self.messages == 0
        self.messages += 1
        self.bytes += len(message.data)
        self.start_ns = message.log_time if first else min(self.start_ns, message.log_time)
        self.end_ns = max(self.end_ns, message.log_time)

    @property
    def rate_hz(self) -> float:
        seconds = (self.end_ns - self.start_ns) / 1e9
        return (self.messages - 1) / seconds if seconds > 0 else 0.0


@dataclass
class _Contents:
    tallies: dict[str, _Tally] = field(default_factory=dict)
    counter: LossCounter = field(default_factory=LossCounter)
    metadata: dict[str, dict[str, str]] = field(default_factory=dict)
    unread_bytes: int = 0


def inspect_recording(path: Path) -> RecordingInfo:
    """Read all of ``path``, whole, cut off or damaged; raises RecordingError when it is none."""
    contents = _Contents()
    with opened(path) as data:
        size, complete = len(data), is_complete(data)
        keys = {number: _shown_key(channel) for number, channel in channels(data).items()}
        for stretch in scan(data):
            contents.unread_bytes += stretch.unread_bytes
            for record in (*stretch.records, *stretch.doubtful):
                if isinstance(record, Message) and record.channel_id in keys:
                    key = keys[record.channel_id]
                    contents.tallies.setdefault(key, _Tally()).add(record)
                    contents.counter.count(key, record.sequence)
                elif isinstance(record, Metadata) and record.name != CHECKSUMS_RECORD:
                    contents.metadata[record.name] = record.metadata
    tallies, losses = contents.tallies, contents.counter.losses()
    return RecordingInfo(
        path=path,
        bytes=size,
        start_ns=min((tally.start_ns for tally in tallies.values()), default=0),
        end_ns=max((tally.end_ns for tally in tallies.values()), default=0),
        keys=tuple(
            KeyInfo(
                key,
                _type(key),
                tally.messages,
                tally.bytes,
                tally.rate_hz,
                losses[key].lost if _is_numbered(key) else 0,
            )
            for key, tally in sorted(tallies.items())
        ),
        complete=complete and contents.unread_bytes == 0,
        unread_bytes=contents.unread_bytes,
        metadata=contents.metadata,
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
