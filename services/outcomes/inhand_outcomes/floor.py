"""Where the floor is, from one depth image: a plane fitted robustly, with how sure it is.

The floor is the lowest large level plane: nothing lies beneath it. People who are seen say which
way is up, roughly, and that it is below their hips and under their feet; so neither a table nor a
wall passes for it. Where that leaves a doubt the answer is None.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from inhand_schemas.joints import Joint
from inhand_schemas.messages import CameraInfo, Pose
from numpy.typing import NDArray

from inhand_outcomes.arrays import Array, Flags
from inhand_outcomes.room import CAMERA_UP, Room
from inhand_outcomes.rotations import matrices

FEET = (Joint.ANKLE_LEFT, Joint.ANKLE_RIGHT, Joint.FOOT_LEFT, Joint.FOOT_RIGHT)
HIPS = (Joint.HIP_CENTER, Joint.HIP_LEFT, Joint.HIP_RIGHT)


@dataclass(frozen=True)
class FloorParameters:
    """How a floor is looked for in a depth image."""

    points: int = 6000
    """Pixels that are looked at, at most: the time is in proportion to them."""
    furthest_m: float = 5.0
    """Range beyond which depth is no evidence: its noise grows with the square."""
    noise_m: float = 0.003
    """Deviation of depth at 0 m, and of the floor from a plane (carpets, tiles)."""
    noise_growth: float = 0.003
    """Deviation of depth, metres per square metre of range: Kinect's and stereo cameras'."""
    tries: int = 400
    """Planes through three pixels that are tried. A floor of a tenth of the image has, among
    neighbours, one triple in about ten."""
    neighbourhood_px: float = 0.25
    """Distance of the pixels of a triple, at most, as a share of the image's width."""
    level_camera_deg: float = 40.0
    """Angle, at most, between up and the up of a level camera where nobody is seen: beyond it a
    wall passes for a floor."""
    level_people_deg: float = 25.0
    """Angle, at most, between up and the spines of people: they lean and stoop."""
    least_m2: float = 0.4
    """Area of the floor that must be seen where somebody's feet are on it."""
    least_without_people_m2: float = 2.5
    """Area of it where nobody is seen: larger than tables."""
    beneath: float = 0.02
    """Share of the pixels, at most, that may lie beneath the floor: those are faults."""
    clearance_m: float = 0.06
    """Depth beneath the plane, beside the noise, from which a point lies beneath it."""
    camera_high_m: float = 0.25
    """Height of the camera above the floor, at least: a plane through the camera holds whatever is
    seen along a line."""
    foot_high_m: float = 0.18
    """Height of the lowest ankle or foot above the floor, at most, and, with half of it, below."""
    hip_high_m: float = 0.30
    """Height of hips above the floor, at least: of who sits low or squats."""
    model_deg: float = 0.25
    """Deviation of up beside what noise makes: faults of the depth camera are much alike over the
    image. As seen of simulated structured light."""
    model_m: float = 0.008
    """The same of the floor's height."""


DEFAULT_FLOOR = FloorParameters()


@dataclass(frozen=True)
class Floor:
    """The plane ``up @ p == height`` with deviations: of up (about a level axis), degrees, and of
    its height under where it was seen, metres. ``area_m2`` of it were seen."""

    up: Array
    height: float
    up_deviation_deg: float
    height_deviation_m: float
    area_m2: float = 0.0

    @property
    def room(self) -> Room:
        """The room whose floor this is."""
        return Room(self.up, self.height)

    def in_rig(self, rig_from_camera: Pose) -> "Floor":
        """A floor in the camera's frame as one of the rig's."""
        up = matrices(rig_from_camera.rotation) @ self.up
        height = self.height + float(up @ np.array(rig_from_camera.translation))
        return Floor(up, height, self.up_deviation_deg, self.height_deviation_m, self.area_m2)


@dataclass(frozen=True)
class _Points:
    """N pixels with depth: places (N, 3), and their rays (N, 3) with z = 1."""

    places: Array
    rays: Array

    def deviations(self, normal: Array, parameters: FloorParameters) -> Array:
        """Deviation (N,) of their distance to a plane of this normal (3,), metres."""
        along = parameters.noise_m + parameters.noise_growth * self.places[:, 2] ** 2
        return np.asarray(np.hypot(parameters.noise_m, along * np.abs(self.rays @ normal)))

    def area(self, normal: Array, stride_area: float) -> float:
        """Area of a plane of this normal that they stand for, square metres; ``stride_area`` is
        that of one of them 1 m ahead."""
        slant = np.abs(self.rays @ normal)
        return float(np.sum(stride_area * self.places[:, 2] ** 2 / np.maximum(slant, 0.05)))


