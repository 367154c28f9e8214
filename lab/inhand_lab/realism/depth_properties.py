"""Measures what recorded depth of one person shows of the sensor that took it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from inhand_schemas.joints import Joint
from inhand_tracker.geometry.arrays import Array, Indices
from numpy.typing import NDArray
from scipy.ndimage import binary_erosion, median_filter

from inhand_lab.realism.parameters import DEFAULT_REALISM
from inhand_lab.realism.skeleton_properties import SensorProperty

CHEST = (Joint.SPINE, Joint.SHOULDER_CENTER)
HANDS = (Joint.WRIST_LEFT, Joint.HAND_LEFT, Joint.WRIST_RIGHT, Joint.HAND_RIGHT)


@dataclass(frozen=True)
class DepthPair:
    """Two frames in a row: depth (240, 320) in millimetres of nothing but the person, 0 elsewhere,
    joints (20, 3) in the camera's frame, and the pinhole's focal length and centre in pixels."""

    depths: tuple[NDArray[np.uint16], NDArray[np.uint16]]
    joints: tuple[Array, Array]
    focal_length: float
    centre: tuple[float, float]


@dataclass(frozen=True)
class DepthMeasures:
    """What is measured in two frames in a row; None where it cannot be measured.

    ``levels`` (L,) are the distances in the first frame. ``roughness``, ``changed`` (a share of
    pixels) and ``deviation`` are those of the chest, ``holes`` is the share of the trunk's pixels
    without depth, which a hand is before if ``behind_hand``; ``ragged`` is a share of the outline.
    """

    levels: NDArray[np.uint16]
    roughness: float | None
    changed: float | None
    deviation: float | None
    holes: float | None
    behind_hand: bool
    ragged: float


def measure_pair(pair: DepthPair) -> DepthMeasures:
    """Measure a pair, once for all properties."""
    roughness, changed, deviation = _chest(pair)
    trunk, behind_hand = _trunk(pair)
    person = pair.depths[0] > 0
    outline = np.count_nonzero(person & ~binary_erosion(person))
    ragged = (
        np.count_nonzero(person ^ median_filter(person, DEFAULT_REALISM.smoothed_pixels)) / outline
    )
    holes = float(np.mean(trunk == 0)) if trunk.size else None
    levels = np.unique(pair.depths[0])
    return DepthMeasures(levels, roughness, changed, deviation, holes, behind_hand, ragged)


def depth_properties(seen: Sequence[DepthMeasures]) -> list[SensorProperty]:
    """Sum up pairs of frames: the same properties in the same order for any pairs."""
    return [*_steps(seen), *_noise(seen), *_silhouette(seen)]


def _steps(seen: Sequence[DepthMeasures]) -> Iterator[SensorProperty]:
    """Measure the steps between distances that occur at all, over the distance squared."""
    levels = np.unique(np.concatenate([one.levels for one in seen]))
    nearest, farthest = DEFAULT_REALISM.level_range_mm
    levels = levels[(levels > nearest) & (levels < farthest)].astype(float)
    ratios = 1e6 * np.diff(levels) / levels[1:] ** 2
    middle = DEFAULT_REALISM.middle_level_mm
    for on, chosen in (
        ("2.0 to 2.7 m", levels[1:] < middle),
        ("2.7 to 3.4 m", levels[1:] > middle),
    ):
        value = float(np.median(ratios[chosen])) if chosen.any() else np.nan
        yield SensorProperty("depth step over squared distance", "mm/m²", on, value)


def _noise(seen: Sequence[DepthMeasures]) -> Iterator[SensorProperty]:
    """Measure the noise of depth on the chest, in space and time."""
    rough = [one.roughness for one in seen if one.roughness is not None]
    value = float(np.median(rough)) if rough else np.nan
    yield SensorProperty("depth roughness", "mm", "chest, less its curvature", value)
    deviation = _mean(one.deviation for one in seen)
    yield SensorProperty("depth deviation in time", "mm", "resting chest", deviation)
    changed = 100.0 * _mean(one.changed for one in seen)
    yield SensorProperty("pixels that change", "%", "resting chest", changed)


def _silhouette(seen: Sequence[DepthMeasures]) -> Iterator[SensorProperty]:
    """Measure holes in the trunk, and how ragged the person's outline is."""
    holes = 100.0 * _mean(one.holes for one in seen)
    yield SensorProperty("holes", "%", "trunk that faces the camera", holes)
    behind = 100.0 * _mean(one.holes for one in seen if one.behind_hand)
    yield SensorProperty("holes", "%", "trunk behind a hand", behind)
    ragged = 100.0 * _mean(one.ragged for one in seen)
    yield SensorProperty("ragged pixels", "%", "person's outline", ragged)


