"""Settings: one TOML file a rig, overridden by the environment, checked before anything starts.

Every daemon reads the same file, and its own table in it: ``[capture.front]`` is the settings of
the capture instance ``front``. Relative paths follow the file's folder.
"""

import os
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, Generic, Literal, Self, TypeVar

from inhand_schemas.errors import KeyFormatError
from inhand_schemas.keys import Site, require_name
from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    ValidationError,
    ValidationInfo,
    model_validator,
)

from inhand_runtime.errors import SettingsError
from inhand_runtime.settings_environment import texts_read, with_environment
from inhand_runtime.settings_errors import explain, place, suggestion
from inhand_runtime.settings_file import read_values

SERVICES = ("capture", "tracker", "recorder", "studio", "outcomes", "hub")

SETTINGS_VERSION = 1
"""Version of the settings' form that this release reads and means where a file names none."""

MEETING = "tcp/127.0.0.1:7447"

_ADDRESS = re.compile(r"[a-z][a-z-]*/[^\s/?#]+:\d+")

Tables = dict[str, dict[str, Any]]


class Section(BaseModel):
    """A table of settings: unknown keys are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True)


def _address(text: str) -> str:
    if not _ADDRESS.fullmatch(text):
        raise ValueError(f"{text!r} is no address; write it as tcp/127.0.0.1:7447")
    return text


Address = Annotated[str, AfterValidator(_address)]


CREDENTIALS_VARIABLE = "CREDENTIALS_DIRECTORY"
"""The variable by which systemd tells a service in which folder it has given it files."""
_CREDENTIALS, _ALL_CREDENTIALS = Path(f"${CREDENTIALS_VARIABLE}"), Path("/run/credentials")


def _beside_the_file(path: Path, info: ValidationInfo) -> Path:
    if path.is_relative_to(_CREDENTIALS):
        # Where no service runs the path stays, and is named as it is when it cannot be read.
        folder = Path(os.environ.get(CREDENTIALS_VARIABLE, _CREDENTIALS))
        return folder / path.relative_to(_CREDENTIALS)
    return info.context["folder"] / path if info.context else path


FilePath = Annotated[Path, AfterValidator(_beside_the_file)]
"""A path of a settings file: a relative one follows the file's folder, and one that begins with
``$CREDENTIALS_DIRECTORY`` is a file that systemd gives the service."""


def is_credential(path: Path) -> bool:
    """Whether a setting's path is a file that systemd gives a service while it runs."""
    given = (_CREDENTIALS, _ALL_CREDENTIALS, os.environ.get(CREDENTIALS_VARIABLE, _CREDENTIALS))
    return any(path.is_relative_to(folder) for folder in given)


@dataclass(frozen=True)
class Credentials:
    """The files (PEM) by which a client and a hub know each other."""

    certificate: Path
    key: Path
    authority: Path


@dataclass(frozen=True)
class Login:
    """By what a client and a hub know each other where the client has no certificate: the client's
    user, the file of its password, and the authority (PEM) of the hub's certificate."""

    user: str
    password: Path
    authority: Path


class ZenohSettings(Section):
    """How to reach the other processes.

    A ``peer`` meets the others at ``meeting``, an address of this machine that the first one
    takes; ``listen`` and ``connect`` add addresses. A ``client`` connects to hubs only, at ``tls``
    addresses with what ``inhand hub add`` made: ``certificate``, ``key`` and ``authority``, or
    ``user``, ``password`` (a file) and ``authority``.
    """

    mode: Literal["peer", "client"] = "peer"
    meeting: Address = MEETING
    listen: tuple[Address, ...] = ()
    connect: tuple[Address, ...] = ()
    certificate: FilePath | None = None
    key: FilePath | None = None
    authority: FilePath | None = None
    user: str | None = None
    password: FilePath | None = None

    @model_validator(mode="after")
    def _fits(self) -> Self:
        files: dict[str, Path | str | None] = {
            "certificate": self.certificate,
            "key": self.key,
            "authority": self.authority,
        }
        if self.user is not None or self.password is not None:
            if self.certificate is not None or self.key is not None:
                raise ValueError("a client shows a certificate or a password: leave one out")
            files = {"user": self.user, "password": self.password, "authority": self.authority}
        names = list(files)
        together = f"{names[0]}, {names[1]} and {names[2]}"
        missing = [name for name, path in files.items() if path is None]
        secured = [address for address in self.connect if address.startswith("tls/")]
        if missing and len(missing) < len(files):
            raise ValueError(f"{together} belong together: {missing[0]} is missing")
        if missing and secured:
            raise ValueError(f"{secured[0]} needs {together}, which `inhand hub add` makes")
        if not missing and (self.mode != "client" or len(secured) < len(self.connect)):
            raise ValueError(
                f'{together} are for mode = "client" and addresses in connect '
                "that begin with tls/: nothing else would be encrypted"
            )
        return self

    @property
    def credentials(self) -> Credentials | None:
        """The files of a client, if it has any."""
        if self.certificate is None or self.key is None or self.authority is None:
            return None
        return Credentials(self.certificate, self.key, self.authority)

    @property
    def joins_hub(self) -> bool:
        """Whether it shows a hub who it is."""
        return self.credentials is not None or self.login is not None

    @property
    def login(self) -> Login | None:
        """The user and password of a client, if it has any."""
        if self.user is None or self.password is None or self.authority is None:
            return None
        return Login(self.user, self.password, self.authority)


class LogSettings(Section):
    """How to log to standard error."""

    format: Literal["console", "json"] = "console"
    level: Literal["debug", "info", "warning", "error"] = "info"


