"""A learned model in one file (``archive``)."""

from dataclasses import MISSING, fields
from pathlib import Path
from typing import Any, TypeVar

from inhand_schemas.joints import JOINT_NAMES

from inhand_tracker.mapping.mapping import Mapping
from inhand_tracker.model.archive import ArchiveKind, Arrays, read_archive, write_archive
from inhand_tracker.model.model import Model
from inhand_tracker.model.prior_arrays import prior_from_arrays, prior_to_arrays
from inhand_tracker.model.taught import TaughtRecordings
from inhand_tracker.shape.contours import Contours
from inhand_tracker.shape.shape import ObjectShape, Symmetry
from inhand_tracker.shape.viewpoints import Viewpoints
from inhand_tracker.sight.appearance import Appearance

Part = TypeVar("Part", Contours, Appearance)

MODEL_FILE = ArchiveKind(
    "model",
    "inhand-model",
    version=1,
    noun="Inhand model",
    version_nouns=("a model of version", "version"),
    make="make one with `inhand train`",
    make_again="make it anew with `inhand train`",
)
_SHAPE_ARRAYS = ("vertices", "faces", "marked_vertices", "mirror_normal")
_MAPPING_ARRAYS = tuple(
    field.name
    for field in fields(Mapping)
    if field.name not in ("participants", "absent_joints", "convention")
)


def save_model(model: Model, path: Path | str) -> None:
    """Write a model; an existing file is replaced only when all is written. Raises ModelError."""
    description = {
        "interaction": model.interaction,
        "object": model.shape.name,
        "participants": model.mapping.participants,
        "absent_joints": [JOINT_NAMES[joint] for joint in model.mapping.absent_joints],
        "convention": model.mapping.convention,
        "symmetries": [[s.axis, s.centre, s.order] for s in model.shape.symmetries],
    }
    viewpoints = model.viewpoints
    arrays: Arrays = {
        **_named("shape", {name: getattr(model.shape, name) for name in _SHAPE_ARRAYS}),
        "viewpoints.directions": viewpoints.directions,
        "viewpoints.boundaries": viewpoints.boundaries,
        **_named("mapping", {name: getattr(model.mapping, name) for name in _MAPPING_ARRAYS}),
    }
    if viewpoints.surfaces is not None:
        arrays["viewpoints.surfaces"] = viewpoints.surfaces
    if viewpoints.contours is not None:
        arrays |= _named("contours", _values(viewpoints.contours))
    if model.appearance is not None:
        arrays |= _named("appearance", _values(model.appearance))
    if model.prior is not None:
        arrays |= _named("prior", prior_to_arrays(model.prior))
    if model.taught is not None:
        arrays |= _named("taught", model.taught.arrays())
    write_archive(MODEL_FILE, path, description, arrays)


def load_model(path: Path | str) -> Model:
    """Read a model; raises ModelError for a missing, foreign, newer or damaged file."""
    return read_archive(MODEL_FILE, path, _assemble)


def _assemble(description: dict[str, Any], arrays: Arrays) -> Model:
    shape = ObjectShape(
        description["object"],
        **{name: arrays[f"shape.{name}"] for name in _SHAPE_ARRAYS},
        symmetries=tuple(Symmetry(tuple(a), tuple(c), o) for a, c, o in description["symmetries"]),
    )
    mapping = Mapping(
        participants=tuple(description["participants"]),
        absent_joints=tuple(
            JOINT_NAMES.index(name) for name in description.get("absent_joints", ())
        ),
        convention=_text_or_none(description.get("convention")),
        **{name: arrays[f"mapping.{name}"] for name in _MAPPING_ARRAYS},
    )
    viewpoints = Viewpoints(
        arrays["viewpoints.directions"],
        arrays["viewpoints.boundaries"],
        arrays.get("viewpoints.surfaces"),
        _part("contours", Contours, arrays),
    )
    of_prior, taught = _arrays_of("prior", arrays), _arrays_of("taught", arrays)
    return Model(
        description["interaction"],
        shape,
        mapping,
        viewpoints,
        _part("appearance", Appearance, arrays),
        prior_from_arrays(of_prior) if of_prior else None,
        TaughtRecordings.from_arrays(taught) if taught else None,
    )


def _text_or_none(value: Any) -> str | None:
    if value is not None and not isinstance(value, str):
        raise TypeError(f"{value!r} is no text")
    return value


def _named(part: str, arrays: Arrays) -> Arrays:
    return {f"{part}.{name}": array for name, array in arrays.items()}


def _arrays_of(part: str, arrays: Arrays) -> Arrays:
    """The arrays of a part by their own names; none where a file lacks it."""
    beginning = f"{part}."
    return {
        name.removeprefix(beginning): array
        for name, array in arrays.items()
        if name.startswith(beginning)
    }


def _values(part: Contours | Appearance) -> Arrays:
    return {field.name: getattr(part, field.name) for field in fields(part)}


def _part(name: str, kind: type[Part], arrays: Arrays) -> Part | None:
    """A part of a model; None in files of older releases, which do not have it.

    Fields with a default came later than others, and older files lack them.
    """
    needed = [field.name for field in fields(kind) if field.default is MISSING]
    if any(f"{name}.{field}" not in arrays for field in needed):
        return None
    present = [field.name for field in fields(kind) if f"{name}.{field.name}" in arrays]
    values = {field: arrays[f"{name}.{field}"] for field in present}
    return kind(**{f: value if value.ndim else value.item() for f, value in values.items()})
