"""Finds the files that an import reads."""

from collections.abc import Iterable
from pathlib import Path

from inhand_lab.datasets.dataset import DatasetError


def find_files(sources: Iterable[Path], suffix: str) -> list[Path]:
    """Return the sources, and for a folder its files with that suffix.

    Raises DatasetError for one that is missing or has another name, for a folder without any, and
    for two files of the same name, which would be the same recording.
    """
    paths_by_name: dict[str, Path] = {}
    for source in sources:
        for path in _files_of(source, suffix):
            if paths_by_name.setdefault(path.name, path) != path:
                raise DatasetError(
                    f"{paths_by_name[path.name]} and {path} would be the same recording: rename one"
                )
    return list(paths_by_name.values())


def _files_of(source: Path, suffix: str) -> list[Path]:
    if source.is_dir():
        files = sorted(source.glob(f"*{suffix}"))
        if not files:
            raise DatasetError(f"{source} holds no *{suffix}: name the folder that does")
        return files
    if not source.is_file():
        raise DatasetError(f"{source} does not exist: check the path")
    if not source.name.endswith(suffix):
        raise DatasetError(f"{source} is not read by this import: name *{suffix} files")
    return [source]
