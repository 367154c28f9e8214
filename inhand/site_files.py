"""The files without which a site cannot start again: which they are, by its settings."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from inhand_hub.settings import HubSettings
from inhand_runtime.errors import SettingsError
from inhand_runtime.settings import SERVICES, RigFile, Section, is_credential
from inhand_runtime.settings_errors import explain
from pydantic import ValidationError

from inhand.service_models import settings_model

ADMINISTERED = ("authority", "members", "hubs")
"""What the folder of a site has beside the hub's folder, where it is administered."""


@dataclass(frozen=True)
class SiteFiles:
    """Absolute places of single files, and of folders with all that is in them; keys and passwords
    that systemd gives, as they are named; databases, which may not be there yet, and the addresses
    of those that a server has."""

    files: frozenset[Path] = frozenset()
    folders: frozenset[Path] = frozenset()
    given: frozenset[Path] = frozenset()
    databases: frozenset[Path] = frozenset()
    served: frozenset[str] = frozenset()

    def __or__(self, other: "SiteFiles") -> "SiteFiles":
        return SiteFiles(
            self.files | other.files,
            self.folders | other.folders,
            self.given | other.given,
            self.databases | other.databases,
            self.served | other.served,
        )

    def has(self, path: Path) -> bool:
        """Whether a file is one of these."""
        alone = path in self.files or path in self.databases
        return alone or any(path.is_relative_to(one) for one in self.folders)

    def has_folder(self, path: Path) -> bool:
        """Whether a folder is one of these, or in or above one."""
        return any(path.is_relative_to(one) or one.is_relative_to(path) for one in self.folders)

    def administered(self) -> set[Path]:
        """Return the folders of sites that are administered here."""
        return {one.parent for one in self.folders if one.name == ADMINISTERED[0] and one.is_dir()}


NOTHING = SiteFiles()


def site_files(values: Mapping[str, Any], config: Path) -> SiteFiles:
    """Return what a settings file's values name, where it stands at ``config``; SettingsError.

    The environment has no say: what is restored must fit the file alone.
    """
    config = plain(config)
    rig_file = _checked(values, RigFile, config, ())
    zenoh = rig_file.zenoh
    named: list[Path | None] = [config, zenoh.certificate, zenoh.key, zenoh.authority]
    named.append(zenoh.password)
    folders: list[Path] = []
    databases: set[Path] = set()
    served: set[str] = set()
    for service in SERVICES:
        for name, table in getattr(rig_file, service).items():
            settings = _checked(table, settings_model(service), config, (service, name))
            named += _files(settings)
            folders += _folders(settings)
            if service == "outcomes" and settings.database_file is None:
                served.add(settings.database)
            elif service == "outcomes":
                databases.add(plain(settings.database_file))
    given = {one for one in named if one is not None and is_credential(one)}
    files = {plain(one) for one in named if one is not None and one not in given}
    return SiteFiles(
        frozenset(files),
        frozenset(map(plain, folders)),
        frozenset(given),
        frozenset(databases),
        frozenset(served),
    )


def plain(path: Path) -> Path:
    """Return a path as absolute, without ``..`` in it; links stay as they are."""
    parts: list[str] = []
    for part in path.absolute().parts[1:]:
        parts = parts[:-1] if part == ".." else [*parts, part]
    return Path("/", *parts)


_FILES = (
    "model",
    "recogniser",
    "network",
    "password_file",
    "certificate",
    "private_key",
    "key",
    "authority",
)
"""Settings of services, and of parts of them, that name a file, where they are no words."""


def _files(settings: Section) -> Iterator[Path | None]:
    values: dict[str, Any] = dict(settings)
    for name in _FILES:
        if isinstance(value := values.get(name), Path):
            yield value
    yield from values.get("models", ())
    for part in values.values():
        if isinstance(part, Section):
            yield from _files(part)


def _folders(settings: Section) -> Iterator[Path]:
    if isinstance(settings, HubSettings):
        yield settings.folder
        # Who administers the site on the hub's host has these beside.
        yield from (settings.folder.parent / name for name in ADMINISTERED)
    elif isinstance(dataset := dict(settings).get("dataset"), Path):
        yield dataset / "objects"


def _checked(
    values: Mapping[str, Any], model: type[Any], config: Path, location: tuple[str, ...]
) -> Any:
    try:
        return model.model_validate(dict(values), context={"folder": config.parent})
    except ValidationError as error:
        where = config if config.exists() else None
        raise SettingsError(explain(error, where, location, model)) from None
