"""A recording as it is without faces, or without people."""

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path

import msgspec
from inhand_capture.estimation.weights import DEFAULT_NETWORK
from inhand_capture.faces.finder import FaceFinder
from inhand_capture.faces.parameters import DEFAULT_FACES
from inhand_recorder.attachments import meshes_in
from inhand_recorder.conversion import Conversion, Selection, convert_recording
from inhand_recorder.recording_files import find_files
from inhand_recorder.recording_reader import Recording
from inhand_recorder.redaction import REDACTION_RECORD
from inhand_runtime.recording import RecordedMessage, RecordingError
from inhand_runtime.recording.copying import as_jpeg
from inhand_runtime.recording.layout import LATEST_NS
from inhand_schemas.errors import MessageError
from inhand_schemas.keys import parse_key
from inhand_schemas.messages import RgbdFrame
from inhand_schemas.topics import EVENT, HEALTH, INFO, LABEL, POSE, PREVIEW, RGBD, SKELETONS
from mcap.records import Attachment

from inhand.redaction.hiding import (
    CameraHiding,
    What,
    camera_hiding,
    hide_in_frame,
    hide_in_preview,
)
from inhand.redaction.looking import look_through
from inhand.redaction.parameters import DEFAULT_REDACTION
from inhand.resumed_work import SectionResults, digest_of_recording

REDACTING_SUFFIX = ".redacting"

WITHOUT_PICTURES = (INFO, SKELETONS, POSE, LABEL, EVENT, HEALTH)
"""What is passed on as it is. A stream that stands neither here nor among those that are redacted
is left out, as nobody said yet what it shows."""


@dataclass(frozen=True)
class Redaction:
    """What was written, by name what became of frames and previews, and how many messages were left
    out, as nobody can read on their keys what they show."""

    written: Conversion
    counts: Mapping[str, int]
    apart: int


def redact_recording(
    paths: Iterable[Path],
    output: Path,
    what: What,
    new_finder: Callable[[], FaceFinder],
    on_step: Callable[[str, int], None] = lambda _step, _total: None,
    section_frames: int = DEFAULT_REDACTION.section_frames,
) -> Redaction:
    """Write files or folders, as one recording, without faces or people to the new file ``output``.

    ``new_finder`` makes what finds people in a camera's pictures, by skeletons too, and is called
    for each section of them. ``on_step`` is called with "looking" or "writing", and how many of
    these steps there are. What is done waits in the folder ``OUTPUT.redacting`` until all is, and
    whoever redacts the same files again in the same way, after an interruption, goes on from there.
    Raises RecordingError, and InhandError where the folder cannot be written.
    """
    if output.exists():
        raise RecordingError(f"{output} exists already: choose another name, or move it away")
    with RedactedRecording(paths, output, what, section_frames) as recording:
        frames, messages = recording.count(recording.frame_keys), len(recording)
        recording.look(new_finder, lambda: on_step("looking", frames))
        written = convert_recording(
            recording, output, Selection(), on_message=lambda: on_step("writing", messages)
        )
        recording.results.remove()
        return Redaction(written, dict(recording.counts), sum(recording.apart.values()))


class _Outcome(msgspec.Struct, frozen=True, array_like=True):
    """What became of one picture, which its key, number and time of reception name: it is counted
    under ``counted``, or damaged, and left out, as it was, or with another payload."""

    of: tuple[str, int, int]
    counted: tuple[str, ...] = ()
    is_damaged: bool = False
    is_left_out: bool = False
    payload: bytes | None = None


_OUTCOMES = msgspec.msgpack.Decoder(list[_Outcome])


class _Outcomes:
    """What became of pictures, one after the other: of this run, or of one before."""

    def __init__(self, results: SectionResults, section_frames: int) -> None:
        self._results, self._section_frames = results, section_frames
        self._section = 0
        self._before = iter(self._load())
        self._now: list[_Outcome] = []

    def next(
        self, message: RecordedMessage, work: Callable[[RecordedMessage], _Outcome]
    ) -> _Outcome:
        """Return what became of the next picture, by ``work`` where that is not known."""
        before = next(self._before, None)
        outcome = work(message) if before is None or before.of != _identity(message) else before
        self._now.append(outcome)
        if len(self._now) == self._section_frames:
            self._end_section(known=outcome is before)
        return outcome

    def _end_section(self, *, known: bool) -> None:
        if not known:
            self._results.store(self._file, msgspec.msgpack.encode(self._now))
        self._section += 1
        self._now = []
        self._before = iter(self._load())

    def _load(self) -> list[_Outcome]:
        result = self._results.load(self._file)
        return [] if result is None else _OUTCOMES.decode(result)

    @property
    def _file(self) -> str:
        return f"written {self._section}"


def _identity(message: RecordedMessage) -> tuple[str, int, int]:
    return message.key, message.sequence, message.received_ns


