"""Finds the files that an import reads, and passes over those that show nobody."""

import logging
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TypeVar

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.datasets.dataset import DatasetError

log = logging.getLogger(__name__)
Recording = TypeVar("Recording")


class NobodyError(DatasetError):
    """A file shows nobody in any frame."""


def without_zeros(joints: Array) -> Array:
    """Take skeletons (T, 20, 3) that are all zero as missing, NaN: trackers write so of nobody."""
    nobody = (joints == 0.0).all(axis=(1, 2), keepdims=True)
    return np.where(nobody, np.nan, joints)


def read_shown(paths: Iterable[Path], read: Callable[[Path], Recording]) -> list[Recording]:
    """Read files with ``read``; those that show nobody are named in a warning and left out.

    Raises DatasetError where all of them show nobody, and whatever else ``read`` raises.
    """
    recordings: list[Recording] = []
    errors: list[NobodyError] = []
    for path in paths:
        try:
            recordings.append(read(path))
        except NobodyError as error:
            errors.append(error)
    if errors and not recordings:
        raise errors[0]
    for nobody in errors:
        log.warning("%s; it is left out", nobody)
    return recordings


def find_files(sources: Iterable[Path], *suffixes: str) -> list[Path]:
    """Return the sources, and for a folder its files with one of the suffixes.

    Raises DatasetError for one that is missing or has another name, for a folder without any, and
    for two files of the same name, which would be the same recording.
    """
    paths_by_stem: dict[str, Path] = {}
    for source in sources:
        for path in _files_of(source, suffixes):
            if paths_by_stem.setdefault(path.stem, path) != path:
                raise DatasetError(
                    f"{paths_by_stem[path.stem]} and {path} would be the same recording: rename one"
                )
    return list(paths_by_stem.values())


def _files_of(source: Path, suffixes: tuple[str, ...]) -> list[Path]:
    wanted = " or ".join(f"*{suffix}" for suffix in suffixes)
    if source.is_dir():
        files = sorted(path for path in source.iterdir() if path.name.endswith(suffixes))
        if not files:
            raise DatasetError(f"{source} holds no {wanted}: name the folder that does")
        return files
    if not source.is_file():
        raise DatasetError(f"{source} does not exist: check the path")
    if not source.name.endswith(suffixes):
        raise DatasetError(f"{source} is not read by this import: name {wanted} files")
    return [source]
