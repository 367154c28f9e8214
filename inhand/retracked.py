"""A recording tracked again, frame by frame, with the new poses beside all that it held.

Nothing is late and nothing is dropped, as no frame comes before the one before it is done: the same
recording, models and settings give the same poses, and the same bytes, again. So they do where the
work has one thread: with more, linear algebra adds up in another order, which shows in last bits.
"""

import hashlib
import importlib.metadata
import json
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import msgspec
from inhand_recorder.attachments import copy_attachments
from inhand_runtime.recording import (
    RecordedMessage,
    RecordingError,
    RecordingWriter,
    read_metadata,
    read_recording,
)
from inhand_runtime.recording.copying import (
    copy_message,
    copy_metadata,
    write_beside,
    written_or_gone,
)
from inhand_runtime.recording.message_index import IndexedMessages, RecordingIndex, open_index
from inhand_runtime.recording.part_file import PART_SUFFIX
from inhand_schemas.errors import KeyFormatError, MessageError
from inhand_schemas.keys import parse_key, require_name
from inhand_schemas.messages import CameraInfo, ObjectPose, RgbdFrame, Skeletons
from inhand_schemas.topics import INFO, POSE, RGBD, SKELETONS
from inhand_tracker.frames import camera_frame, frame_image, needs_of, pose_messages, source_of
from inhand_tracker.loading import load_watcher
from inhand_tracker.people.following import PeopleWatched
from inhand_tracker.people.watching import Watcher
from inhand_tracker.settings import TrackerSettings

from inhand.resumed_work import digest_of_recording

RECORD = "retrack"
"""The metadata record that says what tracked a recording again."""


@dataclass(frozen=True)
class Retracking:
    """One recording, where it goes when it is tracked again, and by which tracker.

    ``camera`` is None where it is the only one; ``mark`` differs with the models and settings.
    """

    path: Path
    output: Path
    tracker: str
    settings: TrackerSettings
    camera: str | None
    mark: str


@dataclass
class Retracked:
    """What came of a recording: frames that were tracked, those of them with a picture, how often
    each object was in each state, and what went wrong, with how often."""

    path: Path
    output: Path
    frames: int = 0
    with_pictures: int = 0
    states: dict[str, Counter[str]] = field(default_factory=dict)
    problems: Counter[str] = field(default_factory=Counter)
    skipped: bool = False


def mark_of(tracker: str, settings: TrackerSettings) -> str:
    """Return what differs with the models' contents, the settings and the release."""
    files = [*settings.model_files, *([settings.recogniser] if settings.recogniser else [])]
    parts = {
        "tracker": tracker,
        "settings": settings.model_dump(mode="json", exclude={"model", "models", "recogniser"}),
        "files": [hashlib.sha256(file.read_bytes()).hexdigest() for file in files],
        "release": importlib.metadata.version("inhand"),
    }
    return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()


def is_done(task: Retracking) -> bool:
    """Whether the result is there, whole, of this recording and this tracker.

    Raises RecordingError where a file of that name is another one.
    """
    if not task.output.exists():
        return False
    record = read_metadata(task.output).get(RECORD, {})
    if _about(task).items() <= record.items():
        return True
    raise RecordingError(
        f"{task.output} is of another recording, model, setting or release: choose another folder, "
        "or move it away"
    )


def retrack(task: Retracking) -> Retracked:
    """Track a recording again; what is left of an attempt that was cut off is written anew.

    Raises RecordingError for a recording that cannot be tracked, and InhandError for a model.
    """
    task.output.with_name(task.output.name + PART_SUFFIX).unlink(missing_ok=True)
    with open_index(task.path) as index:
        if index.note is not None:
            raise RecordingError(index.note)
        tracked = _Tracked(task, index)
        with written_or_gone(task.output) as writer:
            for message in read_recording(task.path, apart=True):
                copy_message(writer, message)
                for pose in tracked.poses_of(message):
                    key = POSE.key(parse_key(message.key).site, pose.object)
                    write_beside(writer, key, message, POSE.encode(pose))
            _note(writer, task, tracked)
    return tracked.result


