"""Recordings made of recordings: merged, cut, filtered and split."""

import shutil
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from heapq import merge
from pathlib import Path

from inhand_runtime.recording import RecordedMessage, RecordingError, RecordingWriter
from inhand_runtime.recording.copying import StandingAlone, copy_message
from inhand_runtime.recording.layout import LATEST_NS

from inhand_recorder.attachments import attach
from inhand_recorder.conversion_records import CONVERSION_RECORD, losses_by_source, records_of
from inhand_recorder.losses import LossCounter
from inhand_recorder.recording_reader import Recording, matches

CONVERTING_SUFFIX = ".converting"


@dataclass(frozen=True)
class Selection:
    """What of recordings is taken: topics by pattern, all where ``include`` is empty, without those
    that match ``exclude``, received from ``start_ns`` until before ``end_ns`` (since the epoch)."""

    include: tuple[str, ...] = ()
    exclude: tuple[str, ...] = ()
    start_ns: int = 0
    end_ns: int = LATEST_NS


@dataclass(frozen=True)
class ConvertedFile:
    """A file that was written, with its messages; kept ones that it repeats are among them."""

    path: Path
    messages: int


@dataclass(frozen=True)
class Conversion:
    """The files that were written, the numbers of damaged messages by topic, which none of them
    holds, and how many they keep apart, as these could not be read on their keys."""

    files: tuple[ConvertedFile, ...]
    damaged: Mapping[str, int]
    apart: int


def convert_recording(
    recording: Recording,
    output: Path,
    selection: Selection,
    *,
    split_seconds: float = 0.0,
    on_message: Callable[[], None] = lambda: None,
) -> Conversion:
    """Write what is selected of an open recording, which may be of many files, to a new file.

    With ``split_seconds`` it is several files, ``NAME_000.mcap`` and so on, each of as many seconds
    at the most, which get their names when all are whole. Each begins with the last message of each
    kept stream. ``on_message`` is called for each message. Raises RecordingError, also where two
    files hold different messages of one key at one time, and then leaves no file; an existing file
    is never changed.
    """
    keys = chosen_keys(recording, selection)
    _refuse_clashes(recording, keys)
    _refuse_existing(output, split_seconds)
    outputs = _Outputs(recording, output, selection, split_seconds)
    try:
        for before in _kept_before(recording, keys, selection.start_ns):
            outputs.remember(before)
        recording.damaged.clear()
        times = {"start_ns": selection.start_ns, "end_ns": selection.end_ns}
        apart = recording.messages_apart(_chosen_apart(recording, selection), **times)
        read = recording.messages(keys, **times)
        for message in merge(read, apart, key=lambda one: one.received_ns):
            outputs.write(message)
            if not message.apart:
                on_message()
        if not outputs.files:
            raise RecordingError("no message is left: choose a longer time, or other topics")
        outputs.publish()
    except BaseException:
        outputs.discard()
        raise
    return Conversion(tuple(outputs.files), dict(recording.damaged), outputs.apart)


def chosen_keys(recording: Recording, selection: Selection) -> list[str]:
    """Return the whole keys that are selected; raises RecordingError for a pattern of no topic."""
    excluded = set(recording.matching(selection.exclude))
    included = recording.matching(selection.include) if selection.include else recording.keys
    keys = [key for key in included if key not in excluded]
    if not keys:
        raise RecordingError("no topic is left: include more, or exclude less")
    return keys


def _chosen_apart(recording: Recording, selection: Selection) -> list[str]:
    """Return the keys that are selected of what is kept apart."""
    return [
        key
        for key in recording.apart
        if not any(matches(key, pattern) for pattern in selection.exclude)
        and (not selection.include or any(matches(key, one) for one in selection.include))
    ]


