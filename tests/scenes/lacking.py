"""Copies datasets as if a body tracker had never given some joints."""

from collections.abc import Collection
from pathlib import Path
from shutil import copytree

import msgspec
from inhand_lab.datasets.dataset import Dataset, load_dataset
from inhand_runtime.recording import RecordingWriter, read_recording
from inhand_runtime.recording.copying import write_beside
from inhand_schemas.messages import Person, Skeletons


def lacking(dataset: Dataset, folder: Path, missing: Collection[int]) -> Dataset:
    """Write the dataset again, without those joints of anybody."""
    copy = load_dataset(copytree(dataset.folder, folder))
    for entry in copy.entries:
        path = copy.path(entry)
        recorded = list(read_recording(path))
        path.unlink()
        with RecordingWriter(path) as writer:
            for one in recorded:
                message = one.message()
                if isinstance(message, Skeletons):
                    people = tuple(_without(person, missing) for person in message.people)
                    message = msgspec.structs.replace(message, people=people)
                write_beside(writer, one.key, one, msgspec.msgpack.encode(message))
    return copy


def _without(person: Person, missing: Collection[int]) -> Person:
    return msgspec.structs.replace(
        person,
        joints=tuple((0.0, 0.0, 0.0) if j in missing else p for j, p in enumerate(person.joints)),
        states=tuple("missing" if j in missing else s for j, s in enumerate(person.states)),
    )
