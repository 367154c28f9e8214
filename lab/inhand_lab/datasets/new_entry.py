"""Adds a recording to ``dataset.toml``, which keeps all that a person wrote there."""

import contextlib
import fcntl
import os
import tomllib
from collections.abc import Iterator
from pathlib import Path

from inhand_runtime.recording.part_file import PART_SUFFIX, PartFile

from inhand_lab.datasets.dataset import FORMAT, VERSION, DatasetEntry, DatasetError, load_dataset
from inhand_lab.datasets.dataset_writer import entry_toml

FILE = "dataset.toml"


def add_entry(folder: Path, entry: DatasetEntry) -> None:
    """Add an entry at the end of a dataset's file, or begin one; whole, or not at all.

    Of several processes that add at once one waits for the other. Raises DatasetError.
    """
    path = folder / FILE
    lines = "\n".join(entry_toml(entry))
    try:
        with _alone(folder):
            text = path.read_text(encoding="utf-8") if path.exists() else _beginning()
            grown = f"{text.rstrip()}\n\n{lines}\n"
            _require_toml(path, grown, lines)
            _replace(path, grown)
            load_dataset(folder)
    except OSError as error:
        raise DatasetError(
            f"cannot write {path}: {error.strerror}; make room and add there:\n{lines}"
        ) from None


@contextlib.contextmanager
def _alone(folder: Path) -> Iterator[None]:
    """Keep other processes from adding meanwhile; the lock goes with the process."""
    descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    finally:
        os.close(descriptor)


def _beginning() -> str:
    return f'format = "{FORMAT}"\nversion = {VERSION}\n\n[generator]\nname = "inhand record"\n'


def _require_toml(path: Path, text: str, lines: str) -> None:
    try:
        tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise DatasetError(
            f"{path} takes no entry at its end ({error}): write its recordings as [[recordings]], "
            f"and add there:\n{lines}"
        ) from None


def _replace(path: Path, text: str) -> None:
    """Write a file beside, and give it the name when it is whole."""
    part = path.with_name(path.name + PART_SUFFIX)
    part.unlink(missing_ok=True)  # of a process that died; nobody else writes now
    try:
        file = PartFile(path)
        try:
            file.write(text.encode())
            file.publish()
        finally:
            file.close()
    except OSError:
        with contextlib.suppress(OSError):  # then a file stays that nobody reads
            part.unlink(missing_ok=True)
        raise