class _Outputs:
    """Writes messages to one file, or to one after another."""

    def __init__(
        self, recording: Recording, output: Path, selection: Selection, split_seconds: float
    ) -> None:
        self.files: list[ConvertedFile] = []
        self.apart = 0
        self._sources, self._attachments = recording.metadata(), recording.attachments()
        self._output, self._selection = output, selection
        self._split_folder = output.with_name(output.name + CONVERTING_SUFFIX)
        self._split_ns = round(1e9 * split_seconds)
        self._whole = not split_seconds and selection == Selection()
        self._kept: dict[str, RecordedMessage] = {}
        self._writer: RecordingWriter | None = None
        self._written: list[Path] = []
        self._start_ns = self._end_ns = 0
        self._begin()

    def remember(self, message: RecordedMessage) -> None:
        """Repeat a message of a kept stream at the beginning of each file."""
        self._kept[message.key] = message

    def write(self, message: RecordedMessage) -> None:
        """Write a message, where need be to a further file."""
        if self._writer is not None and self._is_over(message.received_ns):
            self.finish()
        writer = self._writer or self._open(message)
        if message.apart:
            copy_message(writer, message)
            self.apart += 1
            self._end_ns = max(self._end_ns, message.received_ns)
            return
        if message.topic.delivery.kept:
            self.remember(message)
        copy_message(writer, self._standing.standing(message))
        self._count(message, message.received_ns)

    def discard(self) -> None:
        """Remove all that was written."""
        if self._writer is not None:
            self._writer.abandon()
            unfinished = self._writer.path
            unfinished.with_name(unfinished.name + CONVERTING_SUFFIX).unlink(missing_ok=True)
        for path in self._written:
            path.unlink(missing_ok=True)
        if self._split_ns and self._split_folder.exists():
            shutil.rmtree(self._split_folder)

    def publish(self) -> None:
        """Finish the file under way, and give those of a split their names; raises
        RecordingError."""
        self.finish()
        if not self._split_ns:
            return
        try:
            for number, path in enumerate(self._written):
                self._written[number] = path.rename(self._output.with_name(path.name))
            self._split_folder.rmdir()
        except OSError as error:
            raise RecordingError(f"cannot name {self._output}: {error.strerror}") from error
        self.files = [
            ConvertedFile(path, one.messages)
            for path, one in zip(self._written, self.files, strict=True)
        ]

    def _begin(self) -> None:
        self._counter, self._messages = LossCounter(), 0
        self._standing = StandingAlone()

    def _is_over(self, received_ns: int) -> bool:
        return 0 < self._split_ns <= received_ns - self._start_ns

    def _open(self, first: RecordedMessage) -> RecordingWriter:
        path = self._next_path()
        path.with_name(path.name + CONVERTING_SUFFIX).unlink(missing_ok=True)
        self._begin()
        self._writer = RecordingWriter(path, part_suffix=CONVERTING_SUFFIX)
        self.files.append(ConvertedFile(path, 0))
        self._start_ns = self._end_ns = first.received_ns
        for key, kept in self._kept.items():
            if key != first.key:
                self._writer.write(
                    key,
                    kept.payload,
                    received_ns=first.received_ns,
                    captured_ns=kept.captured_ns,
                    sequence=kept.sequence,
                )
                self._count(kept, first.received_ns)
        return self._writer

    def _next_path(self) -> Path:
        """Return where the next file goes; raises RecordingError where no folder can be made."""
        if not self._split_ns:
            return self._output
        if not self.files:
            if self._split_folder.is_dir():
                shutil.rmtree(self._split_folder)
            try:
                self._split_folder.mkdir()
            except OSError as error:
                raise RecordingError(
                    f"cannot make {self._split_folder}: {error.strerror}"
                ) from error
        return self._split_folder / _numbered(self._output, len(self.files)).name

    def _count(self, message: RecordedMessage, received_ns: int) -> None:
        self._counter.count(message.key, message.sequence)
        self._messages += 1
        self._end_ns = max(self._end_ns, received_ns)

    def finish(self) -> None:
        """Finish the file under way."""
        if self._writer is None:
            return
        attach(self._writer, self._attachments)
        span = None if self._whole else (self._start_ns, self._end_ns)
        records = records_of(self._sources, self._counter, span) | {
            CONVERSION_RECORD: self._about()
        }
        for name, values in records.items():
            self._writer.add_metadata(name, values)
        path = self._writer.close()
        self._written.append(path)
        self.files[-1] = ConvertedFile(path, self._messages)
        self._writer = None

    def _about(self) -> dict[str, str]:
        """Return what the file was made of, with the losses that its sources say of themselves."""
        chosen = self._selection
        values = {"sources": "\n".join(path.name for path in self._sources)}
        for name, patterns in (("include", chosen.include), ("exclude", chosen.exclude)):
            if patterns:
                values[name] = "\n".join(patterns)
        if chosen.start_ns:
            values["start_ns"] = str(chosen.start_ns)
        if chosen.end_ns != LATEST_NS:
            values["end_ns"] = str(chosen.end_ns)
        return values | losses_by_source(self._sources)


def _kept_before(
    recording: Recording, keys: Collection[str], start_ns: int
) -> list[RecordedMessage]:
    """Return the last message of each kept stream that was received before a time."""
    kept = [key for key in keys if recording.keys[key].delivery.kept]
    before: dict[str, RecordedMessage] = {}
    for message in recording.messages(kept, end_ns=start_ns) if start_ns else ():
        before[message.key] = message
    return list(before.values())


def _refuse_clashes(recording: Recording, keys: Collection[str]) -> None:
    """Raise RecordingError where files hold one key at one time, and not the same messages."""
    if not recording.overlapping:
        return
    for key in keys:
        latest = -1
        seen: list[int] = []
        for file, sequence in recording.numbers(key):
            returned = file in seen[:-1]
            if seen and seen[-1] != file:
                if returned and sequence <= latest:
                    one, other = (recording.paths[n].name for n in sorted((file, seen[-1])))
                    raise RecordingError(
                        f"{one} and {other} hold different messages of {key} at one time: give "
                        "recordings of one rig each, or leave the topic out with --exclude"
                    )
                seen = [n for n in seen if n != file]
            if not seen or seen[-1] != file:
                seen.append(file)
            latest = sequence


def _refuse_existing(output: Path, split_seconds: float) -> None:
    there = (
        sorted(output.parent.glob(f"{output.stem}_[0-9][0-9][0-9]*{output.suffix}"))
        if split_seconds
        else [output]
    )
    for path in there:
        if path.exists():
            raise RecordingError(f"{path} exists already: choose another name, or move it away")


def _numbered(output: Path, number: int) -> Path:
    return output.with_name(f"{output.stem}_{number:03}{output.suffix}")
