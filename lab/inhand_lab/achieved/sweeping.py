"""True sweeping: strokes with the broom's head on the floor, and the floor that it passed over."""

import cv2
import numpy as np
from inhand_tracker.geometry.arrays import Array, Flags

from inhand_lab.achieved.true_achievement import TrueAchievement
from inhand_lab.geometry.transforms import Transform
from inhand_lab.motions.performance import ContactKind
from inhand_lab.motions.timeline import Stage
from inhand_lab.world.simulation import Simulation

ON_FLOOR_M = 0.015
"""Height of the lowest bristles up to which they sweep."""
MOVES_M_S = 0.05
"""Speed of the head from which it sweeps."""
PIXEL_M = 0.01
TIPS_M = 0.01
"""Vertices that are no more than this above the lowest are the bristles' tips."""


def true_sweeping(simulation: Simulation) -> list[TrueAchievement]:
    """One sweeping from the first stroke's start to the last one's end."""
    strokes = _strokes(simulation)
    if not strokes:
        return []
    amounts = {
        "duration_s": strokes[-1].end - strokes[0].start,
        "area_m2": len(swept_floor(simulation)) * PIXEL_M**2,
        "stroke_count": float(len(strokes)),
    }
    return [TrueAchievement("sweeping", strokes[0].start, strokes[-1].end, amounts)]


def swept_floor(simulation: Simulation) -> Array:
    """Points (N, 3) of the floor, one for each square centimetre that was swept, in the camera.

    What the broom touches on its way from its place and back is not swept.
    """
    strokes = _strokes(simulation)
    if not strokes:
        return np.empty((0, 3))
    world_from_camera = simulation.camera_from_world.inverse()
    pose = world_from_camera @ simulation.camera_from_object
    corners, sweeps = _tips(pose, simulation.object_model.vertices)
    sweeps &= simulation.contact != ContactKind.RESTING
    middle = corners.mean(axis=1)
    speed = np.linalg.norm(np.gradient(middle, axis=0), axis=1) * simulation.frame_rate
    times = np.arange(simulation.frames) / simulation.frame_rate
    sweeps &= (speed > MOVES_M_S) & (times >= strokes[0].start) & (times <= strokes[-1].end)
    if not sweeps.any():
        return np.empty((0, 3))
    low = corners[sweeps].min(axis=(0, 1)) - 0.1
    size = np.ceil((corners[sweeps].max(axis=(0, 1)) + 0.1 - low) / PIXEL_M).astype(int)
    image = np.zeros((size[1], size[0]), np.uint8)
    for frame in np.flatnonzero(sweeps[1:] & sweeps[:-1]):
        both = (corners[frame : frame + 2].reshape(-1, 2) - low) / PIXEL_M
        hull = cv2.convexHull(both.astype(np.float32))
        cv2.fillConvexPoly(image, np.rint(hull - 0.5).astype(np.int32), 1)
    rows, columns = np.nonzero(image)
    level = low + PIXEL_M * (np.stack([columns, rows], axis=1) + 0.5)
    return np.asarray(
        simulation.camera_from_world.apply(np.column_stack([level, np.zeros(len(level))]))
    )


def _strokes(simulation: Simulation) -> list[Stage]:
    """The strokes that end before the recording does."""
    end = (simulation.frames - 1) / simulation.frame_rate
    return [s for s in simulation.stages if s.name == "stroke" and s.end <= end]


def _tips(pose: Transform, vertices: Array) -> tuple[Array, Flags]:
    """Where the corners (T, K, 2) of the bristles are above the floor, and whether (T,) on it."""
    tips = vertices[vertices[:, 2] < vertices[:, 2].min() + TIPS_M]
    turned = np.einsum("tij,kj->tki", pose.rotation, tips) + pose.translation[:, None]
    return turned[..., :2], turned[..., 2].min(axis=1) < ON_FLOOR_M
