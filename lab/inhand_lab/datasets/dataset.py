"""Datasets: a folder of recordings with labels, and the shapes of their objects.

``dataset.toml`` names for each recording the interaction, object, participant, handedness and
frame rate; ``recordings/*.mcap`` hold the same messages that the wire carries, ``label/…``
included; ``objects/NAME/`` holds mesh and marked vertices.
"""

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import msgspec
from inhand_runtime.errors import InhandError
from inhand_schemas.fields import Name
from inhand_tracker.shape.shape import ObjectShape, load_shape

FORMAT = "inhand-dataset"
VERSION = 1
CAMERA = "camera"
"""Name of the only camera of a dataset that is written here."""
START_NS = 1_000_000_000_000_000_000
"""Time of the first frame of every recording that is written here (9 September 2001)."""


class DatasetError(InhandError):
    """A dataset cannot be used; the message says the mend."""


class DatasetEntry(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One recording of a dataset; ``file`` is relative to the dataset's folder.

    ``frame_rate`` is in Hz; where it is left out the times of the frames show it. ``convention``
    names whose joints the skeletons have, where the recording does not say, or says it wrongly.
    ``cameras`` are those of a rig that took one performance; whoever reads one takes the first.
    """

    file: str
    interaction: str
    participant: str
    object: str | None = None
    handedness: Literal["left", "right"] = "right"
    frame_rate: float | None = None
    convention: Name | None = None
    cameras: tuple[Name, ...] | None = None

    @property
    def camera(self) -> str | None:
        """The camera that readers of one take; None where the recording has one alone."""
        return self.cameras[0] if self.cameras else None


class DatasetFile(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    format: str
    version: int
    generator: dict[str, str | int | float | bool] = {}
    recordings: tuple[DatasetEntry, ...]


@dataclass(frozen=True)
class Dataset:
    """A dataset's folder, and the recordings that its ``dataset.toml`` names."""

    folder: Path
    entries: tuple[DatasetEntry, ...]

    def interactions(self) -> tuple[str, ...]:
        """Return every interaction with an object, in the order of first mention."""
        return tuple(dict.fromkeys(e.interaction for e in self.entries if e.object is not None))

    def shape(self, name: str) -> ObjectShape:
        """Load an object's shape; raises InhandError."""
        return load_shape(self.folder / "objects" / name)

    def path(self, entry: DatasetEntry) -> Path:
        """Return the path of a recording's file."""
        return self.folder / entry.file


def load_dataset(folder: Path) -> Dataset:
    """Read ``dataset.toml``; raises DatasetError with the mend."""
    path = folder / "dataset.toml"
    contents = read_dataset_file(path)
    missing = [e.file for e in contents.recordings if not (folder / e.file).is_file()]
    if missing:
        raise DatasetError(f"{path} names {missing[0]!r}, which is not there")
    return Dataset(folder, contents.recordings)


def read_dataset_file(path: Path) -> DatasetFile:
    """Read a ``dataset.toml``, whose recordings need not be there; raises DatasetError."""
    try:
        values = tomllib.loads(path.read_text(encoding="utf-8"))
        contents = msgspec.convert(values, DatasetFile)
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
    return contents
