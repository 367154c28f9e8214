"""Mesh files as people find them: in any unit, unscaled, of many parts, with z or y up."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import trimesh
from inhand_lab.objects.hammer import hammer
from inhand_lab.objects.jug import jug
from inhand_lab.objects.model import ObjectModel
from inhand_lab.objects.mug import mug
from inhand_lab.objects.racket import racket
from inhand_lab.objects.vinegar_bottle import vinegar_bottle

Y_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
"""Turns z to y."""


@dataclass(frozen=True)
class FoundMesh:
    """A mesh file's name, what it shows, the numbers that make a metre, and its axis that is up.

    ``options`` are what has to be answered for it, none where it is sure; ``parts`` is the number
    of nodes of its scene, 0 for a file without a scene.
    """

    name: str
    model: ObjectModel
    per_metre: float
    up: str
    options: Mapping[str, str]
    parts: int = 0

    def write(self, folder: Path) -> Path:
        """Write the file."""
        turn = Y_UP if self.up == "y" else np.eye(3)
        vertices = self.per_metre * self.model.vertices @ turn.T
        mesh = trimesh.Trimesh(vertices, self.model.faces, process=False)
        path = folder / self.name
        (_scene(mesh, self.parts) if self.parts else mesh).export(path)
        return path


FOUND = (
    FoundMesh("in_millimetres.stl", hammer(), 1000.0, "z", {"up": "z"}),
    FoundMesh("in_inches.obj", vinegar_bottle(), 1.0 / 0.0254, "y", {"unit": "inch", "up": "y"}),
    FoundMesh("unscaled.ply", mug(), 2.0 / 0.1203, "z", {"size": "12.03", "up": "z"}),
    FoundMesh("many_parts.glb", racket(), 1.0, "y", {}, parts=6),
    FoundMesh("z_up_in_metres.off", jug(), 1.0, "z", {"up": "z"}),
)
"""The longest side of the unscaled mug is 2."""


def _scene(mesh: trimesh.Trimesh, parts: int) -> trimesh.Scene:
    """A scene whose nodes each have a part of a mesh, in axes of their own."""
    scene = trimesh.Scene()
    for number, faces in enumerate(np.array_split(np.arange(len(mesh.faces)), parts)):
        part = mesh.submesh([faces], append=True)
        place = trimesh.transformations.rotation_matrix(number, [1, 2, 3], [0.1, 0.2, 0.3])
        part.apply_transform(np.linalg.inv(place))
        scene.add_geometry(part, node_name=f"part{number}", transform=place)
    return scene
