"""A learned mapping from body poses to object poses."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


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


class BodyPoseIndex:
    """Finds training frames of like body pose."""

    def __init__(self, mapping: Mapping) -> None:
        self._mapping = mapping
        self._tree = KDTree(mapping.body_poses)

    def nearest(self, pose: Array) -> tuple[int, float]:
        """The training frame whose body pose is nearest to ``pose`` (60,), and its distance."""
        distance, frame = self._tree.query(pose)
        return int(frame), float(distance)

    def cluster(self, frame: int) -> Indices:
        """C_n: the frames of the same sequence whose body pose lies within its δ; n is one."""
        mapping = self._mapping
        sequence = int(mapping.sequence_of(np.array(frame)))
        start, end = mapping.starts[sequence : sequence + 2]
        offsets = mapping.body_poses[start:end] - mapping.body_poses[frame]
        near = np.einsum("ij,ij->i", offsets, offsets) <= mapping.radii[sequence] ** 2
        return start + np.flatnonzero(near)