def find_floor(
    depth: NDArray[np.uint16],
    info: CameraInfo,
    people: Sequence[Array] = (),
    parameters: FloorParameters = DEFAULT_FLOOR,
) -> Floor | None:
    """Find the floor in a depth image (H, W), in the camera's frame; None where none is sure.

    ``people`` are joints (20, 3) in the camera's frame, NaN where missing. The lens's distortion is
    not undone.
    """
    points, stride_area = _points(depth, info, parameters)
    if len(points.places) < 100:
        return None
    people = [joints for joints in people if np.isfinite(joints[HIPS, :]).all(axis=1).any()]
    usual, cone = _usual_up(people, parameters)
    found = _lowest_plane(points, depth.shape[1], info.fx, usual, cone, parameters)
    if found is None:
        return None
    up, height, on = _refined(points, *found, parameters)
    heights = points.places @ up - height
    limits = 4.0 * points.deviations(up, parameters) + parameters.clearance_m
    beneath = float(np.mean(heights < -limits)) > parameters.beneath
    if beneath or up @ usual < np.cos(cone) or height > -parameters.camera_high_m:
        return None
    floor = _Points(points.places[on], points.rays[on])
    area = floor.area(up, stride_area)
    stood_on = [_stands_on(joints, up, height, parameters) for joints in people]
    least = parameters.least_m2 if stood_on else parameters.least_without_people_m2
    if not all(stood_on) or area < least:
        return None
    return _with_deviations(floor, up, height, area, parameters)


def together(floors: Sequence[Floor]) -> Floor | None:
    """One floor of several of the same camera's; None of none, and where they disagree.

    The medians withstand a few that are wrong. What noise makes shrinks little, since the faults of
    a camera last.
    """
    if not floors:
        return None
    ups, heights = np.array([floor.up for floor in floors]), np.array([f.height for f in floors])
    up = np.median(ups, axis=0)
    up /= np.linalg.norm(up)
    height = float(np.median(heights))
    angle = float(np.median([f.up_deviation_deg for f in floors]))
    deviation = float(np.median([f.height_deviation_m for f in floors]))
    apart = np.degrees(np.arccos(np.clip(ups @ up, -1.0, 1.0)))
    if np.median(apart) > 3.0 * angle or np.median(np.abs(heights - height)) > 3.0 * deviation:
        return None
    return Floor(up, height, angle, deviation, float(np.median([f.area_m2 for f in floors])))


