"""The floor from feet that rest on it, and up from people who walk upright.

A plane through the places where ankles rested, by robust least squares, together with the way from
the feet to the shoulders; then an ankle's height is taken off.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from inhand_schemas.joints import Joint

from inhand_calibration.arrays import Array, Indices
from inhand_calibration.floor import Floor
from inhand_calibration.from_people.estimate import CameraEstimate
from inhand_calibration.from_people.parameters import FloorParameters
from inhand_calibration.from_people.tracks import Track

_ANKLES = (Joint.ANKLE_LEFT, Joint.ANKLE_RIGHT)
_BODY = (*_ANKLES, Joint.SHOULDER_CENTER, Joint.HEAD)
_ITERATIONS = 10


@dataclass(frozen=True)
class _Walkers:
    """N moments of people: ankles and their speeds (N, 2, 3), (N, 2); shoulders, heads (N, 3)."""

    ankles: Array
    speeds: Array
    shoulders: Array
    heads: Array


def find_standing_floor(
    tracks: Sequence[Sequence[Track]],
    estimates: Sequence[CameraEstimate],
    parameters: FloorParameters,
) -> Floor | None:
    """Find the floor from all cameras' movements; None where too few feet rested in view."""
    seen = [_of_camera(own, estimate) for own, estimate in zip(tracks, estimates, strict=True)]
    walkers = _Walkers(
        *(np.concatenate([getattr(one, name) for one in seen]) for name in vars(seen[0]))
    )
    if not len(walkers.ankles):
        return None
    ways = walkers.shoulders - walkers.ankles.mean(axis=1)
    body_up = np.median(ways / np.linalg.norm(ways, axis=1, keepdims=True), axis=0)
    body_up /= np.linalg.norm(body_up)
    places = _resting_places(walkers, body_up, parameters)
    if len(places) < parameters.least_places:
        return None
    up, information, spread = _fitted(places, body_up, parameters)
    tall = np.median((walkers.heads - walkers.ankles.min(axis=1)) @ up)
    height = float(_robust_height(places @ up, parameters) - parameters.ankle_share * tall)
    tilt = float(np.sqrt(np.linalg.inv(information).trace() / 2.0))
    return Floor(
        up,
        height,
        float(np.hypot(tilt, parameters.surest_rad)),
        float(np.hypot(spread / np.sqrt(len(places)), parameters.ankle_deviation_m)),
    )


def _of_camera(tracks: Sequence[Track], estimate: CameraEstimate) -> _Walkers:
    """Nodes of a camera's movements at which the body is seen from ankles to head."""
    joints, speeds = [np.zeros((0, len(_BODY), 3))], [np.zeros((0, 2))]
    for track in tracks:
        whole = (track.support[:, _BODY] > 0.0).all(axis=1)
        joints.append(estimate.seen_through(track.positions[whole][:, _BODY]))
        speeds.append(np.linalg.norm(track.velocities[whole][:, _ANKLES], axis=2))
    body = np.concatenate(joints)
    return _Walkers(body[:, :2], np.concatenate(speeds), body[:, 2], body[:, 3])


def _resting_places(walkers: _Walkers, up: Array, parameters: FloorParameters) -> Array:
    """Places (P, 3) where ankles rested, each the median of those within a square of the floor."""
    heights = walkers.ankles @ up
    low = heights <= heights.min(axis=1, keepdims=True) + parameters.lower_m
    resting = walkers.ankles[(walkers.speeds <= parameters.still_m_s) & low]
    across = resting @ _level_axes(up).T
    _, place = np.unique(np.floor(across / parameters.stay_m), axis=0, return_inverse=True)
    of_place: Indices = place.reshape(-1)
    return np.array(
        [
            np.median(resting[of_place == index], axis=0)
            for index in range(int(of_place.max(initial=-1)) + 1)
        ]
    ).reshape(-1, 3)


def _fitted(places: Array, body_up: Array, p: FloorParameters) -> tuple[Array, Array, float]:
    """Up (3,), its information (2, 2) and the deviation of places from the plane."""
    up, information, spread = body_up, np.eye(2), p.foot_deviation_m
    for _ in range(_ITERATIONS):
        level = _level_axes(up)
        heights = places @ up - _robust_height(places @ up, p)
        weights = 1.0 / (1.0 + (heights / (2.0 * p.foot_deviation_m)) ** 2)
        spread = float(max(np.sqrt(np.average(heights**2, weights=weights)), 1e-3))
        by_feet = weights / max(spread, p.foot_deviation_m / 2.0) ** 2
        across = (places - np.average(places, axis=0, weights=weights)) @ level.T
        information = np.eye(2) / p.lean_rad**2 + (across * by_feet[:, None]).T @ across
        push = level @ body_up / p.lean_rad**2 - (across * by_feet[:, None]).T @ heights
        up = up + np.linalg.solve(information, push) @ level
        up = up / np.linalg.norm(up)
    return up, information, spread


def _robust_height(heights: Array, parameters: FloorParameters) -> float:
    """The height that most of heights (P,) are near."""
    height = float(np.median(heights))
    for _ in range(_ITERATIONS):
        off = (heights - height) / (2.0 * parameters.foot_deviation_m)
        height = float(np.average(heights, weights=1.0 / (1.0 + off**2)))
    return height


def _level_axes(up: Array) -> Array:
    """Two unit vectors (2, 3) across up (3,), square to each other."""
    side = np.eye(3)[int(np.argmin(np.abs(up)))]
    first = np.cross(up, side)
    first = first / np.linalg.norm(first)
    return np.stack([first, np.cross(up, first)])