class RedactedRecording(Recording):
    """Recordings whose frames and previews show no faces, or no people; all else is as it was.

    ``look`` comes before ``messages`` and ``metadata``. ``counts`` says by name what became of
    frames and previews that were read through ``messages``, as the record of redaction does.
    ``results`` holds what is done until all is.
    """

    def __init__(
        self, paths: Iterable[Path], output: Path, what: What, section_frames: int
    ) -> None:
        """Open the files; raises RecordingError, also where they hold no pictures."""
        super().__init__(*find_files(paths))
        self._section_frames = section_frames
        self.counts: Counter[str] = Counter()
        self._what: What = what
        self._hiding: dict[str, CameraHiding] = {}
        self._record = {
            "hidden": what,
            "version": f"inhand {version('inhand')}",
            "network": DEFAULT_NETWORK,
        }
        self.frame_keys = [key for key, topic in self.keys.items() if topic is RGBD]
        if not self.frame_keys:
            self.close()
            raise RecordingError("there are no pictures: nothing is to be hidden")
        about = {
            "sources": [(path.name, digest_of_recording(path)) for path in self.paths],
            "redaction": self._record,
            "parameters": repr((DEFAULT_REDACTION, DEFAULT_FACES, section_frames)),
        }
        self.results = SectionResults(output.with_name(output.name + REDACTING_SUFFIX), about)

    def look(
        self, new_finder: Callable[[], FaceFinder], on_frame: Callable[[], None] = lambda: None
    ) -> None:
        """Find people in all frames, with a finder for each camera; raises RecordingError."""
        for key in self.frame_keys:
            sightings = look_through(
                self, key, new_finder, self.results, on_frame, self._section_frames
            )
            self._hiding[key] = camera_hiding(self._what, self, key, sightings)

    def messages(
        self, keys: Iterable[str], *, start_ns: int = 0, end_ns: int = LATEST_NS
    ) -> Iterator[RecordedMessage]:
        """Yield messages without what is to be hidden.

        Pictures that cannot be read are passed over and counted as damaged; so are, among
        ``counts``, previews of no frame of the recording.
        """
        outcomes = _Outcomes(self.results, self._section_frames)
        for message in super().messages(keys, start_ns=start_ns, end_ns=end_ns):
            if message.topic in WITHOUT_PICTURES:
                yield message
                continue
            outcome = outcomes.next(message, self._redacted)
            for name in outcome.counted:
                self._note(name)
            if outcome.is_damaged:
                self.damaged[self._names[message.key]] += 1
            if outcome.is_damaged or outcome.is_left_out:
                continue
            if outcome.payload is not None:
                message = replace(message, payload=outcome.payload, coded=None)
            yield message

    def messages_apart(
        self, keys: Iterable[str], *, start_ns: int = 0, end_ns: int = LATEST_NS
    ) -> Iterator[RecordedMessage]:
        """Yield nothing: what could not be read may show anybody."""
        return iter(())

    def metadata(self) -> dict[Path, dict[str, dict[str, str]]]:
        """Read the named records of each file, with one on what was hidden, which is complete when
        all messages were read. That of a former redaction is named after its file."""
        records = super().metadata()
        for path, of_file in records.items():
            if REDACTION_RECORD in of_file:
                of_file[f"{REDACTION_RECORD} of {path.name}"] = of_file[REDACTION_RECORD]
            of_file[REDACTION_RECORD] = self._record
        return records

    def attachments(self) -> list[Attachment]:
        """Read what is attached to the files and shows nobody: the meshes of objects."""
        return [one for one in super().attachments() if meshes_in([one])]

    def _redacted(self, message: RecordedMessage) -> _Outcome:
        try:
            if message.topic is RGBD:
                return self._frame(message)
            if message.topic is PREVIEW:
                return self._preview(message)
        except MessageError:
            return _Outcome(_identity(message), is_damaged=True)
        counted = (f"{message.topic.stream} left out",)
        return _Outcome(_identity(message), counted, is_left_out=True)

    def _frame(self, message: RecordedMessage) -> _Outcome:
        # What is coded upon a picture that shows more would be unreadable here, or show it.
        standing = as_jpeg(message)
        frame = standing.frame()
        hidden = self._hiding[message.key].hidden_in(frame)
        redacted = hide_in_frame(frame, hidden)
        counted = ["frames"]
        if hidden.mask is None:
            counted.append("frames all hidden")
        elif redacted is None:
            counted.append("frames with nothing hidden")
        payload = None if standing is message else standing.payload
        if redacted is not None:
            payload = RGBD.encode(redacted)
        return _Outcome(_identity(message), tuple(counted), payload=payload)

    def _preview(self, message: RecordedMessage) -> _Outcome:
        """Hide in a preview what is hidden of its frame; raises MessageError."""
        frame = self._frame_of(message)
        if frame is None:
            return _Outcome(_identity(message), ("previews left out",), is_left_out=True)
        hidden = self._hiding[RGBD.key(parse_key(message.key).site, message.name)].hidden_in(frame)
        redacted = hide_in_preview(PREVIEW.decode(message.payload), hidden)
        payload = None if redacted is None else PREVIEW.encode(redacted)
        return _Outcome(_identity(message), ("previews",), payload=payload)

    def _frame_of(self, message: RecordedMessage) -> RgbdFrame | None:
        """Return the frame that a preview is of; None where the recording has not got it whole."""
        key = RGBD.key(parse_key(message.key).site, message.name)
        if key not in self._hiding:
            return None
        preview = PREVIEW.decode(message.payload)
        try:
            found = self[key].nearest(preview.time_ns, within_ns=0)
        except (RecordingError, MessageError):
            return None
        frame = None if found is None else found.message
        if not isinstance(frame, RgbdFrame) or frame.sequence != preview.sequence:
            return None
        return frame

    def _note(self, name: str) -> None:
        self.counts[name] += 1
        self._record[name] = str(self.counts[name])
