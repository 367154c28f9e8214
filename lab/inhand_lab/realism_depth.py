"""What recorded depth of one person tells of the sensor that measured it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_erosion, median_filter

from inhand_lab.joints import Joint
from inhand_lab.realism_skeletons import Figure
from inhand_lab.transforms import Floats

PATCH = 6
"""Half the width of the patch on the chest, in pixels of an image 320 wide."""
RESTING = 0.002
"""A chest that moves less than this, in metres, between two frames is at rest."""
FEWEST_HOLES = 15
"""Frames that the share of holes must rest on."""
SMOOTHED = 5
"""Width, in pixels, of the median that an outline is ragged against."""
CHEST = (Joint.SPINE, Joint.SHOULDER_CENTER)
HANDS = (Joint.WRIST_LEFT, Joint.HAND_LEFT, Joint.WRIST_RIGHT, Joint.HAND_RIGHT)
REACHING = 0.15
"""A hand is before the trunk from this far in front of the shoulders, metres."""
UPRIGHT, FACING = 25, 10
"""Pixels of an image 320 wide that the trunk is high and the hips are wide at least."""


@dataclass(frozen=True)
class DepthPair:
    """Two frames in a row: depth (240, 320) in millimetres of nothing but the person, 0 elsewhere,
    joints (20, 3) in the camera's frame, and the pinhole's focal length and centre in pixels."""

    depths: tuple[NDArray[np.uint16], NDArray[np.uint16]]
    joints: tuple[Floats, Floats]
    focal_length: float
    centre: tuple[float, float]


def measure_depth(pairs: Iterable[DepthPair]) -> list[Figure]:
    """Figures of pairs of frames, the same in the same order for any pairs."""
    seen = list(pairs)
    return [*_steps(seen), *_chest(seen), *_silhouette(seen)]


def _steps(pairs: list[DepthPair]) -> Iterator[Figure]:
    """Between the distances that are measured at all, over the distance squared."""
    levels = np.unique(np.concatenate([np.unique(pair.depths[0]) for pair in pairs]))
    levels = levels[(levels > 2000) & (levels < 3400)].astype(float)
    ratios = 1e6 * np.diff(levels) / levels[1:] ** 2
    middle = 2700.0
    for on, chosen in (
        ("2.0 to 2.7 m", levels[1:] < middle),
        ("2.7 to 3.4 m", levels[1:] > middle),
    ):
        value = float(np.median(ratios[chosen])) if chosen.any() else np.nan
        yield Figure("depth step over squared distance", "mm/m²", on, value)


def _chest(pairs: list[DepthPair]) -> Iterator[Figure]:
    roughness, changed, deviations = [], [], []
    for pair in pairs:
        before, after = (_patch(pair, frame) for frame in (0, 1))
        if before is None or after is None:
            continue
        roughness.append(_roughness(before))
        moved = np.subtract(*pair.joints)[[Joint.HIP_CENTER, *CHEST]]
        if np.linalg.norm(moved, axis=1).max() < RESTING:
            changed.append(np.mean(before != after))
            deviations.append(np.std(after - before) / np.sqrt(2.0))
    on = "chest, less its curvature"
    yield Figure("depth roughness", "mm", on, float(np.median(roughness)))
    yield Figure("depth deviation in time", "mm", "resting chest", float(np.mean(deviations)))
    yield Figure("pixels that change", "%", "resting chest", 100.0 * float(np.mean(changed)))


def _silhouette(pairs: list[DepthPair]) -> Iterator[Figure]:
    holes, ragged = [], []
    for pair in pairs:
        person = pair.depths[0] > 0
        outline = np.count_nonzero(person & ~binary_erosion(person))
        if (trunk := _trunk_behind_hand(pair)).size:
            holes.append(np.mean(trunk == 0))
        ragged.append(np.count_nonzero(person ^ median_filter(person, SMOOTHED)) / outline)
    share = 100.0 * float(np.mean(holes)) if len(holes) >= FEWEST_HOLES else np.nan
    yield Figure("holes", "%", "trunk behind a hand", share)
    yield Figure("ragged pixels", "%", "person's outline", 100.0 * float(np.mean(ragged)))


def _trunk_behind_hand(pair: DepthPair) -> NDArray[np.uint16]:
    """The depth from the shoulders' centre to the hips', and no wider than the hips; nothing where
    no hand is before it, and of people who bend or stand sideways."""
    joints = pair.joints[0]
    u, v = _project(pair, joints)
    rows = slice(v[Joint.SHOULDER_CENTER], v[Joint.HIP_CENTER])
    columns = slice(*sorted(u[[Joint.HIP_LEFT, Joint.HIP_RIGHT]]))
    inside = (rows.start <= v) & (v < rows.stop) & (columns.start <= u) & (u < columns.stop)
    before = joints[:, 2] < joints[Joint.SHOULDER_CENTER, 2] - REACHING
    upright = rows.stop - rows.start >= UPRIGHT and columns.stop - columns.start >= FACING
    if not upright or not (inside & before)[list(HANDS)].any():
        return np.zeros((0, 0), np.uint16)
    return pair.depths[0][rows, columns]


def _project(pair: DepthPair, points: Floats) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Columns and rows (N,) of points (N, 3)."""
    x, y, z = points.T
    u = np.rint(pair.centre[0] + pair.focal_length * x / z).astype(np.int64)
    v = np.rint(pair.centre[1] + pair.focal_length * y / z).astype(np.int64)
    return u, v


def _patch(pair: DepthPair, frame: int) -> Floats | None:
    """Depth around the middle of the chest, or nothing where a pixel of it is missing."""
    (u,), (v,) = _project(pair, pair.joints[0][list(CHEST)].mean(axis=0, keepdims=True))
    patch = pair.depths[frame][v - PATCH : v + PATCH + 1, u - PATCH : u + PATCH + 1]
    whole = patch.shape == (2 * PATCH + 1, 2 * PATCH + 1) and patch.all()
    return patch.astype(float) if whole else None


def _roughness(patch: Floats) -> float:
    """Deviation in millimetres from the nearest quadratic surface."""
    y, x = np.mgrid[-PATCH : PATCH + 1, -PATCH : PATCH + 1].reshape(2, -1).astype(float)
    basis = np.stack([np.ones_like(x), x, y, x * x, x * y, y * y], axis=1)
    fitted, *_ = np.linalg.lstsq(basis, patch.ravel(), rcond=None)
    return float(np.std(patch.ravel() - basis @ fitted))
