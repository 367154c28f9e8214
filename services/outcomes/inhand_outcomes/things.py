"""The things whose use is measured: out of the models of a rig's trackers, and its settings."""

from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np
from inhand_runtime.object_meshes import MeshError, mesh_of_model, model_files
from inhand_runtime.settings import load_rig_file

from inhand_outcomes.settings import ObjectUse
from inhand_outcomes.thing import Thing
from inhand_outcomes.uses import use_of

UNUSED = ""
"""The use of a thing of which it is only measured how it is handled."""


def load_things(
    models: Iterable[Path], objects: Mapping[str, ObjectUse]
) -> tuple[dict[str, Thing], list[str]]:
    """Return the things of models by name, used as the settings or else their models say, and what
    is wrong with the others, a line each."""
    things: dict[str, Thing] = {}
    problems: list[str] = []
    for path in models:
        try:
            mesh = mesh_of_model(path)
        except MeshError as error:
            problems.append(str(error))
            continue
        said = objects.get(mesh.name, ObjectUse())
        things[mesh.name] = Thing(
            mesh.name,
            said.use or use_of(mesh.interaction) or UNUSED,
            np.frombuffer(mesh.vertices, "<f8").reshape(-1, 3).astype(np.float64),
            np.frombuffer(mesh.faces, "<i8").reshape(-1, 3).astype(np.int64),
            {name: np.array(point) for name, point in said.parts.items()},
        )
    problems += [
        f"the settings name {name}, and there is no model of it here"
        for name in objects
        if name not in things
    ]
    return things, problems


def models_of(config: Path | None) -> tuple[Path, ...]:
    """Return the models that trackers of a settings file follow; raises SettingsError."""
    return () if config is None else model_files(load_rig_file(config).tracker, config.parent)
