"""A learned model in one file: a zip of NumPy arrays and a JSON description, with checksums.

Any zip tool and NumPy can open it. Nothing in it is executed.
"""

import contextlib
import json
import zipfile
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from inhand_runtime.errors import InhandError

from inhand_tracker.mapping.mapping import Mapping
from inhand_tracker.prior.prior import Prior, prior_arrays, prior_from_arrays
from inhand_tracker.shape.contours import Contours
from inhand_tracker.shape.shape import ObjectShape, Symmetry
from inhand_tracker.shape.viewpoints import Viewpoints
from inhand_tracker.sight.appearance import Appearance

Part = TypeVar("Part", Contours, Appearance)

FORMAT = "inhand-model"
VERSION = 1


class ModelError(InhandError):
    """A model file that cannot be used; the message says the mend."""


@dataclass(frozen=True)
class Model:
    """What a tracker needs to know of one object in one interaction."""

    interaction: str
    shape: ObjectShape
    mapping: Mapping
    viewpoints: Viewpoints
    appearance: Appearance | None = None
    prior: Prior | None = None


def save_model(model: Model, path: Path) -> None:
    """Write a model; an existing file is replaced only when all is written."""
    shape, mapping = model.shape, model.mapping
    description = {
        "format": FORMAT,
        "version": VERSION,
        "interaction": model.interaction,
        "object": shape.name,
        "participants": mapping.participants,
        "symmetries": [[s.axis, s.centre, s.order] for s in shape.symmetries],
    }
    arrays = {
        "shape.vertices": shape.vertices,
        "shape.faces": shape.faces,
        "shape.marked_vertices": shape.marked_vertices,
        "shape.mirror_normal": shape.mirror_normal,
        "viewpoints.directions": model.viewpoints.directions,
        "viewpoints.boundaries": model.viewpoints.boundaries,
        **{f"mapping.{name}": getattr(mapping, name) for name in _mapping_arrays()},
    }
    if model.viewpoints.surfaces is not None:
        arrays["viewpoints.surfaces"] = model.viewpoints.surfaces
    if model.viewpoints.contours is not None:
        arrays |= _named("contours", model.viewpoints.contours)
    if model.appearance is not None:
        arrays |= _named("appearance", model.appearance)
    if model.prior is not None:
        arrays |= {f"prior.{name}": array for name, array in prior_arrays(model.prior).items()}
    temporary = path.with_name(path.name + ".part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with temporary.open("wb") as file:
            np.savez(file, model=np.array(json.dumps(description)), **arrays)
        temporary.replace(path)
    except OSError as error:
        with contextlib.suppress(OSError):
            temporary.unlink()
        raise ModelError(f"cannot write {path}: {error.strerror}") from None


def load_model(path: Path) -> Model:
    """Read a model; raises ModelError for a missing, foreign, newer or damaged file."""
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as archive:
            if "model" not in archive:
                raise ModelError(f"{path} is no Inhand model: make one with `inhand train`")
            description = json.loads(str(archive["model"]))
            _check(description, path)
            arrays = {name: archive[name] for name in archive.files}
        return _assemble(description, arrays)
    except ModelError:
        raise
    except OSError as error:
        raise ModelError(f"cannot read {path}: {error.strerror or error}") from None
    except Exception as error:  # noqa: BLE001 - a reader of damaged files may raise anything
        if not zipfile.is_zipfile(path) and not _starts_like_zip(path):
            raise ModelError(f"{path} is no Inhand model: make one with `inhand train`") from None
        raise ModelError(
            f"{path} is damaged ({error}): copy it again, or make it anew with `inhand train`"
        ) from None


def _check(description: Any, path: Path) -> None:
    if not isinstance(description, dict) or description.get("format") != FORMAT:
        raise ModelError(f"{path} is no Inhand model: make one with `inhand train`")
    if description["version"] != VERSION:
        raise ModelError(
            f"{path} is a model of version {description['version']}, and this release reads "
            f"version {VERSION}: update Inhand, or train again"
        )


def _assemble(description: dict[str, Any], arrays: dict[str, Any]) -> Model:
    shape = ObjectShape(
        description["object"],
        arrays["shape.vertices"],
        arrays["shape.faces"],
        arrays["shape.marked_vertices"],
        arrays["shape.mirror_normal"],
        tuple(Symmetry(tuple(a), tuple(c), o) for a, c, o in description["symmetries"]),
    )
    mapping = Mapping(
        participants=tuple(description["participants"]),
        **{name: arrays[f"mapping.{name}"] for name in _mapping_arrays()},
    )
    viewpoints = Viewpoints(
        arrays["viewpoints.directions"],
        arrays["viewpoints.boundaries"],
        arrays.get("viewpoints.surfaces"),
        _found("contours", Contours, arrays),
    )
    appearance = _found("appearance", Appearance, arrays)
    of_prior = {
        name.removeprefix("prior."): array
        for name, array in arrays.items()
        if name.startswith("prior.")
    }
    prior = prior_from_arrays(of_prior) if of_prior else None
    return Model(description["interaction"], shape, mapping, viewpoints, appearance, prior)


def _named(name: str, part: Contours | Appearance) -> dict[str, Any]:
    return {f"{name}.{field.name}": getattr(part, field.name) for field in fields(part)}


def _found(name: str, kind: type[Part], arrays: dict[str, Any]) -> Part | None:
    """A part that models of older releases do not have."""
    names = [field.name for field in fields(kind)]
    if any(f"{name}.{field}" not in arrays for field in names):
        return None
    values = {field: arrays[f"{name}.{field}"] for field in names}
    return kind(**{f: value if value.ndim else value.item() for f, value in values.items()})


def _mapping_arrays() -> tuple[str, ...]:
    return tuple(field.name for field in fields(Mapping) if field.name != "participants")


def _starts_like_zip(path: Path) -> bool:
    with path.open("rb") as file:
        return file.read(2) == b"PK"
