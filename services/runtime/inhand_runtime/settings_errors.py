"""What is wrong with settings, in one line: where it stands, what it is, and the mend."""

import difflib
import os
import re
from collections.abc import Iterable
from pathlib import Path

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from inhand_runtime.settings_annotations import (
    Location,
    annotation_at,
    choices,
    members,
    model_in,
)

ENVIRONMENT_PREFIX = "INHAND_"
NESTED = "__"
ENCODING = "utf-8-sig"
"""UTF-8, with or without a byte-order mark."""

_NO_COLLECTION = ("tuple_type", "list_type", "set_type", "dict_type", "model_type")


def explain(
    error: ValidationError, path: Path | None, prefix: tuple[str, ...], model: type[BaseModel]
) -> str:
    """The faults of the table at ``prefix`` of the file at ``path``, checked by ``model``."""
    faults: dict[Location, ErrorDetails] = {}
    for detail in error.errors():
        faults.setdefault(_setting(model, detail["loc"]), detail)
    return "; ".join(
        _explain_one(detail, location, path, prefix, model) for location, detail in faults.items()
    )


def suggestion(name: str, names: Iterable[str]) -> str:
    """The name that was meant, or all that there are, in brackets."""
    names = list(names)
    close = difflib.get_close_matches(name.lower(), names, 1)
    return f" (did you mean {close[0]}?)" if close else f" (there are: {', '.join(names)})"


def place(path: Path | None, location: tuple[str, ...]) -> str:
    """Where a setting stands: the variable that sets it, or the line of the file."""
    variables = {variable.upper(): variable for variable in os.environ}
    for depth in range(len(location), 0, -1):
        variable = variables.get(ENVIRONMENT_PREFIX + NESTED.join(location[:depth]).upper())
        if variable is not None:
            return f"environment variable {variable}: "
    if path is None:
        return ""
    try:
        line = _line_of(path.read_text(encoding=ENCODING), location)
    except (OSError, UnicodeDecodeError):  # it was changed since it was read
        line = None
    return f"{path}: " if line is None else f"{path}:{line}: "


def _setting(model: type[BaseModel], location: Location) -> tuple[str | int, ...]:
    """The setting that a fault is of: all members of a union have their say about one value."""
    for depth in range(len(location)):
        if len(members(annotation_at(model, location[:depth]))) > 1:
            return tuple(location[:depth])
    return tuple(location)


def _explain_one(
    detail: ErrorDetails,
    setting: Location,
    path: Path | None,
    prefix: tuple[str, ...],
    model: type[BaseModel],
) -> str:
    location = (*prefix, *map(str, setting))
    name = ".".join(location)
    where = place(path, location)
    reason = detail["msg"].removeprefix("Value error, ")
    kind = detail["type"]
    if kind == "extra_forbidden":
        owner = model_in(annotation_at(model, setting[:-1])) or model
        return f"{where}unknown setting {name}" + suggestion(location[-1], owner.model_fields)
    if kind == "missing":
        return f"{where}setting {name} is missing"
    if kind == "literal_error":
        wanted = choices(annotation_at(model, setting))
        value = detail["input"]
        reason = f"there is no {value!r}" + suggestion(str(value), map(str, wanted))
    elif kind in _NO_COLLECTION and where.startswith("environment"):
        reason = 'write lists and tables as JSON, such as ["a", "b"]'
    elif kind == "dict_type" and len(location) == 2:
        return f"{where}{name} stands in no instance: write it below [{location[0]}.NAME]"
    if not setting:
        return f"{where}[{name}]: {reason}"
    return f"{where}setting {name}: {reason}"


def _line_of(text: str, location: tuple[str, ...]) -> int | None:
    """The line of a key in a TOML text, or of the nearest table around it."""
    table: tuple[str, ...] = ()
    best, best_depth = None, 0
    for number, line in enumerate(text.splitlines(), 1):
        if header := re.match(r"\s*\[+([^\]]+)\]", line):
            found = table = _parts(header[1])
        elif key := re.match(r"\s*([\w.\"'-]+)\s*=", line):
            found = (*table, *_parts(key[1]))
        else:
            continue
        if location[: len(found)] == found and len(found) > best_depth:
            best, best_depth = number, len(found)
    return best


def _parts(dotted: str) -> tuple[str, ...]:
    return tuple(part.strip().strip("\"'") for part in dotted.split("."))