def _known_version(version: int) -> int:
    if version > SETTINGS_VERSION:
        raise ValueError(
            f"these settings are of version {version}, for a later release of Inhand than this "
            f"one, which reads version {SETTINGS_VERSION}: update Inhand"
        )
    return version


class RigFile(Section):
    """The whole file; the tables of a service are checked by that service.

    ``version`` is that of the settings' form, which grows when a file of before would be read
    otherwise than it was meant: a release refuses files of a later version than it knows.
    """

    version: Annotated[int, Field(ge=1), AfterValidator(_known_version)] = SETTINGS_VERSION
    realm: str = "inhand"
    rig: str = "rig"
    zenoh: ZenohSettings = ZenohSettings()
    log: LogSettings = LogSettings()
    capture: Tables = {}
    tracker: Tables = {}
    recorder: Tables = {}
    outcomes: Tables = {}
    studio: Tables = {}
    hub: Tables = {}


S = TypeVar("S", bound=Section)
S_co = TypeVar("S_co", bound=Section, covariant=True)


@dataclass(frozen=True)
class Origin:
    """Where the settings of an instance stand: the file, and the table in it."""

    path: Path | None = None
    table: tuple[str, ...] = ()
    instances: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """Names of the instances of each service in the file."""

    def checked(self, values: Mapping[str, Any], model: type[S], *below: str) -> S:
        """Check a table of the instance, ``below`` its own; raises SettingsError."""
        location = (*self.table, *below)
        context = None if self.path is None else {"folder": self.path.parent}
        try:
            return model.model_validate(texts_read(dict(values), model), context=context)
        except ValidationError as error:
            raise SettingsError(explain(error, self.path, location, model)) from None

    def refusal(self, setting: str, reason: str) -> SettingsError:
        """Make the error for a setting of the instance that cannot work."""
        location = (*self.table, *setting.split("."))
        return SettingsError(f"{place(self.path, location)}setting {'.'.join(location)}: {reason}")


@dataclass(frozen=True)
class Settings(Generic[S_co]):
    """What one instance of a service runs with."""

    site: Site
    zenoh: ZenohSettings
    log: LogSettings
    instance: str
    service: S_co
    origin: Origin = field(default_factory=Origin)


def load_rig_file(path: Path | None) -> RigFile:
    """Read a file, or take the defaults; raises SettingsError naming file, line and mend."""
    return rig_file_of({} if path is None else read_values(path), path)


def rig_file_of(values: Mapping[str, Any], path: Path | None) -> RigFile:
    """Check the values of a file, and the environment's; raises SettingsError as from the file."""
    values = with_environment(values, RigFile)
    try:
        context = None if path is None else {"folder": path.parent}
        rig_file = RigFile.model_validate(values, context=context)
        Site(rig_file.realm, rig_file.rig)
    except ValidationError as error:
        raise SettingsError(explain(error, path, (), RigFile)) from None
    except KeyFormatError as error:
        raise SettingsError(f"{path or 'settings'}: {error}") from None
    if rig_file.zenoh.mode == "client" and not rig_file.zenoh.connect:
        raise SettingsError(
            f'{place(path, ("zenoh", "mode"))}zenoh.mode = "client" needs zenoh.connect, the '
            "addresses of hubs"
        )
    _refuse_shared_names(rig_file, path)
    return rig_file


def load_settings(
    path: Path | None,
    service: str,
    model: type[S],
    instance: str | None = None,
    chosen: Mapping[str, Any] | None = None,
) -> Settings[S]:
    """The settings of one instance.

    ``instance`` may be left out where the file names one at the most. ``chosen`` are settings of
    its table that the command line has in place of the file's. Raises SettingsError.
    """
    rig_file = load_rig_file(path)
    tables: Tables = getattr(rig_file, service)
    where = str(path) if path is not None else "the settings"
    if instance is None:
        if len(tables) > 1:
            raise SettingsError(
                f"{where} names several instances of {service}; add --name with one of: "
                + ", ".join(sorted(tables))
            )
        instance = next(iter(tables), service)
    elif tables and instance not in tables:
        raise SettingsError(
            f"{where} has no [{service}.{instance}]" + suggestion(instance, sorted(tables))
        )
    if chosen:
        table = {**tables.get(instance, {}), **chosen}
        rig_file = rig_file.model_copy(update={service: {**tables, instance: table}})
    return instance_settings(rig_file, path, service, model, instance)


def instance_settings(
    rig_file: RigFile, path: Path | None, service: str, model: type[S], instance: str
) -> Settings[S]:
    """Check one instance's table; raises SettingsError naming file, line and mend."""
    try:
        require_name("instance", instance)
    except KeyFormatError as error:
        raise SettingsError(f"{path or 'settings'}: {error}") from None
    instances = {one: tuple(getattr(rig_file, one)) for one in SERVICES}
    origin = Origin(path, (service, instance), instances)
    checked = origin.checked(getattr(rig_file, service).get(instance, {}), model)
    site = Site(rig_file.realm, rig_file.rig)
    return Settings(site, rig_file.zenoh, rig_file.log, instance, checked, origin)


def _refuse_shared_names(rig_file: RigFile, path: Path | None) -> None:
    services: dict[str, str] = {}
    for service in SERVICES:
        for instance in getattr(rig_file, service):
            if instance in services:
                raise SettingsError(
                    f"{path or 'settings'}: [{services[instance]}.{instance}] and "
                    f"[{service}.{instance}] have one name, which is their health's key too: "
                    "give each its own"
                )
            services[instance] = service
