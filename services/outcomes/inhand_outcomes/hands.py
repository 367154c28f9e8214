"""How far a person's hands are from a thing's surface."""

from functools import lru_cache

import numpy as np
from inhand_schemas.joints import Joint

from inhand_outcomes.arrays import Array
from inhand_outcomes.thing import Thing
from inhand_outcomes.track import Track

HANDS = (Joint.HAND_LEFT, Joint.HAND_RIGHT)
SURFACE_POINTS = 64
"""Number of points that stand for a thing's surface."""

SPACING_M = 0.03
"""Distance of the points among which they are chosen, metres: a stick has vertices at its ends
alone."""


def hand_distances(track: Track, thing: Thing) -> Array:
    """Distance (T, 2) of the left and the right hand from a thing, metres; NaN where missing."""
    hands = track.joints[:, HANDS] - track.positions[:, None]
    turned = np.einsum("tji,thj->thi", track.matrices, hands)
    points = surface_points(thing)
    return np.linalg.norm(turned[:, :, None] - points, axis=-1).min(axis=-1)


@lru_cache(maxsize=64)
def surface_points(thing: Thing) -> Array:
    """Choose points of a thing's surface that are far from each other: at most SURFACE_POINTS."""
    points = _along_edges(thing)
    chosen = [0]
    distances = np.linalg.norm(points - points[0], axis=1)
    while len(chosen) < min(SURFACE_POINTS, len(points)):
        chosen.append(int(distances.argmax()))
        distances = np.minimum(distances, np.linalg.norm(points - points[chosen[-1]], axis=1))
    return points[chosen]


def _along_edges(thing: Thing) -> Array:
    """A thing's vertices, and points on its edges where these are long, (N, 3)."""
    first, second = (
        thing.vertices[thing.faces[:, columns]].reshape(-1, 3) for columns in ((0, 1, 2), (1, 2, 0))
    )
    pieces = np.ceil(np.linalg.norm(second - first, axis=1) / SPACING_M).astype(int)
    between = [
        first[pieces == count] + share * (second - first)[pieces == count]
        for count in np.unique(pieces[pieces > 1])
        for share in np.arange(1, count) / count
    ]
    return np.concatenate([thing.vertices, *between])
