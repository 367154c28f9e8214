"""Where the parts of a person's body are in each frame, for poses that are relative to one."""

from itertools import pairwise

import numpy as np
from inhand_tracker.body.anchors import ANCHORS, find_anchors
from inhand_tracker.body.skeleton import Bases
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array, Indices

from inhand_lab.labelling.turning import between


def part_of(joints: Array, name: str) -> Bases:
    """Find the basis of one of ``ANCHORS`` in T frames, (T, 3) and (T, 4), of joints (T, 20, 3).

    It is NaN in frames in which a joint that it rests on is missing.
    """
    anchors = find_anchors(joints)
    index = ANCHORS.index(name)
    origins, axes = anchors.origins[:, index], anchors.axes[:, index]
    determinants = np.linalg.det(np.nan_to_num(axes))
    seen = np.isfinite(origins).all(axis=1) & (np.abs(determinants - 1.0) < 1e-6)
    turns = np.full((len(joints), 4), np.nan)
    turns[seen] = rotations.from_matrix(axes[seen])
    return Bases(np.where(seen[:, None], origins, np.nan), turns)


def filled(part: Bases, times_ns: Indices) -> Bases:
    """Fill frames in which a part is missing from those before and after, by their times (T,).

    Nothing is filled before the first frame that shows it, nor after the last.
    """
    seen = np.flatnonzero(np.isfinite(part.origins[:, 0]))
    origins, turns = part.origins.copy(), part.rotations.copy()
    for first, last in pairwise(seen):
        if last == first + 1:
            continue
        inner = np.arange(first + 1, last)
        done, span = times_ns[inner] - times_ns[first], times_ns[last] - times_ns[first]
        shares = done / span if span > 0 else np.full(len(inner), 0.5)
        ends = [(part.origins[frame], part.rotations[frame]) for frame in (first, last)]
        origins[inner], turns[inner] = between(ends[0], ends[1], shares)
    return Bases(origins, turns)
