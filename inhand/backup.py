"""``inhand backup``: put a site's settings, models, objects, certificates and what is kept of
outcomes into one file.

Recordings are not in it. Private keys are: keep the file as you keep them.
"""

import argparse
import contextlib
import grp
import hashlib
import pwd
import stat
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

import msgspec
from inhand_runtime.errors import InhandError, SettingsError
from inhand_runtime.exit_codes import DONE
from inhand_runtime.locked_folder import locked_folder
from inhand_runtime.settings import load_rig_file
from inhand_runtime.settings_file import read_values
from inhand_runtime.wording import counted

from inhand.backup_file import (
    PIECE_BYTES,
    Stored,
    StoredFile,
    new_manifest,
    path_of,
    place_of,
    write_backup,
)
from inhand.database_copies import copied_databases
from inhand.site_files import NOTHING, SiteFiles, plain, site_files


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    parser.add_argument("output", type=Path, metavar="FILE", help="the backup, such as site.tar.gz")
    parser.add_argument(
        "--config",
        type=Path,
        action="append",
        required=True,
        metavar="FILE",
        help="settings (TOML) of the site on this host; again for each further file",
    )


def run(arguments: argparse.Namespace) -> int:
    """Write the backup, whole or not at all; raises SettingsError or InhandError."""
    configs = [plain(config) for config in arguments.config]
    folder = configs[0].parent
    if any(config.parent != folder for config in configs):
        raise SettingsError("settings of one backup stand in one folder: make one for each folder")
    site = NOTHING
    for config in configs:
        load_rig_file(config)
        site |= site_files(read_values(config), config)
    try:
        with contextlib.ExitStack() as locks:
            for administered in site.administered():
                locks.enter_context(locked_folder(administered))
            beside = arguments.output.absolute().parent
            copies = locks.enter_context(copied_databases(site.databases, beside))
            files, folders = _listed(site, folder, copies)
            names = [config.name for config in configs]
            manifest = new_manifest(folder, names, files, folders)

            def source_of(place: str) -> Path:
                path = path_of(place, folder)
                return copies.get(path, path)

            write_backup(arguments.output, manifest, source_of)
    except OSError as error:
        raise InhandError(f"cannot read {error.filename}: {error.strerror}") from None
    size = sum(one.size for one in files)
    print(f"wrote {arguments.output}: {counted(len(files), 'file')}, {size / 1e6:,.1f} MB")
    for one in files:
        print(f"  {one.place}")
    for path in sorted(site.given):
        print(f"NOT in it: {path}, which systemd gives: keep /etc/credstore besides")
    for address in sorted(site.served):
        print(f"NOT in it: {address}: have its server back it up")
    print("Recordings are not in it. Private keys may be: only you can read it; keep it so.")
    return DONE


def _listed(
    site: SiteFiles, folder: Path, copies: Mapping[Path, Path]
) -> tuple[list[StoredFile], list[Stored]]:
    """What is to be stored, by place, of databases the copies; raises SettingsError for what
    settings name in vain."""
    if missing := sorted(str(path) for path in site.files if not path.is_file()):
        raise SettingsError(
            f"{missing[0]}, which the settings name, is no file: a backup without it would not "
            "start; make it, or take it out of the settings"
        )
    files, folders = {*site.files, *copies}, site.administered()
    for top in site.folders:
        for path in _below(top):
            (folders if path.is_dir() else files).add(path)
    return (
        [_stored_file(path, folder, copies.get(path, path)) for path in sorted(files)],
        [_stored(path, folder) for path in sorted(folders)],
    )


def _below(top: Path) -> Iterator[Path]:
    """A folder, all in it and what is in those; other kinds of files are passed over."""
    if top.is_dir():
        yield top
        for path in top.rglob("*"):
            if not path.is_symlink() and (path.is_dir() or path.is_file()):
                yield path


def _stored(path: Path, folder: Path) -> Stored:
    status = path.stat()
    return Stored(
        place=place_of(path, folder),
        mode=stat.S_IMODE(status.st_mode),
        owner=_name(status.st_uid, lambda number: pwd.getpwuid(number).pw_name),
        group=_name(status.st_gid, lambda number: grp.getgrgid(number).gr_name),
    )


def _stored_file(path: Path, folder: Path, source: Path) -> StoredFile:
    size, summed = 0, hashlib.sha256()
    with source.open("rb") as file:
        while data := file.read(PIECE_BYTES):
            size += len(data)
            summed.update(data)
    stored = msgspec.structs.asdict(_stored(path, folder))
    return StoredFile(**stored, size=size, sha256=summed.hexdigest())


def _name(number: int, look_up: Callable[[int], str]) -> str:
    """The name of a user or group, or its number where it has none."""
    try:
        return look_up(number)
    except KeyError:
        return str(number)
