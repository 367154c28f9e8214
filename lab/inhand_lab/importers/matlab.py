"""Reads MATLAB files of other people."""

from pathlib import Path
from typing import Any

import numpy as np
import scipy.io
from numpy.typing import NDArray

from inhand_lab.datasets.dataset import DatasetError


def read_mat(path: Path, *names: str) -> list[NDArray[Any]]:
    """Read the numeric arrays of those names; raises DatasetError."""
    try:
        contents = scipy.io.loadmat(path, appendmat=False, variable_names=names)
    except FileNotFoundError:
        raise DatasetError(f"{path} does not exist: check the path") from None
    except Exception as error:  # noqa: BLE001 - a reader of foreign files may raise anything
        raise DatasetError(f"{path} is no MATLAB file that can be read: {error}") from None
    return [_numbers(path, name, contents.get(name)) for name in names]


def _numbers(path: Path, name: str, value: object) -> NDArray[Any]:
    if not isinstance(value, np.ndarray) or value.dtype.kind not in "fiu":
        raise DatasetError(f"{path} holds no array of numbers {name!r}: is it of this data set?")
    return value
