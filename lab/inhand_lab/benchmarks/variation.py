"""Parameters of fusion, named and changed one at a time, as a command line asks for it."""

import math
from collections.abc import Iterator
from dataclasses import fields, is_dataclass, replace
from typing import Any

from inhand_runtime.errors import SettingsError
from inhand_tracker.methods.fusion.parameters import DEFAULT_FUSION, FusionParameters

_KINDS = {
    bool: "neither true nor false",
    int: "no positive whole number",
    float: "no positive number",
}


def parameter_names(record: Any = DEFAULT_FUSION, prefix: str = "") -> Iterator[str]:
    """The names of all parameters; those of a record in a record as ``prior.distrust``."""
    for field in fields(record):
        value = getattr(record, field.name)
        if is_dataclass(value):
            yield from parameter_names(value, f"{prefix}{field.name}.")
        else:
            yield prefix + field.name


def vary(setting: str) -> tuple[FusionParameters, str]:
    """The parameters with one ``FIELD=VALUE`` changed, and the field as it is usually.

    Raises SettingsError for an unknown field and a value that it cannot have.
    """
    name, separator, text = (part.strip() for part in setting.partition("="))
    if not separator:
        raise SettingsError(f"--vary {setting}: write FIELD=VALUE, as image_temper=0.5")
    if name not in parameter_names():
        raise SettingsError(
            f"--vary {setting}: fusion has no parameter {name!r}; it has: "
            f"{', '.join(parameter_names())}"
        )
    path = name.split(".")
    usual: Any = DEFAULT_FUSION
    for step in path:
        usual = getattr(usual, step)
    try:
        value = _read(type(usual), text)
    except ValueError:
        raise SettingsError(f"--vary {setting}: {text!r} is {_KINDS[type(usual)]}") from None
    parameters: FusionParameters = _changed(DEFAULT_FUSION, path, value)
    return parameters, f"{name}={_shown(usual)}"


def _read(kind: type, text: str) -> bool | int | float:
    """A value of a kind; raises ValueError."""
    if kind is bool:
        return bool(("false", "true").index(text.lower()))
    value: int | float = kind(text)
    if not (math.isfinite(value) and value > 0):
        raise ValueError(text)
    return value


def _changed(record: Any, path: list[str], value: object) -> Any:
    """A record in which the field at the end of a path has another value."""
    name, *rest = path
    if rest:
        value = _changed(getattr(record, name), rest, value)
    return replace(record, **{name: value})


def _shown(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)
