"""Settings: one TOML file a rig, overridden by the environment, checked before anything starts.

Every daemon reads the same file, and its own table in it: ``[capture.front]`` is the settings of
the capture instance ``front``. ``INHAND_CAPTURE__FRONT__SOURCE=replay`` overrides one value.
"""

import os
import re
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Generic, Literal, TypeVar

from inhand_schemas.errors import KeyFormatError
from inhand_schemas.keys import Site, require_name
from pydantic import AfterValidator, BaseModel, ConfigDict, ValidationError
from pydantic_settings import (
    BaseSettings,
    PydanticBaseSettingsSource,
    SettingsConfigDict,
)
from pydantic_settings import SettingsError as UnreadableVariableError

from inhand_runtime.errors import SettingsError
from inhand_runtime.settings_errors import ENVIRONMENT_PREFIX, NESTED, explain, suggestion

SERVICES = ("capture", "tracker", "recorder")

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


class ZenohSettings(Section):
    """How to reach the other processes.

    A ``peer`` meets the others at ``meeting``, an address of this machine that the first one
    takes; ``listen`` and ``connect`` add addresses. A ``client`` connects to hubs only.
    """

    mode: Literal["peer", "client"] = "peer"
    meeting: Address = MEETING
    listen: tuple[Address, ...] = ()
    connect: tuple[Address, ...] = ()


class LogSettings(Section):
    """How to log to standard error."""

    format: Literal["console", "json"] = "console"
    level: Literal["debug", "info", "warning", "error"] = "info"


class RigFile(BaseSettings):
    """The whole file; the tables of a service are checked by that service."""

    model_config = SettingsConfigDict(
        extra="forbid", frozen=True, env_prefix=ENVIRONMENT_PREFIX, env_nested_delimiter=NESTED
    )

    realm: str = "inhand"
    rig: str = "rig"
    zenoh: ZenohSettings = ZenohSettings()
    log: LogSettings = LogSettings()
    capture: Tables = {}
    tracker: Tables = {}
    recorder: Tables = {}

    @classmethod
    def settings_customise_sources(
        cls,
        settings_cls: type[BaseSettings],
        init_settings: PydanticBaseSettingsSource,
        env_settings: PydanticBaseSettingsSource,
        dotenv_settings: PydanticBaseSettingsSource,
        file_secret_settings: PydanticBaseSettingsSource,
    ) -> tuple[PydanticBaseSettingsSource, ...]:
        """The environment goes over the file."""
        return env_settings, init_settings


S = TypeVar("S", bound=Section)
S_co = TypeVar("S_co", bound=Section, covariant=True)


@dataclass(frozen=True)
class Settings(Generic[S_co]):
    """What one instance of a service runs with."""

    site: Site
    zenoh: ZenohSettings
    log: LogSettings
    instance: str
    service: S_co


def load_rig_file(path: Path | None) -> RigFile:
    """Read a file, or take the defaults; raises SettingsError naming file, line and mend."""
    values: dict[str, Any] = {}
    if path is not None:
        try:
            values = tomllib.loads(path.read_text(encoding="utf-8"))
        except OSError as error:
            raise SettingsError(f"cannot read {path}: {error.strerror}") from None
        except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
            raise SettingsError(f"{path} is no TOML: {error}") from None
    _refuse_unknown_variables()
    try:
        rig_file = RigFile(**values)
        Site(rig_file.realm, rig_file.rig)
    except ValidationError as error:
        raise SettingsError(explain(error, path, (), RigFile)) from None
    except UnreadableVariableError as error:
        raise SettingsError(
            f"an {ENVIRONMENT_PREFIX} environment variable cannot be read ({error}): "
            "write lists and tables as JSON"
        ) from None
    except KeyFormatError as error:
        raise SettingsError(f"{path or 'settings'}: {error}") from None
    _refuse_shared_names(rig_file, path)
    return rig_file


def load_settings(
    path: Path | None, service: str, model: type[S], instance: str | None = None
) -> Settings[S]:
    """The settings of one instance.

    ``instance`` may be left out where the file names one at the most. Raises SettingsError.
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
        raise SettingsError(f"{where} has no [{service}.{instance}]")
    return instance_settings(rig_file, path, service, model, instance)


def instance_settings(
    rig_file: RigFile, path: Path | None, service: str, model: type[S], instance: str
) -> Settings[S]:
    """Check one instance's table; raises SettingsError naming file, line and mend."""
    try:
        require_name("instance", instance)
    except KeyFormatError as error:
        raise SettingsError(f"{path or 'settings'}: {error}") from None
    table = getattr(rig_file, service).get(instance, {})
    try:
        checked = model(**table)
    except ValidationError as error:
        raise SettingsError(explain(error, path, (service, instance), model)) from None
    site = Site(rig_file.realm, rig_file.rig)
    return Settings(site, rig_file.zenoh, rig_file.log, instance, checked)


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


def _refuse_unknown_variables() -> None:
    for variable in os.environ:
        if variable.upper().startswith(ENVIRONMENT_PREFIX):
            first = variable[len(ENVIRONMENT_PREFIX) :].split(NESTED)[0].lower()
            if first not in RigFile.model_fields:
                raise SettingsError(
                    f"environment variable {variable} sets nothing: {first!r} is no setting"
                    + suggestion(first, RigFile)
                )
