"""Recordings of several hosts made one: in the order of one clock, with all that each holds.

Messages stay as they are, byte for byte, with the times that their cameras gave them. The times of
reception become those of the first host's clock, so that the file's order is the true one.
"""

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from heapq import merge
from pathlib import Path

import numpy as np
from inhand_runtime.recording import RecordedMessage, RecordingError, RecordingWriter
from inhand_runtime.recording.copying import StandingAlone, copy_message
from inhand_schemas.messages import ObjectPose
from inhand_schemas.topics import LABEL
from mcap.records import Attachment

from inhand_recorder.attachments import attach
from inhand_recorder.conversion_records import losses_by_source, records_of
from inhand_recorder.losses import LossCounter
from inhand_recorder.recorded_content import content_digest
from inhand_recorder.recording_reader import Recording, matches

MERGE_RECORD = "merge"
"""The name of the metadata record in which a merged file says what it was made of, and by which
clocks."""


@dataclass(frozen=True)
class HostClock:
    """A host's clock against the first host's, as it is estimated.

    The first host's time is this one's plus ``offset_ns`` plus ``drift`` times what has passed
    since ``at_ns`` of the first host's. ``deviation_ns`` is a standard one, None where nobody
    knows; ``evidence`` says what it was estimated from.
    """

    offset_ns: int
    evidence: str
    deviation_ns: int | None = None
    drift: float = 0.0
    at_ns: int = 0

    def of_first(self, time_ns: int) -> int:
        """Return the first host's time at a time of this one, nanoseconds."""
        time_ns += self.offset_ns
        return time_ns + round(self.drift * (time_ns - self.at_ns)) if self.drift else time_ns


@dataclass(frozen=True)
class Host:
    """What one host recorded, which may be several files, and what is taken of it: ``keys``, and of
    what could not be read on its key when it was recorded that of keys ``apart``."""

    recording: Recording
    keys: tuple[str, ...]
    apart: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """The name of its first file."""
        return self.recording.paths[0].name


def hosts_of(recordings: Sequence[Recording], exclude: Sequence[str] = ()) -> list[Host]:
    """Return what is taken of each recording: all but the topics that match a pattern.

    Raises RecordingError for a pattern that matches no topic of any, where nothing is left, for a
    file that is given twice, and for two files of one name, of which the records could not say
    which is which.
    """
    paths = [path for one in recordings for path in one.paths]
    for number, path in enumerate(paths):
        for former in paths[:number]:
            if former.samefile(path):
                raise RecordingError(f"{path} is given twice: give each host's recording once")
            if former.name == path.name:
                raise RecordingError(
                    f"{former} and {path} have one name: name files after their hosts"
                )
    for pattern in exclude:
        if not any(matches(key, pattern) for one in recordings for key in one.keys):
            raise RecordingError(f"no topic matches {pattern!r}: leave it out, or correct it")

    def taken(keys: Iterable[str]) -> tuple[str, ...]:
        return tuple(k for k in keys if not any(matches(k, pattern) for pattern in exclude))

    hosts = [Host(one, taken(one.keys), taken(one.apart)) for one in recordings]
    for host in hosts:
        if not host.keys:
            raise RecordingError(f"no topic of {host.name} is left: exclude less, or leave it out")
    return hosts


Stamp = tuple[int, int]
"""A message's number and its time of capture, which two copies of it have in common."""


def shared_receptions(first: Host, other: Host) -> dict[str, dict[Stamp, tuple[int, int]]]:
    """Return, by key, when both hosts received the messages that both recorded.

    Raises RecordingError where they hold different messages of one key: labels may be, of different
    cameras.
    """
    shared = {}
    for key in sorted(set(first.keys) & set(other.keys)):
        own, others = _receptions(first.recording, key), _receptions(other.recording, key)
        both = own.keys() & others.keys()
        same = {stamp for stamp in both if own[stamp].content == others[stamp].content}
        if same:
            shared[key] = {
                stamp: (own[stamp].received_ns, others[stamp].received_ns) for stamp in same
            }
        differ = own and others if not same else both - same
        if differ and not _of_other_cameras(first, other, key):
            topic = "/".join(key.split("/")[-2:])
            raise RecordingError(
                f"{first.name} and {other.name} hold different messages of {key}: leave it out "
                f"with --exclude '{topic}', or record each host under a rig of its own name"
            )
    return shared


@dataclass(frozen=True)
class _Reception:
    """When a message was received, and a digest of what it says."""

    received_ns: int
    content: bytes


def _receptions(recording: Recording, key: str) -> dict[Stamp, _Reception]:
    return {
        (one.sequence, one.captured_ns): _Reception(one.received_ns, content_digest(one))
        for one in recording.messages([key])
    }


def _of_other_cameras(first: Host, other: Host, key: str) -> bool:
    """Whether both hold labels of one object, as cameras saw it that only one of them has."""
    if first.recording.keys[key] is not LABEL:
        return False
    cameras, others = (
        {
            label.camera
            for one in host.recording.messages([key])
            if isinstance(label := one.message(), ObjectPose)
        }
        for host in (first, other)
    )
    return not cameras & others


