"""What kinds of values a model of settings takes, at each place."""

import types
from collections.abc import Mapping, Sequence
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel

_COLLECTIONS = (tuple, list, set, frozenset, dict, Sequence, Mapping)

Location = Sequence[str | int]


def annotation_at(model: type[BaseModel], location: Location) -> Any:
    """The annotation of the setting at a location; Any where it is not declared."""
    annotation: Any = model
    for part in location:
        annotation = part_of(annotation, part)
    return annotation


def part_of(annotation: Any, part: str | int) -> Any:
    """The annotation of a part of a value; Any where it is not declared."""
    (annotation, *others) = members(annotation)
    if others:
        return Any
    if _is_model(annotation):
        field = annotation.model_fields.get(str(part))
        return Any if field is None else field.annotation
    arguments = get_args(annotation)
    if get_origin(annotation) in (dict, Mapping):
        return arguments[1]
    if get_origin(annotation) in (tuple, list, set, frozenset, Sequence):
        return arguments[0]
    return Any


def members(annotation: Any) -> tuple[Any, ...]:
    """The annotations that a value must fit one of, None and what is only noted aside."""
    origin = get_origin(annotation)
    if origin is Annotated:
        return members(get_args(annotation)[0])
    if origin in (Union, types.UnionType):
        inner = [one for one in get_args(annotation) if one is not type(None)]
        return tuple(member for one in inner for member in members(one))
    return (annotation,)


def takes_collection(annotation: Any) -> bool:
    """Whether a value may be a list or a table."""
    return any(
        one is Any or _is_model(one) or (get_origin(one) or one) in _COLLECTIONS
        for one in members(annotation)
    )


def choices(annotation: Any) -> tuple[Any, ...]:
    """All values of an annotation's literals."""
    return tuple(
        value
        for one in members(annotation)
        if get_origin(one) is Literal
        for value in get_args(one)
    )


def model_in(annotation: Any) -> type[BaseModel] | None:
    """The model that checks a table, if one does."""
    return next((one for one in members(annotation) if _is_model(one)), None)


def _is_model(annotation: Any) -> bool:
    return isinstance(annotation, type) and issubclass(annotation, BaseModel)