def _points(
    depth: NDArray[np.uint16], info: CameraInfo, parameters: FloorParameters
) -> tuple[_Points, float]:
    """Pixels on a grid that have depth, and the area of one of them 1 m ahead."""
    rows, columns = depth.shape
    stride = max(int(np.ceil(np.sqrt(rows * columns / parameters.points))), 1)
    v, u = np.mgrid[stride // 2 : rows : stride, stride // 2 : columns : stride]
    z = depth[v, u].ravel() * info.depth_scale
    fx, fy = info.fx * columns / info.width, info.fy * rows / info.height
    cx, cy = info.cx * columns / info.width, info.cy * rows / info.height
    rays = np.stack([(u.ravel() - cx) / fx, (v.ravel() - cy) / fy, np.ones(u.size)], axis=1)
    inside = (z > 0.0) & (z < parameters.furthest_m)
    rays = rays[inside]
    return _Points(rays * z[inside, None], rays), stride**2 / (fx * fy)


def _usual_up(people: Sequence[Array], parameters: FloorParameters) -> tuple[Array, float]:
    """About where up is, and how far from there it may be, radians."""
    spines = []
    for joints in people:
        spine = joints[Joint.SHOULDER_CENTER] - joints[Joint.HIP_CENTER]
        if np.isfinite(spine).all() and np.linalg.norm(spine) > 0.1:
            spines.append(spine / np.linalg.norm(spine))
    if not spines:
        return CAMERA_UP, np.radians(parameters.level_camera_deg)
    up = np.median(spines, axis=0)
    return up / np.linalg.norm(up), np.radians(parameters.level_people_deg)


def _lowest_plane(
    points: _Points,
    columns: int,
    focal: float,
    usual: Array,
    cone: float,
    parameters: FloorParameters,
) -> tuple[Array, float] | None:
    """The plane through three pixels that holds the most, less what lies beneath it."""
    random = np.random.default_rng(0)
    # The lower half along up has the floor; any seed pixel will do, since the rest decides.
    seeds = random.integers(len(points.places), size=parameters.tries)
    reach = parameters.neighbourhood_px * columns / focal
    triples = [points.places[seeds]]
    for _ in range(2):
        near = points.rays[seeds, :2] + random.uniform(-reach, reach, (parameters.tries, 2))
        others = _nearest(points.rays[:, :2], near)
        triples.append(points.places[others])
    normals = np.cross(triples[1] - triples[0], triples[2] - triples[0])
    sizes = np.linalg.norm(normals, axis=1)
    normals = normals[sizes > 1e-4] / sizes[sizes > 1e-4, None]
    seeds = seeds[sizes > 1e-4]
    normals *= np.where(normals @ usual < 0.0, -1.0, 1.0)[:, None]
    level = normals @ usual > np.cos(cone)
    best: tuple[float, Array, float] | None = None
    for normal, seed in zip(normals[level], seeds[level], strict=True):
        height = float(points.places[seed] @ normal)
        if height > -parameters.camera_high_m:
            continue
        heights = points.places @ normal - height
        deviations = points.deviations(normal, parameters)
        on = np.abs(heights) < 3.0 * deviations + parameters.noise_m
        beneath = heights < -(4.0 * deviations + parameters.clearance_m)
        slant = np.maximum(np.abs(points.rays @ normal), 0.05)
        weight = points.places[:, 2] ** 2 / slant
        score = float(weight[on].sum() - 3.0 * weight[beneath].sum())
        if best is None or score > best[0]:
            best = (score, normal, height)
    return None if best is None or best[0] <= 0.0 else (best[1], best[2])


def _nearest(rays: Array, wanted: Array) -> NDArray[np.int64]:
    """Index (M,) of the ray (N, 2), in rows from above, that is about nearest to each of (M, 2)."""
    order = np.lexsort((rays[:, 0], rays[:, 1]))
    rows, starts = np.unique(rays[order, 1], return_index=True)
    ends = np.append(starts[1:], len(order))
    found = np.clip(np.searchsorted(rows, wanted[:, 1]), 0, len(rows) - 1)
    indices = np.empty(len(wanted), np.int64)
    for number, row in enumerate(found):
        across = rays[order[starts[row] : ends[row]], 0]
        at = min(int(np.searchsorted(across, wanted[number, 0])), len(across) - 1)
        indices[number] = order[starts[row] + at]
    return indices


def _refined(
    points: _Points, up: Array, height: float, parameters: FloorParameters
) -> tuple[Array, float, Flags]:
    """The plane by weighted least squares, and which points are on it."""
    on = np.zeros(len(points.places), bool)
    for limit in (4.0, 3.0, 2.5, 2.5):
        deviations = points.deviations(up, parameters)
        on = np.abs(points.places @ up - height) < limit * deviations + parameters.noise_m
        weights = 1.0 / deviations[on] ** 2
        centre = np.average(points.places[on], axis=0, weights=weights)
        spread = (points.places[on] - centre) * np.sqrt(weights)[:, None]
        _, _, axes = np.linalg.svd(spread, full_matrices=False)
        normal = axes[2] if axes[2] @ up > 0.0 else -axes[2]
        up, height = normal, float(centre @ normal)
    return up, height, on


def _stands_on(joints: Array, up: Array, height: float, parameters: FloorParameters) -> bool:
    """Whether somebody's hips are above a floor, and the lowest of their feet, if seen, on it."""
    heights = joints @ up - height
    if np.nanmin(heights[list(HIPS)]) < parameters.hip_high_m:
        return False
    feet = heights[list(FEET)]
    if not np.isfinite(feet).any():
        return True
    high = parameters.foot_high_m
    return bool(-0.5 * high < np.nanmin(feet) < high)


def _with_deviations(
    floor: _Points, up: Array, height: float, area: float, parameters: FloorParameters
) -> Floor:
    """The floor with what noise and the faults of depth cameras make of it.

    Neighbouring pixels err alike: only one in about thirty counts.
    """
    weights = 1.0 / (30.0 * floor.deviations(up, parameters) ** 2)
    centre = np.average(floor.places, axis=0, weights=weights)
    spread = (floor.places - centre) * np.sqrt(weights)[:, None]
    information = np.linalg.svd(spread, compute_uv=False)
    by_noise = np.degrees(1.0 / max(float(information[1]), 1e-9))
    angle = float(np.hypot(by_noise, parameters.model_deg))
    deviation = float(np.hypot(1.0 / np.sqrt(weights.sum()), parameters.model_m))
    return Floor(up, height, angle, deviation, area)
