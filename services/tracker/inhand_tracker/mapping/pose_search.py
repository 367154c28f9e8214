"""The nearest of many body poses, by inverted lists (Faiss).

Poses are kept in lists of about 500 around centres, and a search looks through the lists whose
centres are nearest to what is asked for. Of a million body poses, 64 of the 2,000 lists hold the
nearest one practically always; a k-d tree must look at many more, because the noise of a skeleton
fills all 60 dimensions (docs/training.md).
"""

import faiss
import numpy as np

from inhand_tracker.geometry.arrays import Array, Indices

LIST_LENGTH = 500
PROBES = 64

TRAINING_POSES_PER_LIST = 40
TRAINING_ROUNDS = 5
CHUNK = 65_536


class PoseSearch:
    """Finds the nearest of N body poses (N, D), compared in single precision.

    Up to 32,000 poses all lists are looked through, and nothing is missed.
    """

    def __init__(self, poses: Array) -> None:
        count, width = poses.shape
        lists = max(1, count // LIST_LENGTH)
        self._index = faiss.IndexIVFFlat(faiss.IndexFlatL2(width), width, lists)
        self._index.cp.niter = TRAINING_ROUNDS
        self._index.cp.min_points_per_centroid = 1
        every = max(1, count // (lists * TRAINING_POSES_PER_LIST))
        self._index.train(poses[::every].astype(np.float32))
        for start in range(0, count, CHUNK):
            self._index.add(poses[start : start + CHUNK].astype(np.float32))

    def nearest(self, asked: Array, probes: int = PROBES) -> tuple[Indices, Array]:
        """The poses nearest to each of (M, D), (M,), and their distances, (M,)."""
        self._index.nprobe = probes
        squares, found = self._index.search(asked.astype(np.float32), 1)
        return found[:, 0], np.sqrt(squares[:, 0].astype(np.float64))
