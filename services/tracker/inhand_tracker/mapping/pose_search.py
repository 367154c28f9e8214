"""The nearest of many body poses, by inverted lists (Faiss).

Poses are kept in lists around centres, and a search looks through the lists whose centres are
nearest to what is asked for. A k-d tree must look at many more poses, because the noise of a
skeleton fills all 60 dimensions (docs/training.md).
"""

import faiss
import numpy as np

from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.mapping.parameters import DEFAULT_MAPPING, MappingParameters

CHUNK = 65_536
"""Number of poses that are converted to single precision at once, to bound the memory."""


class PoseSearch:
    """Finds the nearest of N body poses (N, D), compared in single precision.

    Up to 32,000 poses (lists of 500, times 64 probes) nothing is missed.
    """

    def __init__(self, poses: Array, parameters: MappingParameters = DEFAULT_MAPPING) -> None:
        count, width = poses.shape
        lists = max(1, count // parameters.list_length)
        self._index = faiss.IndexIVFFlat(faiss.IndexFlatL2(width), width, lists)
        self._index.cp.niter = parameters.training_rounds
        self._index.cp.min_points_per_centroid = 1
        every = max(1, count // (lists * parameters.training_poses_per_list))
        self._index.train(poses[::every].astype(np.float32))
        for start in range(0, count, CHUNK):
            self._index.add(poses[start : start + CHUNK].astype(np.float32))

    def nearest(self, asked: Array, probes: int = DEFAULT_MAPPING.probes) -> tuple[Indices, Array]:
        """The poses nearest to each of (M, D), (M,), and their distances, (M,)."""
        self._index.nprobe = probes
        squares, frames = self._index.search(asked.astype(np.float32), 1)
        return frames[:, 0], np.sqrt(squares[:, 0].astype(np.float64))
