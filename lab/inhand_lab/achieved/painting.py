"""True painting: strokes of the bristles on the board, and the area that they covered."""

import cv2
import numpy as np
from scipy.signal import find_peaks

from inhand_lab.achieved.true_achievement import TrueAchievement
from inhand_lab.objects.paint_brush import BRISTLES_BELOW
from inhand_lab.world.simulation import Simulation

EDGE = np.array([[0.034, 0.0, -BRISTLES_BELOW], [-0.034, 0.0, -BRISTLES_BELOW]])
"""The ends of the bristles' edge."""
LEAST_STROKE_M = 0.10
"""Height by which a stroke goes up or down, at least."""
PIXEL_M = 0.005


def true_painting(simulation: Simulation) -> list[TrueAchievement]:
    """One painting from the first bout of strokes to the end of the last; dips are part of it.

    The board is upright, and strokes go up and down; its plane is that in which x is across it.
    """
    pose = simulation.camera_from_world.inverse() @ simulation.camera_from_object
    edges = np.stack([pose.apply(end) for end in EDGE], axis=1)[:, :, 1:]
    times = np.arange(simulation.frames) / simulation.frame_rate
    bouts = [s for s in simulation.stages if s.name == "strokes" and s.end <= times[-1]]
    if not bouts:
        return []
    strokes, image = 0, np.zeros((600, 1000), np.uint8)
    low = edges.min(axis=(0, 1))
    for bout in bouts:
        inside = np.flatnonzero((times >= bout.start) & (times <= bout.end))
        height = edges[inside].mean(axis=1)[:, 1]
        tops = find_peaks(height, prominence=LEAST_STROKE_M)[0]
        bottoms = find_peaks(-height, prominence=LEAST_STROKE_M)[0]
        strokes += len(tops) + len(bottoms) + 1
        for frame in inside[:-1]:
            both = (edges[frame : frame + 2].reshape(-1, 2) - low) / PIXEL_M
            hull = cv2.convexHull(both.astype(np.float32))
            cv2.fillConvexPoly(image, np.rint(hull - 0.5).astype(np.int32), 1)
    amounts = {
        "duration_s": bouts[-1].end - bouts[0].start,
        "area_m2": float(image.sum()) * PIXEL_M**2,
        "stroke_count": float(strokes),
    }
    return [TrueAchievement("painting", bouts[0].start, bouts[-1].end, amounts)]
