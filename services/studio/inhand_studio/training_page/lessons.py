"""What can be learned of a dataset, and a dataset of the recordings that are chosen."""

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import msgspec
from inhand_lab.datasets.dataset import DatasetEntry, DatasetError, load_dataset
from inhand_lab.datasets.new_entry import add_entry
from inhand_runtime.recording import RecordingError
from inhand_runtime.recording.message_index import open_index
from inhand_schemas.topics import LABEL


@dataclass(frozen=True)
class Lesson:
    """An object in an interaction, with its recordings; ``unusable`` says of some why not."""

    object_name: str
    interaction: str
    entries: tuple[DatasetEntry, ...]
    unusable: dict[str, str]

    @property
    def title(self) -> str:
        """What it is called on the page."""
        return f"{self.object_name} in {self.interaction}"


def lessons_of(dataset: Path) -> list[Lesson]:
    """Return what a dataset's recordings teach; raises DatasetError."""
    grouped: dict[tuple[str, str], list[DatasetEntry]] = {}
    for entry in load_dataset(dataset).entries:
        if entry.object is not None:
            grouped.setdefault((entry.object, entry.interaction), []).append(entry)
    return [
        Lesson(name, interaction, tuple(entries), _unusable(dataset, name, entries))
        for (name, interaction), entries in grouped.items()
    ]


@contextmanager
def dataset_of(dataset: Path, entries: Sequence[DatasetEntry]) -> Iterator[Path]:
    """Give the folder of a dataset with these recordings alone, and remove it after the block.

    The recordings and objects are those of ``dataset`` itself. Raises DatasetError.
    """
    if not entries:
        raise DatasetError("choose the recordings to learn from")
    with TemporaryDirectory(prefix="inhand-lesson-") as made:
        folder = Path(made)
        os.symlink((dataset / "objects").absolute(), folder / "objects")
        for entry in entries:
            file = str((dataset / entry.file).absolute())
            add_entry(folder, msgspec.structs.replace(entry, file=file))
        yield folder


def _unusable(dataset: Path, name: str, entries: Sequence[DatasetEntry]) -> dict[str, str]:
    reasons = {}
    for entry in entries:
        try:
            with open_index(dataset / entry.file) as index:
                if name not in index.counts(LABEL.stream):
                    reasons[entry.file] = f"it has no labels of {name} yet"
        except RecordingError as error:
            reasons[entry.file] = str(error)
    return reasons
