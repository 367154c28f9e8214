"""A coloured box before a wall, drawn without the code under test, and an object's sight of it."""

from functools import lru_cache

import cv2
import numpy as np
import trimesh
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.image import Image
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.shape.viewpoints import Viewpoints, find_viewpoints
from inhand_tracker.sight.appearance import Appearance, AppearanceSample, learn_appearance
from inhand_tracker.sight.frame import prepare
from inhand_tracker.sight.sight import SIGHT_TERMS, Sight, SightTerm
from inhand_tracker.sight.view import SightView
from people import quaternion_of, scipy_rotation
from scipy.spatial.transform import Rotation

CAMERA = Intrinsics(525.0, 525.0, 319.5, 239.5, 640, 480)
PLACE = np.array([0.1, -0.05, 1.2])
TURN = quaternion_of(Rotation.from_rotvec([0.5, 0.3, 0.2]))
EXTENTS = (0.10, 0.16, 0.22)
RED, WALL = (190, 40, 30), (90, 120, 110)
WALL_M = 2.0


@lru_cache(maxsize=1)
def box() -> ObjectShape:
    mesh = trimesh.creation.box(EXTENTS)
    vertices = np.asarray(mesh.vertices, float)
    return ObjectShape("box", vertices, np.asarray(mesh.faces), vertices, np.array([1.0, 0, 0]))


@lru_cache(maxsize=1)
def viewpoints() -> Viewpoints:
    return find_viewpoints(box())


def draw(
    place: np.ndarray = PLACE, turn: np.ndarray = TURN, *, returns_depth: bool = True
) -> Image:
    """The box, each side in its own shade, with noise; the wall behind is patterned."""
    random = np.random.default_rng(1)
    pattern = random.integers(-12, 13, (24, 32, 1)).repeat(20, axis=0).repeat(20, axis=1)
    colour = np.clip(np.array(WALL) + pattern, 0, 255).astype(np.float32)
    depth = np.full((480, 640), WALL_M, np.float32)
    corners = scipy_rotation(turn).apply(box().vertices) + place
    for face in box().faces:
        a, b, c = corners[face]
        normal = np.cross(b - a, c - a)
        if normal @ a >= 0.0:
            continue
        mask = np.zeros((480, 640), np.uint8)
        cv2.fillConvexPoly(mask, np.rint(CAMERA.project(corners[face])).astype(np.int32), 1)
        rows, columns = np.nonzero(mask)
        rays = np.column_stack(((columns - 319.5) / 525.0, (rows - 239.5) / 525.0, rows**0))
        depth[rows, columns] = normal @ a / (rays @ normal) if returns_depth else 0.0
        shade = 0.6 + 0.4 * abs(normal[1]) / np.linalg.norm(normal)
        colour[rows, columns] = shade * np.array(RED)
    colour += random.normal(0.0, 4.0, colour.shape)
    return Image(None, CAMERA, depth, np.clip(colour, 0, 255).astype(np.uint8))


@lru_cache(maxsize=2)
def appearance(returns_depth: bool = True) -> Appearance:
    """Learned with the box elsewhere than where it is looked for."""
    turn = quaternion_of(Rotation.from_rotvec([-0.3, 0.8, 0.1]))
    place = np.array([-0.2, 0.1, 1.4])
    samples: list[AppearanceSample] = [
        (draw(place, turn, returns_depth=returns_depth), place, turn, None)
    ]
    learned = learn_appearance(box(), samples)
    assert learned is not None
    return learned


def sight(
    terms: tuple[SightTerm, ...] = SIGHT_TERMS,
    learned: Appearance | None = None,
    threads: int = 1,
) -> Sight:
    return Sight(box(), viewpoints(), learned, terms, threads=threads)


def view_of(eyes: Sight, image: Image, joints: np.ndarray | None = None) -> SightView:
    frame = prepare(image)
    return eyes.view(frame, eyes.learn(eyes.start(), frame, PLACE, TURN, around=0.5), joints)


def scattered(count: int, metres: float, degrees: float) -> tuple[np.ndarray, np.ndarray]:
    """Poses about the true one, by root mean squares; the true one comes first."""
    random = np.random.default_rng(2)
    shifts = random.normal(size=(count, 3)) * metres / np.sqrt(3.0)
    turns = random.normal(size=(count, 3)) * np.deg2rad(degrees) / np.sqrt(3.0)
    shifts[0] = turns[0] = 0.0
    return PLACE + shifts, quaternion_of(Rotation.from_rotvec(turns) * scipy_rotation(TURN))
