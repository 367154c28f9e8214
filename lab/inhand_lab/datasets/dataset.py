"""Datasets: a folder of recordings with labels, and the shapes of their objects.

``dataset.toml`` names for each recording the interaction, object, participant, handedness and
frame rate; ``recordings/*.mcap`` hold the same messages that the wire carries, ``label/…``
included; ``objects/NAME/`` holds mesh and marked vertices.
"""

import tomllib
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import msgspec
import numpy as np
from inhand_runtime.errors import InhandError
from inhand_runtime.recording import RecordingWriter, read_recording
from inhand_schemas.keys import Site
from inhand_schemas.messages import (
    CameraInfo,
    Message,
    ObjectPose,
    Person,
    RgbdFrame,
    Skeletons,
)
from inhand_schemas.topics import INFO, LABEL, RGBD, SKELETONS, AnyTopic
from inhand_tracker.geometry.camera import Intrinsics, intrinsics_of
from inhand_tracker.mapping.learning import LabelledSequence
from inhand_tracker.people.following import Follower
from inhand_tracker.shape.shape import ObjectShape, load_shape, save_shape
from inhand_tracker.wire.conversion import joints_of

FORMAT = "inhand-dataset"
VERSION = 1
CAMERA = "camera"

_TOPICS: dict[type[Message], AnyTopic] = {
    CameraInfo: INFO,
    RgbdFrame: RGBD,
    Skeletons: SKELETONS,
    ObjectPose: LABEL,
}


class DatasetError(InhandError):
    """A dataset that cannot be used; the message says the mend."""


