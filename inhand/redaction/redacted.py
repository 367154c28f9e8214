"""A recording as it is without faces, or without people."""

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path

from inhand_capture.estimation.weights import DEFAULT_NETWORK
from inhand_capture.faces.finder import FaceFinder
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

WITHOUT_PICTURES = (INFO, SKELETONS, POSE, LABEL, EVENT, HEALTH)
"""What is passed on as it is. A stream that stands neither here nor among those that are redacted
is left out, as nobody said yet what it shows."""


@dataclass(frozen=True)
class Redaction:
    """What was written, and by name what became of frames and previews."""

    written: Conversion
    counts: Mapping[str, int]


def redact_recording(
    paths: Iterable[Path],
    output: Path,
    what: What,
    new_finder: Callable[[], FaceFinder],
    on_step: Callable[[str, int], None] = lambda _step, _total: None,
) -> Redaction:
    """Write files or folders, as one recording, without faces or people to the new file ``output``.

    ``new_finder`` makes what finds people in one camera's pictures, by skeletons too. ``on_step``
    is called with "looking" or "writing", and how many of these steps there are. Raises
    RecordingError; of what fails or is interrupted nothing stays.
    """
    if output.exists():
        raise RecordingError(f"{output} exists already: choose another name, or move it away")
    with RedactedRecording(paths, what) as recording:
        frames, messages = recording.count(recording.frame_keys), len(recording)
        recording.look(new_finder, lambda: on_step("looking", frames))
        written = convert_recording(
            recording, output, Selection(), on_message=lambda: on_step("writing", messages)
        )
        return Redaction(written, dict(recording.counts))


class RedactedRecording(Recording):
    """Recordings whose frames and previews show no faces, or no people; all else is as it was.

    ``look`` comes before ``messages`` and ``metadata``. ``counts`` says by name what became of
    frames and previews that were read through ``messages``, as the record of redaction does.
    """

    def __init__(self, paths: Iterable[Path], what: What) -> None:
        """Open the files; raises RecordingError, also where they hold no pictures."""
        super().__init__(*find_files(paths))
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

    def look(
        self, new_finder: Callable[[], FaceFinder], on_frame: Callable[[], None] = lambda: None
    ) -> None:
        """Find people in all frames, with a finder for each camera; raises RecordingError."""
        for key in self.frame_keys:
            sightings = look_through(self, key, new_finder(), on_frame)
            self._hiding[key] = camera_hiding(self._what, self, key, sightings)

    def messages(
        self, keys: Iterable[str], *, start_ns: int = 0, end_ns: int = LATEST_NS
    ) -> Iterator[RecordedMessage]:
        """Yield messages without what is to be hidden.

        Pictures that cannot be read are passed over and counted as damaged; so are, among
        ``counts``, previews of no frame of the recording.
        """
        for message in super().messages(keys, start_ns=start_ns, end_ns=end_ns):
            redacted = self._redacted(message)
            if redacted is not None:
                yield redacted

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

    def _redacted(self, message: RecordedMessage) -> RecordedMessage | None:
        if message.topic in WITHOUT_PICTURES:
            return message
        try:
            if message.topic is RGBD:
                return self._frame(message)
            if message.topic is PREVIEW:
                return self._preview(message)
        except MessageError:
            self.damaged[self._names[message.key]] += 1
            return None
        self._note(f"{message.topic.stream} left out")
        return None

    def _frame(self, message: RecordedMessage) -> RecordedMessage:
        # What is coded upon a picture that shows more would be unreadable here, or show it.
        message = as_jpeg(message)
        frame = message.frame()
        hidden = self._hiding[message.key].hidden_in(frame)
        redacted = hide_in_frame(frame, hidden)
        self._note("frames")
        if hidden.mask is None:
            self._note("frames all hidden")
        elif redacted is None:
            self._note("frames with nothing hidden")
        if redacted is None:
            return message
        return replace(message, payload=RGBD.encode(redacted))

    def _preview(self, message: RecordedMessage) -> RecordedMessage | None:
        """Hide in a preview what is hidden of its frame; raises MessageError."""
        frame = self._frame_of(message)
        if frame is None:
            self._note("previews left out")
            return None
        self._note("previews")
        hidden = self._hiding[RGBD.key(parse_key(message.key).site, message.name)].hidden_in(frame)
        redacted = hide_in_preview(PREVIEW.decode(message.payload), hidden)
        if redacted is None:
            return message
        return replace(message, payload=PREVIEW.encode(redacted))

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
