"""The floor in the depth of calibrated cameras: the lowest large plane, with nothing beneath it."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from inhand_schemas.messages import CameraInfo
from numpy.typing import NDArray

from inhand_calibration.arrays import Array
from inhand_calibration.floor import Floor
from inhand_calibration.rigid import moved


@dataclass(frozen=True)
class DepthFloorParameters:
    """How a floor is looked for."""

    pixels: int = 1500
    """Pixels of an image that are looked at, about."""
    furthest_m: float = 5.0
    """Range beyond which depth is no evidence."""
    tries: int = 500
    """Planes through three points that are tried."""
    reach_m: float = 1.0
    """Distance between these points, at most."""
    noise_m: float = 0.006
    """Deviation of depth at 0 m, and of floors from a plane."""
    noise_growth: float = 0.004
    """Deviation of depth, metres per square metre of range."""
    steepest_deg: float = 50.0
    """Angle, at most, between the floor's normal and a camera's own up or down."""
    camera_high_m: float = 0.25
    """Height of all cameras above the floor, at least."""
    beneath: float = 0.02
    """Share of the points, at most, that may lie beneath it."""
    least: float = 0.08
    """Share of the points, at least, that lie on it."""
    tilt_rad: float = 0.005
    """Deviation of up: faults of a depth camera are alike over the picture."""
    height_m: float = 0.01
    """Deviation of its height."""


DEFAULT_DEPTH_FLOOR = DepthFloorParameters()


def depth_points(
    depth: NDArray[np.uint16],
    info: CameraInfo,
    parameters: DepthFloorParameters = DEFAULT_DEPTH_FLOOR,
) -> Array:
    """Return some points (N, 3) of a depth image (H, W) in the camera's frame, metres; the lens's
    distortion is not undone."""
    rows, columns = depth.shape
    stride = max(int(np.sqrt(rows * columns / parameters.pixels)), 1)
    v, u = np.mgrid[stride // 2 : rows : stride, stride // 2 : columns : stride]
    z = depth[v, u].ravel() * info.depth_scale
    x_scale, y_scale = info.width / columns, info.height / rows
    x = ((u.ravel() + 0.5) * x_scale - 0.5 - info.cx) / info.fx
    y = ((v.ravel() + 0.5) * y_scale - 0.5 - info.cy) / info.fy
    inside = (z > 0.0) & (z < parameters.furthest_m)
    points: Array = np.stack([x * z, y * z, z], axis=1)[inside]
    return points


def find_depth_floor(
    points: Sequence[Array],
    reference_from_camera: Array,
    parameters: DepthFloorParameters = DEFAULT_DEPTH_FLOOR,
) -> Floor | None:
    """Find the floor in points (N, 3) of each camera at its pose (C, 4, 4); None where none is."""
    joined = [moved(pose, own) for own, pose in zip(points, reference_from_camera, strict=True)]
    places = np.concatenate(joined)
    ranges = np.concatenate([own[:, 2] for own in points])
    if len(places) < 300:
        return None
    noise = np.hypot(parameters.noise_m, parameters.noise_m + parameters.noise_growth * ranges**2)
    eyes, ups = reference_from_camera[:, :3, 3], -reference_from_camera[:, :3, 1]
    best: tuple[float, Array, float] | None = None
    random = np.random.default_rng(0)
    for _ in range(parameters.tries):
        plane = _tried(places, ups, random, parameters)
        if plane is None:
            continue
        up, height = plane
        if (eyes @ up - height < parameters.camera_high_m).any():
            continue
        heights = places @ up - height
        on, beneath = np.abs(heights) < 2.0 * noise, heights < -4.0 * noise - 0.05
        score = float(on.sum() - 5.0 * beneath.sum())
        if best is None or score > best[0]:
            best = (score, up, height)
    if best is None:
        return None
    up, height = _refined(places, noise, best[1], best[2])
    heights = places @ up - height
    on, beneath = np.abs(heights) < 3.0 * noise, heights < -4.0 * noise - 0.05
    if on.mean() < parameters.least or beneath.mean() > parameters.beneath:
        return None
    return Floor(up, height, parameters.tilt_rad, parameters.height_m)


def _tried(
    places: Array, ups: Array, random: np.random.Generator, parameters: DepthFloorParameters
) -> tuple[Array, float] | None:
    """Lay a plane through three points near each other; None where it stands too steep."""
    seed = places[random.integers(len(places))]
    near = places[random.integers(len(places), size=40)]
    near = near[np.linalg.norm(near - seed, axis=1) < parameters.reach_m]
    if len(near) < 2:
        return None
    normal = np.cross(near[0] - seed, near[1] - seed)
    size = float(np.linalg.norm(normal))
    if size < 1e-3:
        return None
    up = normal / size
    level = np.abs(ups @ up) > np.cos(np.radians(parameters.steepest_deg))
    if level.sum() * 2 < len(ups):
        return None
    # More cameras stand upright than upside down.
    up = up if np.sign(ups[level] @ up).sum() >= 0.0 else -up
    return up, float(seed @ up)


def _refined(places: Array, noise: Array, up: Array, height: float) -> tuple[Array, float]:
    for limit in (3.0, 2.5, 2.5):
        on = np.abs(places @ up - height) < limit * noise
        weights = 1.0 / noise[on] ** 2
        centre = np.average(places[on], axis=0, weights=weights)
        spread = (places[on] - centre) * np.sqrt(weights)[:, None]
        _, _, axes = np.linalg.svd(spread, full_matrices=False)
        up = axes[2] if axes[2] @ up > 0.0 else -axes[2]
        height = float(centre @ up)
    return up, height
