"""Settings from the environment: ``INHAND_CAPTURE__FRONT__SOURCE=replay`` overrides one value.

What stands in a variable is text. It is taken for a list or a table, written as JSON, only where
the setting can be one, so that a serial number of digits stays text where text is wanted; numbers
and truth values are read from text by the checks of the settings themselves.
"""

import json
import os
from collections.abc import Mapping
from typing import Any

from pydantic import BaseModel

from inhand_runtime.accepted_settings import ACCEPTED_VARIABLE
from inhand_runtime.cache_folder import CACHE_VARIABLE
from inhand_runtime.data_folder import DATA_VARIABLE
from inhand_runtime.errors import SettingsError
from inhand_runtime.settings_annotations import annotation_at, part_of, takes_collection
from inhand_runtime.settings_errors import ENVIRONMENT_PREFIX, NESTED, suggestion


class FromEnvironment(str):
    """The text of a variable whose setting is checked later, by its service."""


def with_environment(values: Mapping[str, Any], model: type[BaseModel]) -> dict[str, Any]:
    """The values of a file with those of the environment over them; raises SettingsError."""
    merged: dict[str, Any] = _copied(values)
    for variable, location, text in sorted(_variables(), key=lambda one: len(one[1])):
        if location[0] not in model.model_fields:
            raise SettingsError(
                f"environment variable {variable} sets nothing: {location[0]!r} is no setting"
                + suggestion(location[0], model.model_fields)
            )
        annotation = annotation_at(model, location)
        value = _read(text, annotation)
        if annotation is Any and not isinstance(value, dict):
            value = FromEnvironment(text)
        _set(merged, variable, location, value)
    return merged


def texts_read(value: Any, annotation: Any) -> Any:
    """A table with its texts from the environment read as the settings that they are."""
    if isinstance(value, FromEnvironment):
        return _read(value, annotation)
    if isinstance(value, dict):
        return {key: texts_read(inner, part_of(annotation, key)) for key, inner in value.items()}
    return value


def _variables() -> list[tuple[str, tuple[str, ...], str]]:
    return [
        (variable, tuple(variable[len(ENVIRONMENT_PREFIX) :].lower().split(NESTED)), text)
        for variable, text in os.environ.items()
        if variable.upper().startswith(ENVIRONMENT_PREFIX)
        and variable not in (CACHE_VARIABLE, DATA_VARIABLE, ACCEPTED_VARIABLE)
    ]


def _read(text: str, annotation: Any) -> Any:
    if text.lstrip()[:1] in ("[", "{") and takes_collection(annotation):
        try:
            return json.loads(text)
        except ValueError:
            pass  # the check of the setting says that a list or a table is JSON
    return str(text)


def _set(table: dict[str, Any], variable: str, location: tuple[str, ...], value: Any) -> None:
    *outer, last = location
    for part in outer:
        inner = table.setdefault(_key(table, part), {})
        if not isinstance(inner, dict):
            raise SettingsError(
                f"environment variable {variable} sets nothing: {part!r} is no table"
            )
        table = inner
    last = _key(table, last)
    before = table.get(last)
    if isinstance(before, dict) and isinstance(value, dict):
        before.update(value)
    else:
        table[last] = value


def _key(table: dict[str, Any], part: str) -> str:
    """The key of a table that a variable means, in whichever case the file writes it."""
    return next((key for key in table if key.lower() == part), part)


def _copied(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {key: _copied(inner) for key, inner in value.items()}
    return value
