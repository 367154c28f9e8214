"""Reads JSON of other programs, with the numbers NaN and Infinity that some write in it."""

import json
from pathlib import Path
from typing import Any, TypeVar

import msgspec

from inhand_lab.datasets.dataset import DatasetError

Kind = TypeVar("Kind")


def read_json(path: Path) -> Any:
    """Read a JSON file; raises DatasetError for one that is cut off, or is none."""
    try:
        return json.loads(path.read_bytes())
    except OSError as error:
        raise DatasetError(f"cannot read {path}: {error.strerror}") from None
    except (ValueError, RecursionError) as error:
        raise DatasetError(f"{path} is cut off, or is no JSON: {error}") from None


def converted(path: Path, value: Any, kind: type[Kind], program: str) -> Kind:
    """Return what was read of a file as ``kind``; raises DatasetError where it is not so.

    ``program`` names in the error who writes such files.
    """
    try:
        return msgspec.convert(value, kind)
    except msgspec.ValidationError as error:
        raise DatasetError(f"{path} is not as {program} writes it: {error}") from None
