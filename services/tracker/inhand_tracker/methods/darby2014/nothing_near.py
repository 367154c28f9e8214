"""What to do with a body pose that is like none of those learned (Darby et al. 2014, section 7).

"Where there are no true nearest neighbours (a simple distance threshold could be applied), a more
pragmatic approach may be to resort to the hands for translation prediction and sample object-poses
from a wider range of body-poses."
"""

import numpy as np

from inhand_tracker.body.skeleton import LEFT_HAND, RIGHT_HAND
from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.mapping.mapping import Mapping
from inhand_tracker.methods.darby2014.parameters import DEFAULT_DARBY2014, Darby2014Parameters
from inhand_tracker.methods.darby2014.particles import Particles, rotation_parts_at
from inhand_tracker.methods.darby2014.variants import Variant

CHUNK = 8192
"""Number of training poses that are compared at once, to bound the memory."""


def farthest_near(mapping: Mapping, parameters: Darby2014Parameters = DEFAULT_DARBY2014) -> float:
    """The distance, in body heights, beyond which no training pose counts as near.

    A share ``parameters.near_share`` of the training poses has a pose of other participants (of
    other recordings, where there is one participant) within it.
    """
    people = np.unique(mapping.participants, return_inverse=True)[1]
    if people.max() == 0:
        people = np.arange(len(people))
    asked, among = (
        _spread(len(mapping.body_poses), most)
        for most in (parameters.asked_poses, parameters.compared_poses)
    )
    asked_poses, owners = mapping.body_poses[asked], people[mapping.sequence_of(asked)]
    nearest = np.full(len(asked), np.inf)
    for start in range(0, len(among), CHUNK):
        chunk = among[start : start + CHUNK]
        poses = mapping.body_poses[chunk]
        squares = np.square(poses).sum(axis=1) - 2.0 * asked_poses @ poses.T
        squares[owners[:, None] == people[mapping.sequence_of(chunk)]] = np.inf
        np.minimum(nearest, squares.min(axis=1), out=nearest)
    nearest += np.square(asked_poses).sum(axis=1)
    return float(np.sqrt(max(np.quantile(nearest, parameters.near_share), 0.0)))


def _spread(frames: int, most: int) -> Indices:
    """Evenly spaced indices into ``frames`` frames: all, or ``most`` of them."""
    return np.linspace(0, frames - 1, min(frames, most)).astype(np.int64)


def draw_broadly(
    mapping: Mapping,
    pose: Array,
    method: Variant,
    random: np.random.Generator,
    parameters: Darby2014Parameters = DEFAULT_DARBY2014,
) -> Particles:
    """Particles for a body pose (60,): each from the likest of some frames drawn from all.

    Translations are predicted from the hand that the object was nearer to in that frame, rotations
    from the method's part.
    """
    drawn = parameters.particles, parameters.breadth
    translation_frames, rotation_frames = (
        _likest(mapping, random.integers(len(mapping.body_poses), size=drawn), pose)
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
