"""Labels that become a recording beside the original, and its line in ``dataset.toml``."""

import os
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import msgspec
from inhand_lab.datasets.dataset import DatasetEntry, read_dataset_file
from inhand_lab.datasets.new_entry import put_entry
from inhand_lab.labelling.interpolation import interpolate
from inhand_lab.labelling.keyframes import KeyframeFile, LabellingError
from inhand_lab.labelling.labelled_copy import (
    Labels,
    labelled_path,
    require_labels_wanted,
    write_labels,
)
from inhand_lab.labelling.scene import Scene, check_keyframes
from inhand_tracker.shape.shape import Symmetry

from inhand_studio.labelling_page.assistant import Assistance


@dataclass(frozen=True)
class Exported:
    """The copy that was written, the numbers of its frames with a pose and of those without the
    object, and ``notes`` on what has no label."""

    path: Path
    posed: int
    absent: int
    notes: tuple[str, ...]


def export_labels(
    scene: Scene,
    contents: KeyframeFile,
    symmetries: tuple[Symmetry, ...],
    assistance: Assistance | None,
    *,
    replace: bool,
) -> Exported:
    """Write the labelled copy of a recording.

    ``replace`` puts it in place of one that is there, and leaves labels of the object out that the
    recording holds. Raises LabellingError and RecordingError.
    """
    name, output = contents.object, labelled_path(scene.path)
    check_keyframes(scene, contents, name)
    way = interpolate(contents.keyframes, scene.times_ns, scene.joints, symmetries)
    labels = Labels(way.translations, way.rotations, way.absent)
    if assistance is not None:
        labels = assistance.found.labels
    about = {
        "object": name,
        "keyframes": str(len(contents.keyframes)),
        "assisted": "no" if assistance is None else "yes",
    }
    if not replace:
        require_wanted(scene, name, output)
    _put_whole(output, lambda path: write_labels(scene, name, labels, path, about))
    return Exported(output, int(labels.given.sum()), int(labels.absent.sum()), way.notes)


def require_wanted(scene: Scene, name: str, output: Path) -> None:
    """Raise LabellingError where there is a copy already, or labels of the object."""
    if output.exists():
        raise LabellingError(
            f"{output.name} is there already: tick “Replace what is there” to write it anew"
        )
    require_labels_wanted(scene, name, output)


def _put_whole(output: Path, write: Callable[[Path], None]) -> None:
    """Write a file elsewhere first: what is there stays until it is whole, and what is left of one
    that was killed is in nobody's way."""
    with tempfile.TemporaryDirectory(dir=output.parent, prefix=".labelled-") as folder:
        path = Path(folder) / output.name
        write(path)
        path.replace(output)


def proposed_entry(dataset: Path, recording: Path, object_name: str) -> DatasetEntry:
    """Propose what ``dataset.toml`` says of a labelled copy: what it says of it already, or of the
    original, or names that are to be filled in."""
    file = _relative(labelled_path(recording), dataset)
    for named in (file, _relative(recording, dataset)):
        for entry in _entries(dataset):
            if entry.file == named and entry.object in (None, object_name):
                return msgspec.structs.replace(entry, file=file, object=object_name)
    return DatasetEntry(file=file, interaction="", participant="", object=object_name)


def require_named(entry: DatasetEntry) -> None:
    """Raise LabellingError where an entry does not say who does what."""
    for what in ("interaction", "participant"):
        if not getattr(entry, what):
            raise LabellingError(f"the {what} is empty: write what `inhand train` is to know it by")


def write_entry(dataset: Path, recording: Path, entry: DatasetEntry) -> None:
    """Name a labelled copy in ``dataset.toml``, in place of the original; raises DatasetError."""
    put_entry(dataset, entry, (entry.file, _relative(recording, dataset)))


def _entries(dataset: Path) -> tuple[DatasetEntry, ...]:
    path = dataset / "dataset.toml"
    return read_dataset_file(path).recordings if path.exists() else ()


def _relative(path: Path, dataset: Path) -> str:
    return os.path.relpath(path.absolute(), dataset.absolute())
