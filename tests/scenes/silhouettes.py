"""What of an image an object would cover, by another program than the simulator's."""

import cv2
import numpy as np
from inhand_lab.world.simulation import Simulation
from inhand_tracker.geometry.arrays import Flags

FINER = 32


def silhouette(simulation: Simulation, frame: int) -> Flags:
    """The pixels of the object alone by OpenCV: filled 32 times finer, taken at pixel centres."""
    lens, pose = simulation.intrinsics, simulation.camera_from_object[frame]
    points = simulation.object_model.vertices @ pose.rotation.T + pose.translation
    pixels = points[:, :2] / points[:, 2:] * (lens.fx, lens.fy) + (lens.cx, lens.cy)
    corner = np.floor(pixels.min(axis=0)).astype(int) - 2
    width, height = np.ceil(pixels.max(axis=0)).astype(int) + 2 - corner
    fine = np.zeros((height * FINER, width * FINER), np.uint8)
    for triangle in pixels[simulation.object_model.faces]:
        cv2.fillConvexPoly(fine, np.rint((triangle - corner) * FINER).astype(np.int32), 1)
    rows, columns = np.nonzero(fine[::FINER, ::FINER])
    rows, columns = rows + corner[1], columns + corner[0]
    inside = (rows >= 0) & (rows < lens.height) & (columns >= 0) & (columns < lens.width)
    mask = np.zeros((lens.height, lens.width), bool)
    mask[rows[inside], columns[inside]] = True
    return mask
