"""The files that an import reads."""

from collections.abc import Iterable
from pathlib import Path

from inhand_lab.datasets.dataset import DatasetError


def find_files(sources: Iterable[Path], suffix: str) -> list[Path]:
    """The sources themselves, or the files of such a name in those that are folders.

    Raises DatasetError for one that is missing or has another name, for a folder without any, and
    for two files of the same name, which would be the same recording.
    """
    found: dict[str, Path] = {}
    for source in sources:
        for path in _files_of(source, suffix):
            if found.setdefault(path.name, path) != path:
                raise DatasetError(
                    f"{found[path.name]} and {path} would be the same recording: rename one"
                )
    return list(found.values())


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