class _Tracked:
    """The tracker at work on one recording."""

    def __init__(self, task: Retracking, index: RecordingIndex) -> None:
        self.camera = _camera_of(task, index)
        self._people = _people(task)
        self.names = _pose_names(task, index, self._people.names)
        self.result = Retracked(task.path, task.output)
        self._needs = needs_of(task.settings)
        self._info = _first_info(index.messages(INFO.stream, self.camera), task, self.camera)
        self._frames = index.messages(RGBD.stream, self.camera)
        stamps = self._frames.stamps
        frames = zip(stamps.captured_ns.tolist(), stamps.sequences.tolist(), strict=True)
        self._frame_numbers = {stamp: number for number, stamp in enumerate(frames)}

    def poses_of(self, message: RecordedMessage) -> Iterable[ObjectPose]:
        """Track what a message brings: poses with the names that the new tracks have."""
        if message.apart or message.name != self.camera:
            return ()
        try:
            if message.topic is INFO:
                self._info = INFO.decode(message.payload)
            elif message.topic is SKELETONS:
                return self._track(message, SKELETONS.decode(message.payload))
        except MessageError as error:
            self.result.problems[f"{message.topic.stream} cannot be read: {error}"] += 1
        return ()

    def _track(self, message: RecordedMessage, skeletons: Skeletons) -> list[ObjectPose]:
        image = None
        try:
            image = frame_image(self._frame_of(message), self._info, self._needs)
        except MessageError as error:
            self.result.problems[f"a picture cannot be read: {error}"] += 1
        frame = camera_frame(skeletons, image, self._info)
        objects = self._people.see(skeletons.people, frame, self._note_failure)
        self.result.frames += 1
        self.result.with_pictures += image is not None
        for trouble in (self._people.trouble, self._people.hips_trouble):
            if trouble is not None:
                self.result.problems[trouble] += 1
        source = source_of(skeletons, self.camera, self._info)
        return [self._named(pose) for pose in pose_messages(objects, source, frame)]

    def _frame_of(self, message: RecordedMessage) -> RgbdFrame | None:
        number = self._frame_numbers.get((message.captured_ns, message.sequence))
        if number is None or not self._needs:
            return None
        return self._frames[number].frame()

    def _named(self, pose: ObjectPose) -> ObjectPose:
        self.result.states.setdefault(pose.object, Counter())[pose.state] += 1
        return msgspec.structs.replace(pose, object=self.names[pose.object])

    def _note_failure(self, name: str, error: Exception) -> None:
        self.result.problems[f"cannot track {name}: {type(error).__name__}: {error}"] += 1


def _people(task: Retracking) -> PeopleWatched:
    """Return who watches the people of a recording, each by trackers of their own."""

    def new_watcher() -> Watcher:
        return load_watcher(task.tracker, task.settings)

    return PeopleWatched(new_watcher, task.settings.people)


def _camera_of(task: Retracking, index: RecordingIndex) -> str:
    cameras = sorted(name for name, count in index.counts(SKELETONS.stream).items() if count)
    if not cameras:
        raise RecordingError(
            f"{task.path} has no skeletons: `inhand recording skeletons` adds those of its pictures"
        )
    if task.camera is None and len(cameras) > 1:
        names = ", ".join(cameras)
        raise RecordingError(f"{task.path} has several cameras; add --camera with one of: {names}")
    if task.camera is not None and task.camera not in cameras:
        names = ", ".join(cameras)
        raise RecordingError(
            f"{task.path} has no skeletons of camera {task.camera!r}, but of: {names}"
        )
    return cameras[0] if task.camera is None else task.camera


def _pose_names(
    task: Retracking, index: RecordingIndex, objects: Iterable[str]
) -> Mapping[str, str]:
    """Return the names of the new pose tracks by object; raises RecordingError for one that is
    there, or too long."""
    names = {}
    for name in objects:
        names[name] = f"{name}_{task.tracker}"
        try:
            require_name("object", names[name])
        except KeyFormatError as error:
            raise RecordingError(f"{error}: choose a shorter --tracker") from None
        if names[name] in index.counts(POSE.stream):
            raise RecordingError(
                f"{task.path} has poses of {names[name]} already: choose another --tracker"
            )
    return names


def _first_info(infos: IndexedMessages, task: Retracking, camera: str) -> CameraInfo:
    if not infos:
        raise RecordingError(
            f"{task.path} lacks the info of camera {camera}: `inhand recording repair` adds it"
        )
    info: CameraInfo = INFO.decode(infos[0].payload)
    return info


def _about(task: Retracking) -> dict[str, str]:
    digest = digest_of_recording(task.path)
    return {"source": task.path.name, "source_digest": digest, "mark": task.mark}


def _note(writer: RecordingWriter, task: Retracking, tracked: _Tracked) -> None:
    """Write into the new recording what tracked it."""
    files = [file.name for file in task.settings.model_files]
    settings = task.settings.model_dump(mode="json", exclude={"model", "models", "recogniser"})
    result = tracked.result
    about = {
        **_about(task),
        "tracker": task.tracker,
        "camera": tracked.camera,
        "models": " ".join(files),
        "settings": json.dumps(settings, sort_keys=True),
        "poses": " ".join(f"{name}={new}" for name, new in tracked.names.items()),
        "release": importlib.metadata.version("inhand"),
        "frames": str(result.frames),
        "problems": json.dumps(result.problems, sort_keys=True),
    }
    copy_metadata(writer, task.path, RECORD, about)
    copy_attachments(writer, task.path)


def values(result: Retracked) -> dict[str, object]:
    """Return a result for machines."""
    return {
        "path": str(result.path),
        "output": str(result.output),
        "skipped": result.skipped,
        "frames": result.frames,
        "with_pictures": result.with_pictures,
        "states": result.states,
        "problems": result.problems,
    }
