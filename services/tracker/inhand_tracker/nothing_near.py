"""What to do with a body pose that is like none of those learned (Darby et al. 2014, section 7).

"Where there are no true nearest neighbours (a simple distance threshold could be applied), a more
pragmatic approach may be to resort to the hands for translation prediction and sample object-poses
from a wider range of body-poses."
"""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.distance import cdist

from inhand_tracker.body import LEFT_HAND, RIGHT_HAND
from inhand_tracker.mapping import Mapping
from inhand_tracker.methods import Method
from inhand_tracker.particles import Particles, rotation_parts_at

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

NEAR_SHARE = 0.99
ASKED_FRAMES = 512
CHUNK = 1 << 14
BREADTH = 10


def farthest_near(mapping: Mapping) -> float:
    """The distance, in body heights, beyond which no training pose counts as near.

    Of the training poses themselves 99 % have a pose of other participants (of other recordings,
    where there is one participant) that near.
    """
    poses = mapping.body_poses
    asked = np.unique(np.linspace(0, len(poses) - 1, ASKED_FRAMES).astype(np.int64))
    people = np.array(mapping.participants)
    if len(set(mapping.participants)) == 1:
        people = np.arange(len(people))
    nearest = np.full(len(asked), np.inf)
    for start in range(0, len(poses), CHUNK):
        among = np.arange(start, min(start + CHUNK, len(poses)))
        distances = cdist(poses[asked], poses[among])
        owners = people[mapping.sequence_of(asked)][:, None], people[mapping.sequence_of(among)]
        distances[np.equal(*owners)] = np.inf
        np.minimum(nearest, distances.min(axis=1), out=nearest)
    return float(np.quantile(nearest, NEAR_SHARE))


def draw_broadly(
    count: int, mapping: Mapping, pose: Array, method: Method, random: np.random.Generator
) -> Particles:
    """Particles for a body pose (60,): each from the likest of ten frames drawn from all.

    Translations are predicted from the hand that the object was nearer to in that frame, rotations
    from the method's part.
    """
    translation_frames, rotation_frames = (
        _likest(mapping, random.integers(len(mapping.body_poses), size=(count, BREADTH)), pose)
        for _ in range(2)
    )
    return Particles(
        translation_frames,
        rotation_frames,
        _nearer_hand(mapping, translation_frames),
        rotation_parts_at(rotation_frames, mapping, method, random),
    )


def _likest(mapping: Mapping, frames: Indices, pose: Array) -> Indices:
    offsets = mapping.body_poses[frames] - pose
    likest = np.argmin(np.square(offsets).sum(axis=-1), axis=1)
    return frames[np.arange(len(frames)), likest]


def _nearer_hand(mapping: Mapping, frames: Indices) -> Indices:
    hands = np.array([RIGHT_HAND, LEFT_HAND])
    away = np.linalg.norm(mapping.translations[frames[:, None], hands], axis=-1)
    return hands[np.argmin(away, axis=1)]
