"""Writes a dataset: shapes, recordings, and ``dataset.toml``."""

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

import msgspec
from inhand_runtime.recording import RecordingWriter
from inhand_schemas.keys import Site
from inhand_schemas.messages import CameraInfo, Message, ObjectPose, RgbdFrame, Skeletons
from inhand_schemas.topics import INFO, LABEL, RGBD, SKELETONS, AnyTopic
from inhand_tracker.shape.shape import ObjectShape, save_shape

from inhand_lab.datasets.dataset import (
    CAMERA,
    FORMAT,
    VERSION,
    Dataset,
    DatasetEntry,
    DatasetError,
    DatasetFile,
)

_TOPICS: dict[type[Message], AnyTopic] = {
    CameraInfo: INFO,
    RgbdFrame: RGBD,
    Skeletons: SKELETONS,
    ObjectPose: LABEL,
}


class DatasetWriter:
    """Writes a new dataset; ``finish`` writes ``dataset.toml`` last, so a broken one has none."""

    def __init__(self, folder: Path) -> None:
        if (folder / "dataset.toml").exists():
            raise DatasetError(f"{folder} holds a dataset already: choose another folder")
        with _reporting(folder):
            (folder / "recordings").mkdir(parents=True, exist_ok=True)
        self.folder = folder
        self._entries: list[DatasetEntry] = []
        self._shapes: set[str] = set()

    def add_shape(self, shape: ObjectShape) -> None:
        """Write an object's folder, once."""
        if shape.name not in self._shapes:
            with _reporting(self.folder):
                save_shape(shape, self.folder / "objects" / shape.name)
            self._shapes.add(shape.name)

    def add_recording(self, entry: DatasetEntry, messages: Iterable[Message]) -> None:
        """Write one recording from its messages, which come in the order of their times."""
        write_messages(self.folder / entry.file, messages)
        self.add_entry(entry)

    def add_entry(self, entry: DatasetEntry) -> None:
        """Add a recording whose file is written."""
        self._entries.append(entry)

    def finish(self, generator: Mapping[str, str | int | float | bool]) -> Dataset:
        """Write ``dataset.toml``; ``generator`` says what made the dataset, and its settings."""
        contents = DatasetFile(
            format=FORMAT,
            version=VERSION,
            generator=dict(generator),
            recordings=tuple(self._entries),
        )
        path = self.folder / "dataset.toml"
        with _reporting(self.folder):
            path.write_text(_toml(contents), encoding="utf-8")
        return Dataset(self.folder, contents.recordings)


def write_messages(path: Path, messages: Iterable[Message]) -> None:
    """Write a recording of messages, which come in the order of their times; raises
    RecordingError."""
    write_received(path, ((CAMERA, message.time_ns, message) for message in messages))


def write_received(path: Path, received: Iterable[tuple[str, int, Message]]) -> None:
    """Write a recording of messages of several cameras, each with its camera and the time at which
    it is received, nanoseconds, in the order of these; raises RecordingError."""
    site = Site()
    with RecordingWriter(path) as writer:
        for camera, received_ns, message in received:
            topic = _TOPICS[type(message)]
            name = message.object if isinstance(message, ObjectPose) else camera
            writer.write(
                site.key(topic.stream, name),
                msgspec.msgpack.encode(message),
                received_ns=received_ns,
                captured_ns=message.time_ns,
                sequence=message.sequence,
            )


@contextmanager
def _reporting(folder: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise DatasetError(f"cannot write {folder}: {error.strerror}") from None


def entry_toml(entry: DatasetEntry) -> list[str]:
    """Return the lines of an entry in ``dataset.toml``."""
    values = msgspec.structs.asdict(entry)
    given = {key: value for key, value in values.items() if value is not None}
    return ["[[recordings]]", *(f"{key} = {_toml_value(value)}" for key, value in given.items())]


def _toml(contents: DatasetFile) -> str:
    lines = [f'format = "{contents.format}"', f"version = {contents.version}"]
    if contents.generator:
        lines += ["", "[generator]"]
        lines += [f"{key} = {_toml_value(value)}" for key, value in contents.generator.items()]
    for entry in contents.recordings:
        lines += ["", *entry_toml(entry)]
    return "\n".join(lines) + "\n"


def _toml_value(value: object) -> str:
    # A JSON string, number or boolean is the same in TOML.
    return msgspec.json.encode(value).decode()
