"""Finds the files that an import reads, and passes over those that are damaged or show nobody."""

import logging
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Generic, TypeVar

import numpy as np
from inhand_runtime.wording import counted
from inhand_schemas.joints import Joint
from inhand_tracker.geometry.arrays import Array

from inhand_lab.datasets.dataset import DatasetError

log = logging.getLogger(__name__)
Recording = TypeVar("Recording")


class NobodyError(DatasetError):
    """A file shows nobody in any frame."""


@dataclass(frozen=True)
class ReadFiles(Generic[Recording]):
    """What was read of an import's files, and how many of them were named and left out."""

    recordings: list[Recording]
    left_out: int

    def report(self) -> None:
        """Say in a last warning how many files were left out, if any."""
        if self.left_out:
            log.warning(
                "left out: %s of %s, each named above with the reason",
                self.left_out,
                counted(self.left_out + len(self.recordings), "file"),
            )


def without_zeros(joints: Array, origin: int = Joint.HIP_CENTER) -> Array:
    """Take joints (T, J, 3) that are exactly at zero as missing, NaN: trackers write so of what
    they do not see, a joint or a whole body.

    Joints that are given relative to the hips, the joint ``origin``, have that alone at zero, in
    every frame; it stays.
    """
    zero = np.asarray((joints == 0.0).all(axis=2))
    shown = zero[~zero.all(axis=1)]
    if len(shown) and shown[:, origin].all() and (shown.sum(axis=1) == 1).all():
        zero[:, origin] = zero.all(axis=1)
    return np.where(zero[..., None], np.nan, joints)


def read_files(paths: Sequence[Path], read: Callable[[Path], Recording]) -> ReadFiles[Recording]:
    """Read files with ``read``; those that cannot be read, or show nobody, are named in a warning
    and left out.

    Raises DatasetError where that is so of all of them.
    """
    recordings: list[Recording] = []
    errors: list[DatasetError] = []
    for path in paths:
        try:
            recordings.append(read(path))
        except DatasetError as error:
            errors.append(error)
    if errors and not recordings:
        others = f" (so it is with {counted(len(errors) - 1, 'other file')})" if errors[1:] else ""
        raise type(errors[0])(f"{errors[0]}{others}")
    for reason in errors:
        log.warning("%s; it is left out", reason)
    return ReadFiles(recordings, len(errors))


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
