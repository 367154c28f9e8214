"""Writes a new object into the folder ``objects/NAME/`` of a dataset."""

import shutil
from pathlib import Path

from inhand_runtime.errors import SettingsError
from inhand_schemas.errors import KeyFormatError
from inhand_schemas.keys import require_name
from inhand_tracker.shape.shape import ObjectShape, load_shape, save_shape

from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.training.shape_checks import check_shape


def new_folder(dataset: Path, name: str) -> Path:
    """Return the folder of an object that a dataset does not have yet; nothing is made.

    Raises SettingsError for a name that is no key's, and where the folder holds something.
    """
    try:
        require_name("object", name)
    except KeyFormatError as error:
        raise SettingsError(str(error)) from None
    folder = dataset / "objects" / name
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise SettingsError(
            f"{folder} is there already: choose another name, or move it elsewhere first"
        )
    return folder


def write_object(shape: ObjectShape, folder: Path) -> None:
    """Write a new object's folder, as training reads it, whole or not at all.

    What training would refuse is refused before anything is written. Raises DatasetError.
    """
    check_shape(shape, folder)
    part = folder.with_name(f".{folder.name}.part")
    try:
        if part.exists():  # of a try that was ended in the middle
            shutil.rmtree(part)
        save_shape(shape, part)
        load_shape(part)
        part.rename(folder)
    except OSError as error:
        raise DatasetError(
            f"cannot write {folder}: {error.strerror}; choose another folder"
        ) from None