class Entry(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One recording of a dataset; ``file`` is relative to the dataset's folder."""

    file: str
    interaction: str
    participant: str
    object: str | None = None
    handedness: Literal["left", "right"] = "right"
    frame_rate: float = 30.0


class _DatasetFile(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    format: str
    version: int
    generator: dict[str, str | int | float | bool] = {}
    recordings: tuple[Entry, ...]


@dataclass(frozen=True)
class Frame:
    """One moment of a recording; ``label`` is the true pose where it is known."""

    sequence: int
    time_ns: int
    people: tuple[Person, ...]
    label: ObjectPose | None


@dataclass(frozen=True)
class Dataset:
    """A dataset's folder and what its ``dataset.toml`` says."""

    folder: Path
    entries: tuple[Entry, ...]

    def interactions(self) -> tuple[str, ...]:
        """Every interaction with an object, in the order of first mention."""
        return tuple(dict.fromkeys(e.interaction for e in self.entries if e.object is not None))

    def shape(self, name: str) -> ObjectShape:
        """An object's shape; raises InhandError."""
        return load_shape(self.folder / "objects" / name)

    def path(self, entry: Entry) -> Path:
        """The recording's file."""
        return self.folder / entry.file


def load_dataset(folder: Path) -> Dataset:
    """Read ``dataset.toml``; raises DatasetError with the mend."""
    path = folder / "dataset.toml"
    try:
        values = tomllib.loads(path.read_text(encoding="utf-8"))
        contents = msgspec.convert(values, _DatasetFile)
    except OSError as error:
        raise DatasetError(
            f"cannot read {path}: {error.strerror}; `inhand simulate` or `inhand import` makes a "
            "dataset"
        ) from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise DatasetError(f"{path} is no TOML: {error}") from None
    except msgspec.ValidationError as error:
        raise DatasetError(f"{path}: {error}") from None
    if contents.format != FORMAT or contents.version != VERSION:
        raise DatasetError(
            f"{path} is {contents.format} version {contents.version}, and this release reads "
            f"{FORMAT} version {VERSION}"
        )
    missing = [e.file for e in contents.recordings if not (folder / e.file).is_file()]
    if missing:
        raise DatasetError(f"{path} names {missing[0]!r}, which is not there")
    return Dataset(folder, contents.recordings)


class DatasetWriter:
    """Writes a new dataset; ``finish`` writes ``dataset.toml`` last, so a broken one has none."""

    def __init__(self, folder: Path) -> None:
        if (folder / "dataset.toml").exists():
            raise DatasetError(f"{folder} holds a dataset already: choose another folder")
        with _reporting(folder):
            (folder / "recordings").mkdir(parents=True, exist_ok=True)
        self.folder = folder
        self._entries: list[Entry] = []
        self._shapes: set[str] = set()

    def add_shape(self, shape: ObjectShape) -> None:
        """Write an object's folder, once."""
        if shape.name not in self._shapes:
            with _reporting(self.folder):
                save_shape(shape, self.folder / "objects" / shape.name)
            self._shapes.add(shape.name)

    def add_recording(self, entry: Entry, messages: Iterable[Message]) -> None:
        """Write one recording; ``messages`` come in the order of their times."""
        site = Site()
        with RecordingWriter(self.folder / entry.file) as writer:
            for message in messages:
                topic = _TOPICS[type(message)]
                name = message.object if isinstance(message, ObjectPose) else CAMERA
                writer.write(
                    site.key(topic.stream, name),
                    msgspec.msgpack.encode(message),
                    received_ns=message.time_ns,
                    captured_ns=message.time_ns,
                    sequence=message.sequence,
                )
        self._entries.append(entry)

    def finish(self, generator: Mapping[str, str | int | float | bool]) -> Dataset:
        """Write ``dataset.toml``; ``generator`` says what made the dataset, and its settings."""
        contents = _DatasetFile(
            format=FORMAT,
            version=VERSION,
            generator=dict(generator),
            recordings=tuple(self._entries),
        )
        path = self.folder / "dataset.toml"
        with _reporting(self.folder):
            path.write_text(_toml(contents), encoding="utf-8")
        return Dataset(self.folder, contents.recordings)


def load_frames(path: Path, object_name: str | None) -> list[Frame]:
    """Skeletons and labels of a recording, in order, without pixels.

    Of several cameras' skeletons, those that the labels were made in; raises DatasetError where
    the labels do not tell.
    """
    labels: dict[tuple[int, int], ObjectPose] = {}
    labelled: set[str] = set()
    skeletons: dict[str, list[Skeletons]] = {}
    for recorded in read_recording(path, streams=(LABEL.stream, SKELETONS.stream)):
        message = recorded.message()
        if isinstance(message, Skeletons):
            skeletons.setdefault(recorded.name, []).append(message)
        elif isinstance(message, ObjectPose) and message.object == object_name:
            labels[message.sequence, message.time_ns] = message
            labelled.add(message.camera)
    camera = _labelled_camera(path, labelled, set(skeletons))
    return [
        Frame(s.sequence, s.time_ns, s.people, labels.get((s.sequence, s.time_ns)))
        for s in skeletons.get(camera, ())
    ]


def load_camera(path: Path) -> Intrinsics | None:
    """The first camera of a recording, where it says."""
    info = load_camera_info(path)
    return None if info is None else intrinsics_of(info)


def load_camera_info(path: Path, camera: str | None = None) -> CameraInfo | None:
    """What a recording says of the camera of that name, or of the first one."""
    for recorded in read_recording(path, streams=(INFO.stream,)):
        message = recorded.message()
        if isinstance(message, CameraInfo) and camera in (None, recorded.name):
            return message
    return None


def iterate_pixels(path: Path, camera: str | None = None) -> Iterator[RgbdFrame]:
    """The frames of a camera, or of all, of a recording, in order."""
    for recorded in read_recording(path, streams=(RGBD.stream,)):
        if camera in (None, recorded.name):
            message = recorded.message()
            if isinstance(message, RgbdFrame):
                yield message


def has_images(dataset: Dataset) -> bool:
    """Whether any recording has pixels; raises RecordingError."""
    return any(
        next(iterate_pixels(dataset.path(entry)), None) is not None for entry in dataset.entries
    )


def labelled_sequence(dataset: Dataset, entry: Entry) -> LabelledSequence:
    """A recording as training reads it; frames without body or label hold NaN."""
    frames = load_frames(dataset.path(entry), entry.object)
    joints = np.full((len(frames), 20, 3), np.nan)
    translations = np.full((len(frames), 3), np.nan)
    orientations = np.full((len(frames), 4), np.nan)
    follower = Follower()
    for index, frame in enumerate(frames):
        person = follower.choose(frame.people, frame.time_ns)
        if person is not None:
            joints[index] = joints_of(person)
        if frame.label is not None and frame.label.camera_from_object is not None:
            translations[index] = frame.label.camera_from_object.translation
            orientations[index] = frame.label.camera_from_object.rotation
    return LabelledSequence(
        entry.participant,
        entry.handedness == "left",
        joints,
        translations,
        orientations,
        entry.frame_rate,
    )


def _labelled_camera(path: Path, labelled: set[str], tracked: set[str]) -> str:
    """The camera that a recording's labels and skeletons share."""
    cameras = labelled or tracked
    if len(cameras) > 1:
        raise DatasetError(
            f"{path}: {'labels were made in' if labelled else 'skeletons and no label are of'} "
            f"{len(cameras)} cameras ({', '.join(sorted(cameras))}): label it in one"
        )
    if tracked and not cameras <= tracked:
        raise DatasetError(
            f"{path}: the labels were made in camera {min(cameras)!r}, and the skeletons are of "
            f"{', '.join(sorted(tracked))}: label it in one of these"
        )
    return min(cameras, default=CAMERA)


@contextmanager
def _reporting(folder: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise DatasetError(f"cannot write {folder}: {error.strerror}") from None


def _toml(contents: _DatasetFile) -> str:
    lines = [f'format = "{contents.format}"', f"version = {contents.version}"]
    if contents.generator:
        lines += ["", "[generator]"]
        lines += [f"{key} = {_toml_value(value)}" for key, value in contents.generator.items()]
    for entry in contents.recordings:
        lines += ["", "[[recordings]]"]
        lines += [
            f"{key} = {_toml_value(value)}"
            for key, value in msgspec.structs.asdict(entry).items()
            if value is not None
        ]
    return "\n".join(lines) + "\n"


def _toml_value(value: object) -> str:
    # A JSON string, number or boolean is the same in TOML.
    return msgspec.json.encode(value).decode()
