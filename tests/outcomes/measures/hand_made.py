"""Tracks and things made by hand."""

import numpy as np
from inhand_outcomes.thing import Thing
from inhand_outcomes.track import Track
from scipy.spatial.transform import Rotation

BOX_FACES = np.array(
    [
        *((0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1)),
        *((2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)),
    ]
)


def box(low, high):
    """The eight corners (8, 3) of a box."""
    return np.array(
        [(x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
    )


def thing(use, *boxes, parts=None):
    """A thing of boxes (low, high)."""
    vertices = np.concatenate([box(*one) for one in boxes])
    faces = np.concatenate([BOX_FACES + 8 * number for number in range(len(boxes))])
    return Thing(use, use, vertices.astype(float), faces, parts or {})


def track(
    times, positions, rotations=None, *, seen=None, error_m=0.005, error_deg=1.0, joints=None
):
    """A track of positions (T, 3) and T rotations, in a room with a floor."""
    count = len(times)
    turned = Rotation.identity(count) if rotations is None else rotations
    covariance = np.diag([error_m**2] * 3 + [np.radians(error_deg) ** 2] * 3)
    return Track(
        np.asarray(times, float),
        np.hstack([positions, turned.as_quat(canonical=True, scalar_first=True)]),
        np.tile(covariance, (count, 1, 1)),
        np.ones(count, bool) if seen is None else seen,
        np.full((count, 20, 3), np.nan) if joints is None else joints,
    )


def minimum_jerk(share):
    """Progress of a movement from rest to rest."""
    s = np.clip(share, 0.0, 1.0)
    return s**3 * (10.0 - 15.0 * s + 6.0 * s**2)


def moved(times, keys):
    """Values (T, K) through keys (time, value), at rest at each."""
    at = [key[0] for key in keys]
    values = np.array([key[1] for key in keys], float).reshape(len(keys), -1)
    result = np.repeat(values[:1], len(times), axis=0)
    for number in range(1, len(keys)):
        share = minimum_jerk((times - at[number - 1]) / (at[number] - at[number - 1]))
        result = result + share[:, None] * (values[number] - values[number - 1])
    return result
