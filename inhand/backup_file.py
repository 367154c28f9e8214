"""The file of a backup: what it holds, with checksums, and how it is written and read.

It is a tar archive, compressed by gzip, that begins with ``manifest.json``; what it lists follows
in its order. Nothing else is taken for a backup.
"""

import gzip
import hashlib
import io
import tarfile
import time
import zlib
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from importlib.metadata import version
from pathlib import Path, PurePosixPath
from typing import IO

import msgspec
from inhand_runtime.errors import InhandError
from inhand_runtime.private_file import PRIVATE_FILE, new_private_file
from inhand_schemas.fields import Count
from msgspec import Struct

FORMAT = 1
MANIFEST = "manifest.json"
LARGEST_MANIFEST = 64 << 20
PIECE_BYTES = 1 << 20
SETTINGS, ELSEWHERE = "settings", "elsewhere"
"""Where in the archive: what stood in the folder of the settings, and what stood outside of it."""


class Stored(Struct, frozen=True, kw_only=True):
    """A file or a folder: its place in the archive, who may do what with it, and whose it is."""

    place: str
    mode: Count
    owner: str
    group: str


class StoredFile(Stored, frozen=True, kw_only=True):
    """A file, and what its content must be."""

    size: Count
    sha256: str


class Manifest(Struct, frozen=True, kw_only=True):
    """What a backup holds; ``folder`` is where its settings stood, ``configs`` are their names."""

    inhand_backup: Count
    inhand: str
    made_at: str
    folder: str
    configs: tuple[str, ...]
    files: tuple[StoredFile, ...]
    folders: tuple[Stored, ...] = ()


def place_of(path: Path, folder: Path) -> str:
    """Return the place in the archive of a file of a site whose settings stand in a folder."""
    if path.is_relative_to(folder):
        return f"{SETTINGS}/{path.relative_to(folder).as_posix()}"
    return f"{ELSEWHERE}/{path.relative_to('/').as_posix()}"


def path_of(place: str, folder: Path) -> Path:
    """Return where a place of the archive is, or goes, when settings stand in that folder."""
    kind, _, rest = place.partition("/")
    return folder / rest if kind == SETTINGS else Path("/", rest)


def new_manifest(
    folder: Path,
    configs: Sequence[str],
    files: Sequence[StoredFile],
    folders: Sequence[Stored],
) -> Manifest:
    """Return the manifest of a backup that is made now."""
    return Manifest(
        inhand_backup=FORMAT,
        inhand=version("inhand"),
        made_at=time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime()),
        folder=str(folder),
        configs=tuple(configs),
        files=tuple(files),
        folders=tuple(folders),
    )


def write_backup(path: Path, manifest: Manifest, source_of: Callable[[str], Path]) -> None:
    """Write a backup whole or not at all, for its owner alone; raises InhandError.

    ``source_of`` says where a place of the archive is now; a file that changes while it is copied
    is none that can be restored, and refused.
    """
    try:
        with new_private_file(path) as file:
            with tarfile.open(fileobj=file, mode="w:gz") as archive:
                data = msgspec.json.format(msgspec.json.encode(manifest))
                archive.addfile(_entry(MANIFEST, len(data)), io.BytesIO(data))
                for one in manifest.files:
                    with source_of(one.place).open("rb") as source:
                        archive.addfile(_entry(one.place, one.size), source)
            file.flush()
            _require_whole(Path(file.name))
    except OSError as error:
        raise InhandError(
            f"cannot write {path}: {error.strerror or error}; nothing was written"
        ) from None


def _require_whole(path: Path) -> None:
    try:
        for _ in contents(path):
            pass
    except InhandError:
        raise InhandError(
            "a file changed while it was copied: nothing was written; try again"
        ) from None


def read_manifest(path: Path) -> Manifest:
    """Read what a backup holds; raises InhandError for a file that is none, or is damaged."""
    with _opened(path) as (archive, _):
        return _manifest(archive, path)


