"""Puts files below the root of a system, and takes away exactly what it put there."""

import hashlib
import json
import os
from collections.abc import Iterable, Mapping
from pathlib import Path, PurePosixPath
from typing import Any

from inhand_runtime.errors import InhandError

RECORD = "etc/inhand/installed.json"
"""Where it is noted what was put there: the sum of each file, and the folders that were made."""


class Installation:
    """What is installed below a root folder; raises InhandError for what cannot be done."""

    def __init__(self, root: Path) -> None:
        self._root = root
        self._sums, self._folders = self._recorded()

    def install(self, files: Mapping[str, str]) -> list[str]:
        """Put files there, and take away former ones of ours; returns the places that changed.

        Nothing is changed where a file is somebody else's, or was changed since it was put there.
        """
        if foreign := [place for place in files if self._is_foreign(place, files[place])]:
            raise InhandError(
                f"{', '.join(map(self._shown, foreign))} was not put there as it is by `inhand "
                "install`: move it away; nothing was changed"
            )
        changed = [place for place, text in files.items() if self._read(place) != text.encode()]
        former = self._take_away(place for place in self._sums if place not in files)
        for place in changed:
            self._write(place, files[place])
        self._sums = {place: _sum(text.encode()) for place, text in files.items()}
        self._write_record()
        return [*changed, *former]

    def uninstall(self) -> tuple[list[str], list[str]]:
        """Take everything away; returns the places that were removed, and those that were left
        since somebody changed them."""
        removed = self._take_away(self._sums)
        kept = [place for place in self._sums if (self._root / place).exists()]
        (self._root / RECORD).unlink(missing_ok=True)
        for folder in sorted(self._folders, key=len, reverse=True):
            if (path := self._root / folder).is_dir() and not any(path.iterdir()):
                path.rmdir()
        return removed, kept

    def _take_away(self, places: Iterable[str]) -> list[str]:
        removed = []
        for place in places:
            data = self._read(place)
            if data is not None and _sum(data) == self._sums[place]:
                (self._root / place).unlink()
                removed.append(place)
        return removed

    def _is_foreign(self, place: str, text: str) -> bool:
        data = self._read(place)
        return data not in (None, text.encode()) and _sum(data or b"") != self._sums.get(place)

    def _read(self, place: str) -> bytes | None:
        try:
            return (self._root / place).read_bytes()
        except FileNotFoundError:
            return None

    def _write(self, place: str, text: str) -> None:
        """Write a file as a whole, or not at all."""
        path = self._root / place
        self._make_folder(path.parent)
        part = path.with_name(f".{path.name}.part")
        part.write_text(text, encoding="utf-8")
        part.chmod(0o644)
        os.replace(part, path)

    def _make_folder(self, folder: Path) -> None:
        missing = [one for one in (folder, *folder.parents) if not one.exists()]
        for one in reversed(missing):
            one.mkdir(mode=0o755)
            if one != self._root and one.is_relative_to(self._root):
                self._folders.append(one.relative_to(self._root).as_posix())

    def _write_record(self) -> None:
        self._make_folder((self._root / RECORD).parent)
        record = {"files": self._sums, "folders": self._folders}
        self._write(RECORD, json.dumps(record, indent=1) + "\n")

    def _recorded(self) -> tuple[dict[str, str], list[str]]:
        data = self._read(RECORD)
        if data is None:
            return {}, []
        try:
            record: dict[str, Any] = json.loads(data)
            sums, folders = dict(record["files"]), list(record["folders"])
            if not all(map(_is_below, (*sums, *folders))):
                raise ValueError("a place outside")
        except (ValueError, KeyError, TypeError):
            raise InhandError(
                f"{self._shown(RECORD)} cannot be read: remove it, and the files that `inhand "
                "install --print` lists"
            ) from None
        return sums, folders

    def _shown(self, place: str) -> str:
        return str(self._root / place)


def _is_below(place: object) -> bool:
    path = PurePosixPath(str(place))
    return not path.is_absolute() and ".." not in path.parts


def _sum(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()