def clock_of_shared(
    shared: Mapping[str, Mapping[Stamp, tuple[int, int]]], of: str
) -> HostClock | None:
    """Return a host's clock by the messages that two hosts received; None where there are none.

    It is the median difference, for a message may be later at either; ``of`` names the other host.
    """
    differences = np.array([a - b for one in shared.values() for a, b in one.values()], np.int64)
    if not len(differences):
        return None
    offset = int(np.median(differences))
    deviation = int(1.4826 * np.median(np.abs(differences - offset)))
    evidence = f"{len(differences)} messages that {of} received too ({', '.join(sorted(shared))})"
    return HostClock(offset, evidence, deviation)


@dataclass(frozen=True)
class Merged:
    """A merged file: its messages, those of each source, those that were left out because another
    source has them too, and the damaged ones by topic.

    ``unlike`` has the names of what sources attached differently, as meshes of one object's name,
    and the source whose own a reader takes.
    """

    path: Path
    messages: int
    by_source: Mapping[str, int]
    repeated: int
    damaged: Mapping[str, int]
    unlike: Mapping[str, str]


def merge_recordings(
    hosts: Sequence[Host],
    clocks: Sequence[HostClock],
    output: Path,
    on_message: Callable[[], None] = lambda: None,
) -> Merged:
    """Write all that several hosts recorded to a new file, in the order of the first one's clock.

    ``clocks`` has one for each host. What two hosts recorded alike is there once. Raises
    RecordingError, also where hosts hold different messages of one key, and then leaves no file.
    """
    if output.exists():
        raise RecordingError(f"{output} exists already: choose another name, or move it away")
    repeats = _repeats(hosts)
    writer = RecordingWriter(output, part_suffix=MERGING_SUFFIX)
    try:
        counter, standing = LossCounter(), StandingAlone()
        written = dict.fromkeys((host.name for host in hosts), 0)
        repeated = 0
        streams = (_timed(*one) for one in zip(range(len(hosts)), hosts, clocks, strict=True))
        for number, message in merge(*streams, key=lambda one: one[1].received_ns):
            stamp = (message.sequence, message.captured_ns)
            if not message.apart and stamp in repeats[number].get(message.key, ()):
                repeated += 1
                continue
            if message.apart:
                copy_message(writer, message)
            else:
                copy_message(writer, standing.standing(message))
                counter.count(message.key, message.sequence)
            written[hosts[number].name] += 1
            on_message()
        unlike = _write_about(writer, hosts, clocks, counter)
        path = writer.close()
    except BaseException:
        writer.abandon()
        output.with_name(output.name + MERGING_SUFFIX).unlink(missing_ok=True)
        raise
    damaged = Counter[str]()
    for host in hosts:
        damaged.update(host.recording.damaged)
    return Merged(path, sum(written.values()), written, repeated, damaged, unlike)


MERGING_SUFFIX = ".merging"


def _repeats(hosts: Sequence[Host]) -> list[dict[str, set[Stamp]]]:
    """What each host's recording repeats of those before it, by key."""
    repeats: list[dict[str, set[Stamp]]] = [{} for _ in hosts]
    for number, other in enumerate(hosts):
        for first in hosts[:number]:
            for key, stamps in shared_receptions(first, other).items():
                repeats[number].setdefault(key, set()).update(stamps)
    return repeats


def _timed(number: int, host: Host, clock: HostClock) -> Iterator[tuple[int, RecordedMessage]]:
    """A host's messages with the times of reception of the first one's clock."""
    recording = host.recording
    recording.damaged.clear()
    apart = recording.messages_apart(host.apart)
    read = merge(recording.messages(host.keys), apart, key=lambda one: one.received_ns)
    for message in read:
        yield number, replace(message, received_ns=clock.of_first(message.received_ns))


def _write_about(
    writer: RecordingWriter,
    hosts: Sequence[Host],
    clocks: Sequence[HostClock],
    counter: LossCounter,
) -> dict[str, str]:
    """Write what is attached, and the records; returns ``Merged.unlike``."""
    attached: dict[tuple[str, bytes], Attachment] = {}
    unlike: dict[str, str] = {}
    for host in hosts:
        for one in host.recording.attachments():
            if (one.name, one.data) in attached:
                continue
            if any(name == one.name for name, _ in attached):
                unlike[one.name] = host.name
            attached[one.name, one.data] = one
    attach(writer, list(attached.values()))
    sources = {path: of for host in hosts for path, of in host.recording.metadata().items()}
    about = {"sources": "\n".join(path.name for path in sources)}
    for host, clock in zip(hosts, clocks, strict=True):
        about[f"clock of {host.name}"] = clock_in_words(clock)
    records = records_of(sources, counter, None)
    for name, values in (records | {MERGE_RECORD: about | losses_by_source(sources)}).items():
        writer.add_metadata(name, values)
    return unlike


def clock_in_words(clock: HostClock) -> str:
    """Return what is to be added to a host's times, and what says so."""
    unsure = "" if clock.deviation_ns is None else f" deviation_ns={clock.deviation_ns}"
    drift = f" drift_ppm={1e6 * clock.drift:.2f} at_ns={clock.at_ns}" if clock.drift else ""
    return f"offset_ns={clock.offset_ns}{unsure}{drift}: {clock.evidence}"
