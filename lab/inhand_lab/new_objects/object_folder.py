"""Writes a new object into the folder ``objects/NAME/`` of a dataset."""

from pathlib import Path

import numpy as np
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
    """Write a new object's folder, as training reads it; raises DatasetError.

    What training would refuse is refused before anything is written, and what was written is read
    again.
    """
    check_shape(shape, folder)
    try:
        save_shape(shape, folder)
    except OSError as error:
        raise DatasetError(
            f"cannot write {folder}: {error.strerror}; choose another folder"
        ) from None
    if not np.array_equal(load_shape(folder).faces, shape.faces):
        raise DatasetError(f"{folder} was not written whole: try again")
