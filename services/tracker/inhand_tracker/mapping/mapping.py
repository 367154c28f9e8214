"""A learned mapping from body poses to object poses."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.distance import cdist

from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.mapping.parameters import DEFAULT_MAPPING
from inhand_tracker.mapping.pose_search import PoseSearch


@dataclass(frozen=True)
class Mapping:
    """Training frames of S sequences, one after the other; sequence s is starts[s]:starts[s+1].

    ``participants`` (S,), ``starts`` (S + 1,), ``radii`` δ (S,), ``body_poses`` b (N, 60), the
    object relative to each part, in body heights, ``translations`` (N, 19, 3) and ``rotations``
    (N, 19, 4); ``translation_variation`` φᵉ and ``rotation_variation`` φᶿ (N,); and the parts
    that minimise ψᵉ, ψᶿ and ψ'ᵉ, each (N,). Everything is as of right-handed people.
    """

    participants: tuple[str, ...]
    starts: Indices
    radii: Array
    body_poses: Array
    translations: Array
    rotations: Array
    translation_variation: Array
    rotation_variation: Array
    stable_translation_part: Indices
    stable_rotation_part: Indices
    proximate_part: Indices

    def sequence_of(self, frames: Indices) -> Indices:
        """The sequences that training frames belong to."""
        return np.searchsorted(self.starts, frames, side="right") - 1


def stretches(frames: int, longest: int = DEFAULT_MAPPING.longest_stretch) -> Indices:
    """The starts of the stretches of a sequence with a number of frames, and its end, (K + 1,).

    A frame's cluster is looked for in its own stretch: the whole sequence, where it is no longer
    than the longest, and otherwise one of equal parts. So a cluster stays small where somebody
    pauses for long, and is found as quickly in an hour as in a minute.
    """
    count = -(-frames // longest)
    return np.arange(count + 1) * frames // count


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
