"""Surfaces: closed, with normals outwards, and lit from above."""

import numpy as np
import pytest
import trimesh
from inhand_lab.geometry.surfaces import (
    LIGHT_IN_CAMERA,
    Surface,
    block,
    ellipsoid,
    join_surfaces,
    limb,
    lit,
)
from inhand_lab.geometry.transforms import Transform, rotation_about

GREY = (100, 100, 100)
SOLIDS = {
    "ellipsoid": (ellipsoid((0.1, 0.0, 2.0), (0.1, 0.2, 0.3), GREY, 3), np.pi * 0.008),
    "limb": (limb(0.5, 0.1, 0.1, GREY), np.pi * (0.005 + 0.004 / 3.0)),
    "block": (block((0.0, 0.0, 1.0), (0.1, 0.2, 0.3), GREY), 0.006),
}


def closed(surface: Surface) -> trimesh.Trimesh:
    return trimesh.Trimesh(surface.vertices, surface.faces)


@pytest.mark.parametrize("name", SOLIDS)
def test_a_solid_is_closed_and_has_its_volume(name: str) -> None:
    surface, volume = SOLIDS[name]
    assert closed(surface).volume == pytest.approx(volume, rel=0.06)
    assert np.allclose(np.linalg.norm(surface.normals, axis=1), 1.0)
    out = surface.vertices - surface.vertices.mean(axis=0)
    assert (np.sum(out * surface.normals, axis=1) > 0.0).all()


def test_joined_surfaces_keep_their_triangles_and_move_together() -> None:
    parts = [surface for surface, _ in SOLIDS.values()]
    joined = join_surfaces(parts)
    assert len(joined.faces) == sum(len(part.faces) for part in parts)
    assert joined.faces.max() == len(joined.vertices) - 1
    moved = joined.moved(Transform(np.array([1.0, 2.0, 3.0]), rotation_about("z", 1.0)))
    assert closed(moved).volume == pytest.approx(closed(joined).volume)


def test_what_faces_the_light_is_bright_and_what_turns_away_is_not_black() -> None:
    normals = np.stack([LIGHT_IN_CAMERA, -LIGHT_IN_CAMERA])
    towards, away = lit(normals, np.full((2, 3), 200.0, np.float32))
    assert towards == pytest.approx([200.0] * 3)
    assert away == pytest.approx([84.0] * 3)
