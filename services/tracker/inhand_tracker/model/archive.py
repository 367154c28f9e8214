"""Learned things in one file: a zip of NumPy arrays and a JSON description, with checksums.

Any zip tool and NumPy can open it. Nothing in it is executed.
"""

import contextlib
import json
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from inhand_tracker.model.model import ModelError

Content = TypeVar("Content")

Arrays = dict[str, Any]
"""The arrays of a file by name, of any types."""


@dataclass(frozen=True)
class ArchiveKind:
    """How files of one kind are recognised, and what messages about them say.

    The description is the entry ``entry`` of the zip; it holds ``format`` and ``version``.
    """

    entry: str
    format: str
    version: int
    noun: str
    """Name of the thing in a file, as in "PATH is no NOUN"."""
    version_nouns: tuple[str, str]
    """Names of a version that this release cannot read, and of that which it reads, as in "PATH is
    NOUN 7, and this release reads NOUN 6"."""
    make: str
    """What to do without a file of this kind."""
    make_again: str
    """What to do with a damaged one that cannot be copied again."""


def write_archive(
    kind: ArchiveKind, path: Path | str, description: dict[str, Any], arrays: Arrays
) -> None:
    """Write a file; an existing one is replaced only when all is written.

    Raises ModelError.
    """
    identity = {"format": kind.format, "version": kind.version}
    path = Path(path)
    entries: Arrays = {kind.entry: np.array(json.dumps(identity | description)), **arrays}
    temporary = path.with_name(path.name + ".part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with temporary.open("wb") as file:
            np.savez(file, **entries)
        temporary.replace(path)
    except OSError as error:
        with contextlib.suppress(OSError):
            temporary.unlink()
        raise ModelError(f"cannot write {path}: {error.strerror}") from None


def read_archive(
    kind: ArchiveKind, path: Path | str, assemble: Callable[[dict[str, Any], Arrays], Content]
) -> Content:
    """Return what ``assemble`` makes of a file's description and arrays.

    Raises ModelError for a missing, foreign, newer or damaged file; a file of which ``assemble``
    can make nothing is a damaged one.
    """
    path = Path(path)
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as archive:
            if kind.entry not in archive:
                raise ModelError(f"{path} is no {kind.noun}: {kind.make}")
            description = json.loads(str(archive[kind.entry]))
            _check(kind, description, path)
            arrays = {name: archive[name] for name in archive.files}
        return assemble(description, arrays)
    except ModelError:
        raise
    except OSError as error:
        raise ModelError(f"cannot read {path}: {error.strerror or error}") from None
    except Exception as error:  # noqa: BLE001 - a reader of damaged files may raise anything
        if not zipfile.is_zipfile(path) and not _starts_like_zip(path):
            raise ModelError(f"{path} is no {kind.noun}: {kind.make}") from None
        raise ModelError(
            f"{path} is damaged ({error}): copy it again, or {kind.make_again}"
        ) from None


def _check(kind: ArchiveKind, description: Any, path: Path) -> None:
    if not isinstance(description, dict) or description.get("format") != kind.format:
        raise ModelError(f"{path} is no {kind.noun}: {kind.make}")
    if description["version"] != kind.version:
        other, own = kind.version_nouns
        raise ModelError(
            f"{path} is {other} {description['version']}, and this release reads "
            f"{own} {kind.version}: update Inhand, or train again"
        )


def _starts_like_zip(path: Path) -> bool:
    with path.open("rb") as file:
        return file.read(2) == b"PK"
