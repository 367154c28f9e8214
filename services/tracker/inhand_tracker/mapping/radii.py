"""δ, the radius of what counts as a like body pose (Darby et al. 2014, TR2)."""

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np
from scipy.spatial.distance import cdist

from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.mapping.parameters import DEFAULT_MAPPING, MappingParameters
from inhand_tracker.mapping.pose_search import PoseSearch

CHUNK = 128
"""Number of body poses that are compared with all others at once, to bound the memory."""


def cluster_radii(
    body_poses: Array,
    starts: Indices,
    participants: Sequence[str],
    on_sequence: Callable[[], None],
    parameters: MappingParameters = DEFAULT_MAPPING,
) -> Array:
    """δ of each of S sequences, (S,): the usual distance of its body poses from other
    participants'.

    ``body_poses`` (N, 60) of the sequences that begin at ``starts`` (S + 1,). It is the median,
    over the sequence, of the distance to the nearest body pose of all other participants; of the
    other recordings, where there is one participant only.

    Exact up to ``exact_frames``. Beyond, participants are dealt into groups, and a body pose is
    compared with those that its participant is not in, by approximate search. That makes δ larger
    by about a hundredth (docs/training.md).
    """
    owners = _owners(participants)
    owner_of = np.repeat(owners, np.diff(starts))
    others: _Exact | _Grouped = _Exact(body_poses, owner_of)
    if len(body_poses) > parameters.exact_frames:
        others = _Grouped(body_poses, owner_of, parameters)
    radii = []
    for (start, end), owner in zip(pairwise(starts), owners, strict=True):
        radii.append(np.median(others.distances(body_poses[start:end], owner)))
        on_sequence()
    return np.array(radii)


def _owners(participants: Sequence[str]) -> list[int]:
    """A number for each sequence: its participant's, or its own where all are of one."""
    numbers = {name: number for number, name in enumerate(dict.fromkeys(participants))}
    if len(numbers) == 1:
        return list(range(len(participants)))
    return [numbers[name] for name in participants]


class _Exact:
    """Distances to the nearest of all other owners' body poses."""

    def __init__(self, body_poses: Array, owner_of: Indices) -> None:
        self._body_poses = body_poses
        self._owner_of = owner_of

    def distances(self, poses: Array, owner: int) -> Array:
        """(M,) of an owner's body poses (M, 60)."""
        others = self._body_poses[self._owner_of != owner]
        chunks = [poses[start : start + CHUNK] for start in range(0, len(poses), CHUNK)]
        return np.concatenate([cdist(chunk, others).min(axis=1) for chunk in chunks])


class _Grouped:
    """Distances to the nearest found among the groups that an owner is not in."""

    def __init__(self, body_poses: Array, owner_of: Indices, parameters: MappingParameters) -> None:
        self._parameters = parameters
        groups = owner_of % parameters.groups
        self._searches = {
            int(group): PoseSearch(body_poses[groups == group], parameters)
            for group in np.unique(groups)
        }

    def distances(self, poses: Array, owner: int) -> Array:
        """(M,) of an owner's body poses (M, 60)."""
        return np.min(
            [
                search.nearest(poses, self._parameters.group_probes)[1]
                for group, search in self._searches.items()
                if group != owner % self._parameters.groups
            ],
            axis=0,
        )
