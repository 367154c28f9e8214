"""Pictures of rooms of many muted colours, in a light, with somebody in the middle."""

import cv2
import numpy as np
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.image import Image
from inhand_tracker.sight.light import scale_colours

ROOM_CAMERA = Intrinsics(300.0, 300.0, 159.5, 119.5, 320, 240)
USUAL, BLUER, REDDER = (1.0, 1.0, 1.0), (0.85, 1.0, 1.15), (1.15, 1.0, 0.85)
PERSON_M, WALL_M = 2.0, 3.2
JOINTS = np.column_stack((np.zeros((20, 2)), np.full(20, PERSON_M)))


def room(seed: int = 0, light: tuple[float, float, float] = USUAL) -> Image:
    """A wall of 192 colours, each 20 pixels wide and high, and somebody in grey before it."""
    random = np.random.default_rng(seed)
    shades = random.uniform(60.0, 180.0, (12, 16, 1)) + random.normal(0.0, 15.0, (12, 16, 3))
    colour = np.kron(shades, np.ones((20, 20, 1)))
    depth = np.full((240, 320), WALL_M, np.float32)
    colour[40:, 130:190], depth[40:, 130:190] = 120.0, PERSON_M
    lit = scale_colours(np.clip(np.rint(colour), 0, 255).astype(np.uint8), np.array(light))
    return Image(None, ROOM_CAMERA, depth, lit)


def with_person_in(image: Image, colour: tuple[int, int, int]) -> Image:
    """The picture with the person, and whatever is as near, in one colour."""
    assert image.colour is not None
    assert image.depth is not None
    painted = image.colour.copy()
    painted[image.depth == np.float32(PERSON_M)] = colour
    return Image(None, image.camera, image.depth, painted)


def smaller_depth(image: Image) -> Image:
    """The picture with depth of half its width and height."""
    assert image.depth is not None
    depth = cv2.resize(image.depth, (160, 120), interpolation=cv2.INTER_NEAREST)
    return Image(None, image.camera, np.asarray(depth, np.float32), image.colour)


def narrow(image: Image) -> Image:
    """The picture of a room in which everything is as near as the person."""
    return Image(None, image.camera, np.full((240, 320), PERSON_M, np.float32), image.colour)
