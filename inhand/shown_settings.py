"""Settings as a stranger may see them: no secret, nobody's name, and nothing unknown to Inhand.

What is shown is what the models of the settings declare. A text that nobody declared may be a
password, as one of a camera's address in the options of somebody's own source.
"""

import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from inhand_runtime.settings import SERVICES, RigFile
from inhand_runtime.settings_annotations import members, model_in, part_of
from inhand_runtime.source import SourceError, require_source, source_factory
from pydantic import SecretStr

from inhand.service_models import settings_model

LEFT_OUT = "(left out)"
SHORTEST_SECRET = 6
"""Number of characters from which on a text that was left out is looked for elsewhere too."""

_SECRET_NAME = re.compile(r"pass|secret|token|credential", re.IGNORECASE)
_USER_IN_ADDRESS = re.compile(r"""(?<=//)[^/\s@]+@|[^/\s@"']+:[^/\s@"']*@""")
_PRIVATE_KEY = re.compile(
    r"-----BEGIN [A-Z ]*PRIVATE KEY-----.*?(-----END [A-Z ]*PRIVATE KEY-----|\Z)", re.DOTALL
)
_OURS = ("inhand_capture.", "inhand_lab.")
"""Packages whose sources have options of which none is a secret."""


class Shown:
    """The settings of a file that may be shown, and what is to be taken out of all else."""

    def __init__(self, values: Mapping[str, Any], folder: Path) -> None:
        """``values`` are those of the file and the environment, right or wrong; ``folder`` is
        the file's, which a relative path of a password follows."""
        self._secrets: set[str] = set()
        self.settings = self._table(
            {name: value for name, value in values.items() if name not in SERVICES}, RigFile
        )
        for service in SERVICES:
            if isinstance(tables := values.get(service, {}), Mapping):
                self.settings |= {
                    f"{service}.{name}": self._instance(service, table)
                    for name, table in tables.items()
                }
        for path in _password_files(values, folder):
            with suppress(OSError):
                self._secrets.add(path.read_text(encoding="utf-8", errors="replace").strip())

    def cleaned(self, text: str) -> str:
        """Return a text without the secrets of the settings, and without any private key."""
        text = _USER_IN_ADDRESS.sub("", _PRIVATE_KEY.sub(LEFT_OUT, text))
        for secret in sorted(self._secrets, key=len, reverse=True):
            if len(secret) >= SHORTEST_SECRET:
                text = text.replace(secret, LEFT_OUT)
        return text

    def _instance(self, service: str, table: Any) -> Any:
        if not isinstance(table, Mapping):
            return self._leave_out(table)
        if service != "capture" or "options" not in table:
            return self._table(table, settings_model(service))
        declared = {name: value for name, value in table.items() if name != "options"}
        options = self._value("options", table["options"], _options_model(table.get("source")))
        return self._table(declared, settings_model(service)) | {"options": options}

    def _table(self, table: Mapping[str, Any], annotation: Any) -> dict[str, Any]:
        return {
            name: self._value(name, value, part_of(annotation, name))
            for name, value in table.items()
        }

    def _value(self, name: str, value: Any, annotation: Any) -> Any:
        kinds = members(annotation)
        if Any in kinds or SecretStr in kinds or _SECRET_NAME.search(name) or _names(name, value):
            is_path = name == "password_file" and isinstance(value, str)
            return value if is_path else self._leave_out(value)
        if isinstance(value, Mapping):
            return self._table(value, model_in(annotation) or annotation)
        if isinstance(value, list | tuple):
            part = part_of(annotation, 0)
            return [self._value(name, one, part) for one in value]
        return _USER_IN_ADDRESS.sub("", value) if isinstance(value, str) else value

    def _leave_out(self, value: Any) -> str:
        self._secrets.update(_texts(value))
        return LEFT_OUT


def _options_model(source: Any) -> Any:
    """The model of a source's options, where it is one of ours that declares them."""
    with suppress(SourceError):
        if require_source(str(source)).value.startswith(_OURS):
            return getattr(source_factory(str(source)), "options_model", Any)
    return Any


def _password_files(values: Mapping[str, Any], folder: Path) -> Iterator[Path]:
    zenoh = values.get("zenoh")
    if isinstance(zenoh, Mapping) and isinstance(path := zenoh.get("password"), str):
        yield folder / path
    for tables in (values.get("studio"), values.get("outcomes")):
        for table in tables.values() if isinstance(tables, Mapping) else ():
            broker = table.get("homeassistant") if isinstance(table, Mapping) else None
            for one in (table, broker):
                if isinstance(one, Mapping) and isinstance(path := one.get("password_file"), str):
                    yield folder / path


def _names(name: str, value: Any) -> bool:
    """Whether a setting names people who live there."""
    return (name == "people" and isinstance(value, Mapping)) or (
        name == "person" and isinstance(value, str)
    )


def _texts(value: Any) -> Iterator[str]:
    if isinstance(value, Mapping):
        for one in value.values():
            yield from _texts(one)
    elif isinstance(value, list | tuple):
        for one in value:
            yield from _texts(one)
    elif isinstance(value, str):
        yield str(value)
