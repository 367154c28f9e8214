"""Adds a recording to ``dataset.toml``, or puts it in place of another; all else there stays."""

import contextlib
import re
import tomllib
from collections.abc import Callable, Collection
from pathlib import Path

from inhand_runtime.locked_folder import locked_folder
from inhand_runtime.recording.part_file import PART_SUFFIX, PartFile

from inhand_lab.datasets.dataset import FORMAT, VERSION, DatasetEntry, DatasetError, load_dataset
from inhand_lab.datasets.dataset_writer import entry_toml

FILE = "dataset.toml"


def add_entry(folder: Path, entry: DatasetEntry) -> None:
    """Add an entry at the end of a dataset's file, or begin one; whole, or not at all.

    Of several processes that add at once one waits for the other. Raises DatasetError.
    """
    put_entry(folder, entry, ())


def put_entry(folder: Path, entry: DatasetEntry, files: Collection[str]) -> None:
    """Write an entry in place of those of the same object, or of none, of some ``files``.

    It comes where the first of these was, else at the end, as ``add_entry`` does.
    """
    path = folder / FILE
    lines = "\n".join(entry_toml(entry))
    try:
        with locked_folder(folder):
            text = path.read_text(encoding="utf-8") if path.exists() else _beginning()
            grown = _put(text, lines, lambda block: _is_of(block, entry, files))
            _require_toml(path, grown, lines)
            _replace(path, grown)
            load_dataset(folder)
    except OSError as error:
        raise DatasetError(
            f"cannot write {path}: {error.strerror}; make room and add there:\n{lines}"
        ) from None


def _put(text: str, lines: str, replaced: Callable[[str], bool]) -> str:
    """Put an entry's lines in place of the tables that are replaced, else at the end."""
    # A table ends where the next one begins; comments before that belong to the next.
    parts = re.split(r"^(?=(?:[ \t]*#.*\n)*[ \t]*\[)", text, flags=re.MULTILINE)
    kept: list[str] = []
    place = None
    for part in parts:
        if not replaced(part):
            kept.append(part)
            continue
        comments = "".join(re.findall(r"^[ \t]*#.*\n", part, flags=re.MULTILINE))
        place = len(kept) if place is None else place
        kept.append(comments)
    if place is None:
        return f"{text.rstrip()}\n\n{lines}\n"
    kept[place] += f"{lines}\n\n"
    return "".join(kept).rstrip() + "\n"


def _is_of(block: str, entry: DatasetEntry, files: Collection[str]) -> bool:
    """Whether a table of the file is of one of some files, and of the entry's object or of none."""
    try:
        tables = tomllib.loads(block).get("recordings")
    except tomllib.TOMLDecodeError:
        return False
    if not isinstance(tables, list) or len(tables) != 1:
        return False
    return tables[0].get("file") in files and tables[0].get("object") in (None, entry.object)


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