def _mean(values: Iterable[float | None]) -> float:
    """Mean of the values that could be measured; NaN where there is none."""
    measured = [value for value in values if value is not None]
    return float(np.mean(measured)) if measured else np.nan


def _chest(pair: DepthPair) -> tuple[float | None, float | None, float | None]:
    """Measure a patch of the chest: its roughness, share of pixels that change, and deviation in
    time; the last two of a chest at rest."""
    before, after = (_patch(pair, frame) for frame in (0, 1))
    if before is None or after is None:
        return None, None, None
    moved = np.subtract(*pair.joints)[[Joint.HIP_CENTER, *CHEST]]
    if np.linalg.norm(moved, axis=1).max() >= DEFAULT_REALISM.resting_m:
        return _roughness(before), None, None
    changed, deviation = float(np.mean(before != after)), float(np.std(after - before))
    return _roughness(before), changed, deviation / np.sqrt(2.0)


def _trunk(pair: DepthPair) -> tuple[NDArray[np.uint16], bool]:
    """Cut out the trunk, from the shoulders' centre to the hips' and as wide as these; say whether
    a hand is before it. It is empty for people who bend or stand sideways."""
    joints = pair.joints[0]
    u, v = _project(pair, joints)
    rows = slice(v[Joint.SHOULDER_CENTER], v[Joint.HIP_CENTER])
    columns = slice(*sorted(u[[Joint.HIP_LEFT, Joint.HIP_RIGHT]]))
    upright = rows.stop - rows.start >= DEFAULT_REALISM.least_trunk_pixels
    facing = columns.stop - columns.start >= DEFAULT_REALISM.least_hips_pixels
    if not (upright and facing):
        return np.zeros((0, 0), np.uint16), False
    inside = (rows.start <= v) & (v < rows.stop) & (columns.start <= u) & (u < columns.stop)
    before = joints[:, 2] < joints[Joint.SHOULDER_CENTER, 2] - DEFAULT_REALISM.reaching_m
    return pair.depths[0][rows, columns], bool((inside & before)[list(HANDS)].any())


def _project(pair: DepthPair, points: Array) -> tuple[Indices, Indices]:
    """Return the columns and rows (N,) of points (N, 3)."""
    x, y, z = points.T
    u = np.rint(pair.centre[0] + pair.focal_length * x / z).astype(np.int64)
    v = np.rint(pair.centre[1] + pair.focal_length * y / z).astype(np.int64)
    return u, v


def _patch(pair: DepthPair, frame: int) -> Array | None:
    """Cut out the depth around the middle of the chest; None where a pixel of it is missing."""
    (u,), (v,) = _project(pair, pair.joints[0][list(CHEST)].mean(axis=0, keepdims=True))
    half = DEFAULT_REALISM.patch_pixels
    patch = pair.depths[frame][v - half : v + half + 1, u - half : u + half + 1]
    whole = patch.shape == (2 * half + 1, 2 * half + 1) and patch.all()
    return patch.astype(float) if whole else None


def _roughness(patch: Array) -> float:
    """Deviation in millimetres of a patch from the nearest quadratic surface."""
    half = DEFAULT_REALISM.patch_pixels
    y, x = np.mgrid[-half : half + 1, -half : half + 1].reshape(2, -1).astype(float)
    basis = np.stack([np.ones_like(x), x, y, x * x, x * y, y * y], axis=1)
    fitted, *_ = np.linalg.lstsq(basis, patch.ravel(), rcond=None)
    return float(np.std(patch.ravel() - basis @ fitted))
