"""What is wrong with settings, in one line: where it stands, what it is, and the mend."""

import difflib
import os
import re
from pathlib import Path
from typing import Any, get_args

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

ENVIRONMENT_PREFIX = "INHAND_"
NESTED = "__"


def explain(
    error: ValidationError, path: Path | None, prefix: tuple[str, ...], model: type[BaseModel]
) -> str:
    """The faults of the table at ``prefix`` of the file at ``path``, checked by ``model``."""
    return "; ".join(_explain_one(detail, path, prefix, model) for detail in error.errors())


def suggestion(name: str, model: type[BaseModel]) -> str:
    """The setting that was meant, or all that there are, in brackets."""
    close = difflib.get_close_matches(name, model.model_fields, 1)
    if close:
        return f" (did you mean {close[0]}?)"
    return f" (there are: {', '.join(model.model_fields)})"


def _explain_one(
    detail: ErrorDetails, path: Path | None, prefix: tuple[str, ...], model: type[BaseModel]
) -> str:
    location = (*prefix, *(str(part) for part in detail["loc"]))
    name = ".".join(location)
    where = _place(path, location)
    reason = detail["msg"].removeprefix("Value error, ")
    match detail["type"]:
        case "extra_forbidden":
            owner = _model_at(model, detail["loc"][:-1])
            return f"{where}unknown setting {name}" + suggestion(location[-1], owner)
        case "missing":
            return f"{where}setting {name} is missing"
        case "dict_type" if len(location) == 2:
            service = location[0]
            return f"{where}{name} stands in no instance: write it below [{service}.NAME]"
    if not detail["loc"]:
        return f"{where}[{name}]: {reason}"
    return f"{where}setting {name}: {reason}"


def _model_at(model: type[BaseModel], location: tuple[int | str, ...]) -> type[BaseModel]:
    """The model that checks the table at a location, through lists and dictionaries of models."""
    for part in location:
        field = model.model_fields.get(str(part))
        if field is not None:
            model = _model_in(field.annotation) or model
    return model


def _model_in(annotation: Any) -> type[BaseModel] | None:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    return next(filter(None, map(_model_in, get_args(annotation))), None)


def _place(path: Path | None, location: tuple[str, ...]) -> str:
    for depth in range(len(location), 0, -1):
        variable = ENVIRONMENT_PREFIX + NESTED.join(location[:depth]).upper()
        if variable in os.environ:
            return f"environment variable {variable}: "
    if path is None:
        return ""
    line = _line_of(path.read_text(encoding="utf-8"), location)
    return f"{path}: " if line is None else f"{path}:{line}: "


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
