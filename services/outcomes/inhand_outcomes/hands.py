"""How far a person's hands are from a thing's surface."""

import numpy as np
from inhand_schemas.joints import Joint

from inhand_outcomes.arrays import Array
from inhand_outcomes.thing import Thing
from inhand_outcomes.track import Track

HANDS = (Joint.HAND_LEFT, Joint.HAND_RIGHT)
SURFACE_POINTS = 64
"""Number of points that stand for a thing's surface."""


def hand_distances(track: Track, thing: Thing) -> Array:
    """Distance (T, 2) of the left and the right hand from a thing, metres; NaN where missing."""
    hands = track.joints[:, HANDS] - track.positions[:, None]
    turned = np.einsum("tji,thj->thi", track.matrices, hands)
    points = surface_points(thing.vertices)
    return np.linalg.norm(turned[:, :, None] - points, axis=-1).min(axis=-1)


def surface_points(vertices: Array) -> Array:
    """Choose vertices that are far from each other, of (V, 3): at most SURFACE_POINTS."""
    chosen = [0]
    distances = np.linalg.norm(vertices - vertices[0], axis=1)
    while len(chosen) < min(SURFACE_POINTS, len(vertices)):
        chosen.append(int(distances.argmax()))
        distances = np.minimum(distances, np.linalg.norm(vertices - vertices[chosen[-1]], axis=1))
    return vertices[chosen]
