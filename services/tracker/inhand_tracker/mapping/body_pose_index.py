"""Looks training frames up by body pose."""

import numpy as np
from scipy.spatial.distance import cdist

from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.mapping.mapping import Mapping, stretches
from inhand_tracker.mapping.pose_search import PoseSearch


class BodyPoseIndex:
    """Finds training frames of like body pose."""

    def __init__(self, mapping: Mapping) -> None:
        self._mapping = mapping
        self._search = PoseSearch(mapping.body_poses)

    def nearest(self, pose: Array) -> tuple[int, float]:
        """The training frame whose body pose is nearest to ``pose`` (60,), and its distance."""
        frames, distances = self._search.nearest(pose[None])
        return int(frames[0]), float(distances[0])

    def cluster(self, frame: int) -> Indices:
        """C_n: the frames of the same stretch whose body pose lies within its δ; n is one."""
        mapping = self._mapping
        sequence = int(mapping.sequence_of(np.array(frame)))
        start, end = mapping.starts[sequence : sequence + 2]
        cuts = start + stretches(end - start)
        stretch = np.searchsorted(cuts, frame, side="right") - 1
        first, last = cuts[stretch : stretch + 2]
        poses = mapping.body_poses
        near = cdist(poses[frame : frame + 1], poses[first:last])[0] <= mapping.radii[sequence]
        return first + np.flatnonzero(near)
