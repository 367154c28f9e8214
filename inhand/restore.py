"""``inhand restore``: put back what `inhand backup` kept, whole or not at all.

Restore backups of your own only: files go where the settings in the backup say.
"""

import argparse
import sys
from pathlib import Path

from inhand_runtime.errors import InhandError, SettingsError
from inhand_runtime.exit_codes import DONE
from inhand_runtime.settings_file import values_in
from inhand_runtime.wording import counted

from inhand.backup_file import SETTINGS, Manifest, contents, path_of, read_manifest
from inhand.database_copies import require_unused
from inhand.placement import Placement
from inhand.site_files import NOTHING, SiteFiles, plain, site_files

MOST_NAMED = 3
"""Number of files that are in the way and are named; others are counted."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    parser.add_argument("source", type=Path, metavar="FILE", help="what `inhand backup` wrote")
    parser.add_argument(
        "--to",
        dest="folder",
        type=Path,
        metavar="FOLDER",
        help="the folder of the settings, and of what stood below it (default: where it was)",
    )
    parser.add_argument(
        "--overwrite", action="store_true", help="take the place of files that are there already"
    )


def run(arguments: argparse.Namespace) -> int:
    """Put everything back; raises InhandError or SettingsError, and then nothing has changed."""
    manifest = read_manifest(arguments.source)
    folder = plain(Path(manifest.folder) if arguments.folder is None else arguments.folder)
    site = _named(arguments.source, manifest, folder)
    _require_fitting(manifest, site, folder)
    places = {one.place: path_of(one.place, folder) for one in manifest.files}
    for path in sorted(site.databases & set(places.values())):
        require_unused(path)
    _require_free(places, overwrite=arguments.overwrite)
    try:
        with Placement() as placement:
            for one in manifest.folders:
                placement.make_folder(path_of(one.place, folder), one)
            for file, content in contents(arguments.source):
                placement.stage(places[file.place], content, file)
            placement.commit()
    except OSError as error:
        raise InhandError(
            f"cannot write {error.filename}: {error.strerror}; nothing was changed"
        ) from None
    for path in places.values():
        print(f"  {path}")
    print(f"restored {counted(len(places), 'file')} of {manifest.made_at}")
    for name in sorted(placement.unknown):
        print(f"nobody is called {name} here: such files are root's now", file=sys.stderr)
    for name in manifest.configs:
        print(f"Look at it before you start it: inhand doctor --config {folder / name}")
    return DONE


def _named(path: Path, manifest: Manifest, folder: Path) -> SiteFiles:
    """What the settings in a backup name, when they stand in a folder; all of it is checked."""
    site = NOTHING
    configs = {f"{SETTINGS}/{name}": folder / name for name in manifest.configs}
    for file, content in contents(path):
        if config := configs.pop(file.place, None):
            site |= site_files(values_in(content.read(), config), config)
    if configs:
        raise InhandError(f"{path} is damaged: {', '.join(configs)} is missing")
    return site


def _require_fitting(manifest: Manifest, site: SiteFiles, folder: Path) -> None:
    """Refuse settings that name what would not be there, and what settings do not name."""
    places = {path_of(one.place, folder) for one in manifest.files}
    if missing := sorted(str(path) for path in site.files - places):
        raise SettingsError(
            f"the settings name {missing[0]}, where nothing would be: restore it without --to, to "
            f"{manifest.folder}"
        )
    strange = [path for path in places if not site.has(path)]
    folders = (path_of(one.place, folder) for one in manifest.folders)
    strange += [path for path in folders if not site.has_folder(path)]
    if strange:
        raise InhandError(
            f"refused: {min(strange)} is in the backup, and its settings name no such file"
        )


def _require_free(places: dict[str, Path], *, overwrite: bool) -> None:
    """Refuse to write over anything, unless that was said; over a folder nothing is written."""
    if folders := [str(path) for path in places.values() if path.is_dir()]:
        raise InhandError(f"{folders[0]} is a folder, and a file in the backup: move it away")
    if overwrite:
        return
    there = [str(path) for path in places.values() if path.is_symlink() or path.exists()]
    if there:
        more = f" and {counted(len(there) - MOST_NAMED, 'more file')}" * (len(there) > MOST_NAMED)
        raise InhandError(
            f"{', '.join(there[:MOST_NAMED])}{more} would be written over: move them away, or say "
            "--overwrite; nothing was changed"
        )