def contents(path: Path) -> Iterator[tuple[StoredFile, "Content"]]:
    """Yield each file of a backup, to be read or passed over; raises InhandError.

    Each is checked when the next one is asked for: by its place, its size and its sum.
    """
    with _opened(path) as (archive, stream):
        manifest = _manifest(archive, path)
        for one in manifest.files:
            entry = archive.next()
            if (
                entry is None
                or not entry.isreg()
                or (entry.name, entry.size)
                != (
                    one.place,
                    one.size,
                )
            ):
                raise _damaged(path, f"{one.place} is not there as its list says")
            file = archive.extractfile(entry)
            assert file is not None
            content = Content(file)
            yield one, content
            while content.read(PIECE_BYTES):
                pass
            if content.sum() != one.sha256:
                raise _damaged(path, f"{one.place} is not what it was")
        if archive.next() is not None:
            raise _damaged(path, "it holds more than its list says")
        while stream.read(PIECE_BYTES):  # to its end, where its own sum stands
            pass


class Content:
    """A stream of which the sum is taken as it is read."""

    def __init__(self, stream: IO[bytes]) -> None:
        self._stream = stream
        self._hash = hashlib.sha256()

    def read(self, size: int = -1) -> bytes:
        """Read on."""
        data = self._stream.read(size)
        self._hash.update(data)
        return data

    def sum(self) -> str:
        """Return the sum of what was read so far."""
        return self._hash.hexdigest()


@contextmanager
def _opened(path: Path) -> Iterator[tuple[tarfile.TarFile, gzip.GzipFile]]:
    try:
        with (
            gzip.open(path) as stream,
            tarfile.open(fileobj=stream, mode="r|") as archive,
        ):
            yield archive, stream
    except (tarfile.TarError, EOFError, zlib.error, UnicodeDecodeError) as error:
        raise _damaged(path, str(error) or "it ends early") from None
    except OSError as error:
        if error.filename is None:  # gzip's own: what it reads is no gzip, or its sum is wrong
            raise _damaged(path, str(error)) from None
        raise InhandError(f"cannot read {error.filename}: {error.strerror}") from None


def _manifest(archive: tarfile.TarFile, path: Path) -> Manifest:
    entry = archive.next()
    if entry is None or entry.name != MANIFEST or not entry.isreg():
        raise InhandError(f"{path} is no backup that `inhand backup` made")
    file = archive.extractfile(entry)
    if entry.size > LARGEST_MANIFEST or file is None:
        raise _damaged(path, "its list is too large")
    try:
        manifest = msgspec.json.decode(file.read(), type=Manifest)
    except msgspec.MsgspecError as error:
        raise _damaged(path, f"its list cannot be read: {error}") from None
    if manifest.inhand_backup != FORMAT:
        raise InhandError(
            f"{path} was made by Inhand {manifest.inhand}, and is of a kind that this release does "
            "not know: update Inhand"
        )
    places = [one.place for one in (*manifest.files, *manifest.folders)]
    for place in (*places, *(f"{SETTINGS}/{name}" for name in manifest.configs)):
        _require_plain(place, path)
    if len(set(places)) < len(places) or not PurePosixPath(manifest.folder).is_absolute():
        raise _damaged(path, "its list contradicts itself")
    return manifest


def _require_plain(place: str, path: Path) -> None:
    """Refuse a place that leads out of where it is to go."""
    parts = place.split("/")
    if (
        len(parts) < 2
        or parts[0] not in (SETTINGS, ELSEWHERE)
        or any(part in ("", ".", "..") or "\0" in part for part in parts)
    ):
        raise InhandError(f"{path} is refused: {place!r} in it leads elsewhere than it should")


def _entry(name: str, size: int) -> tarfile.TarInfo:
    entry = tarfile.TarInfo(name)
    entry.size, entry.mtime, entry.mode = size, int(time.time()), PRIVATE_FILE
    return entry


def _damaged(path: Path, why: str) -> InhandError:
    return InhandError(f"{path} is damaged: {why}; take another copy of it")
