"""What recorded depth of one person tells of the sensor that measured it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from inhand_schemas.joints import Joint
from inhand_tracker.geometry.arrays import Array, Indices
from numpy.typing import NDArray
from scipy.ndimage import binary_erosion, median_filter

from inhand_lab.realism.skeletons import Figure

PATCH = 6
"""Half the width of the patch on the chest, in pixels of an image 320 wide."""
RESTING = 0.002
"""A chest that moves less than this, in metres, between two frames is at rest."""
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
    joints: tuple[Array, Array]
    focal_length: float
    centre: tuple[float, float]


@dataclass(frozen=True)
class SeenDepth:
    """What two frames in a row tell: the distances (L,) in the first one, and the rest as in the
    figures, nothing where it cannot be told."""

    levels: NDArray[np.uint16]
    roughness: float | None
    changed: float | None
    deviation: float | None
    holes: float | None
    behind_hand: bool
    ragged: float


def observe_depth(pair: DepthPair) -> SeenDepth:
    """What is measured of a pair, once."""
    roughness, changed, deviation = _chest(pair)
    trunk, behind_hand = _trunk(pair)
    person = pair.depths[0] > 0
    outline = np.count_nonzero(person & ~binary_erosion(person))
    ragged = np.count_nonzero(person ^ median_filter(person, SMOOTHED)) / outline
    holes = float(np.mean(trunk == 0)) if trunk.size else None
    levels = np.unique(pair.depths[0])
    return SeenDepth(levels, roughness, changed, deviation, holes, behind_hand, ragged)


def measure_depth(seen: Sequence[SeenDepth]) -> list[Figure]:
    """Figures of pairs of frames, the same in the same order for any pairs."""
    return [*_steps(seen), *_noise(seen), *_silhouette(seen)]


def _steps(seen: Sequence[SeenDepth]) -> Iterator[Figure]:
    """Between the distances that are measured at all, over the distance squared."""
    levels = np.unique(np.concatenate([one.levels for one in seen]))
    levels = levels[(levels > 2000) & (levels < 3400)].astype(float)
    ratios = 1e6 * np.diff(levels) / levels[1:] ** 2
    middle = 2700.0
    for on, chosen in (
        ("2.0 to 2.7 m", levels[1:] < middle),
        ("2.7 to 3.4 m", levels[1:] > middle),
    ):
        value = float(np.median(ratios[chosen])) if chosen.any() else np.nan
        yield Figure("depth step over squared distance", "mm/m²", on, value)


def _noise(seen: Sequence[SeenDepth]) -> Iterator[Figure]:
    rough = [one.roughness for one in seen if one.roughness is not None]
    value = float(np.median(rough)) if rough else np.nan
    yield Figure("depth roughness", "mm", "chest, less its curvature", value)
    deviation = _mean(one.deviation for one in seen)
    yield Figure("depth deviation in time", "mm", "resting chest", deviation)
    changed = 100.0 * _mean(one.changed for one in seen)
    yield Figure("pixels that change", "%", "resting chest", changed)


def _silhouette(seen: Sequence[SeenDepth]) -> Iterator[Figure]:
    holes = 100.0 * _mean(one.holes for one in seen)
    yield Figure("holes", "%", "trunk that faces the camera", holes)
    behind = 100.0 * _mean(one.holes for one in seen if one.behind_hand)
    yield Figure("holes", "%", "trunk behind a hand", behind)
    ragged = 100.0 * _mean(one.ragged for one in seen)
    yield Figure("ragged pixels", "%", "person's outline", ragged)


def _mean(values: Iterable[float | None]) -> float:
    told = [value for value in values if value is not None]
    return float(np.mean(told)) if told else np.nan


def _chest(pair: DepthPair) -> tuple[float | None, float | None, float | None]:
    """Roughness, share of pixels that change and deviation in time of a patch of the chest; the
    last two only of a chest at rest."""
    before, after = (_patch(pair, frame) for frame in (0, 1))
    if before is None or after is None:
        return None, None, None
    moved = np.subtract(*pair.joints)[[Joint.HIP_CENTER, *CHEST]]
    if np.linalg.norm(moved, axis=1).max() >= RESTING:
        return _roughness(before), None, None
    changed, deviation = float(np.mean(before != after)), float(np.std(after - before))
    return _roughness(before), changed, deviation / np.sqrt(2.0)


def _trunk(pair: DepthPair) -> tuple[NDArray[np.uint16], bool]:
    """The depth from the shoulders' centre to the hips', and no wider than the hips, and whether a
    hand is before it; nothing of people who bend or stand sideways."""
    joints = pair.joints[0]
    u, v = _project(pair, joints)
    rows = slice(v[Joint.SHOULDER_CENTER], v[Joint.HIP_CENTER])
    columns = slice(*sorted(u[[Joint.HIP_LEFT, Joint.HIP_RIGHT]]))
    if rows.stop - rows.start < UPRIGHT or columns.stop - columns.start < FACING:
        return np.zeros((0, 0), np.uint16), False
    inside = (rows.start <= v) & (v < rows.stop) & (columns.start <= u) & (u < columns.stop)
    before = joints[:, 2] < joints[Joint.SHOULDER_CENTER, 2] - REACHING
    return pair.depths[0][rows, columns], bool((inside & before)[list(HANDS)].any())


def _project(pair: DepthPair, points: Array) -> tuple[Indices, Indices]:
    """Columns and rows (N,) of points (N, 3)."""
    x, y, z = points.T
    u = np.rint(pair.centre[0] + pair.focal_length * x / z).astype(np.int64)
    v = np.rint(pair.centre[1] + pair.focal_length * y / z).astype(np.int64)
    return u, v


def _patch(pair: DepthPair, frame: int) -> Array | None:
    """Depth around the middle of the chest, or nothing where a pixel of it is missing."""
    (u,), (v,) = _project(pair, pair.joints[0][list(CHEST)].mean(axis=0, keepdims=True))
    patch = pair.depths[frame][v - PATCH : v + PATCH + 1, u - PATCH : u + PATCH + 1]
    whole = patch.shape == (2 * PATCH + 1, 2 * PATCH + 1) and patch.all()
    return patch.astype(float) if whole else None


def _roughness(patch: Array) -> float:
    """Deviation in millimetres from the nearest quadratic surface."""
    y, x = np.mgrid[-PATCH : PATCH + 1, -PATCH : PATCH + 1].reshape(2, -1).astype(float)
    basis = np.stack([np.ones_like(x), x, y, x * x, x * y, y * y], axis=1)
    fitted, *_ = np.linalg.lstsq(basis, patch.ravel(), rcond=None)
    return float(np.std(patch.ravel() - basis @ fitted))
