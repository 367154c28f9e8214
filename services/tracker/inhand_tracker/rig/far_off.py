"""Finds a camera so far from where it is said to be that its people are taken for other people.

Nobody is then seen by it and by the others, so nothing of it is compared (``agreement``). But the
one whom it sees alone moves as the one does whom the others see: one turn and shift lays all that
it saw for seconds on what they saw then, and not on what they saw at other times of these seconds.
"""

from collections import deque
from dataclasses import dataclass

import numpy as np

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.rig.agreement import FEWEST_JOINTS
from inhand_tracker.rig.parameters import DEFAULT_RIG, RigParameters


@dataclass(frozen=True)
class _Moment:
    """One person's joints (20, 3) as a camera has them, and as the others have them."""

    time_ns: int
    own: Array
    others: Array


class FarOff:
    """Watches the only person of a camera who is not the only person of the others."""

    def __init__(self, parameters: RigParameters = DEFAULT_RIG) -> None:
        self._parameters = parameters
        self._moments: dict[str, deque[_Moment]] = {}

    def forget(self, camera: str) -> None:
        """Begin anew with a camera that sees somebody with the others, nobody, or several."""
        self._moments.pop(camera, None)

    def compare(self, camera: str, own: Array, others: Array, time_ns: int) -> float | None:
        """Take the joints (20, 3) of the only person whom a camera sees and of the only one whom
        the others see, NaN where they are missing; return by how many metres the camera is off
        once they are known to be one person, or None."""
        moments = self._moments.setdefault(camera, deque())
        moments.append(_Moment(time_ns, own, others))
        longest_ns = round(1e9 * self._parameters.far_off_s)
        while not 0 <= time_ns - moments[0].time_ns <= longest_ns:
            moments.popleft()
        if time_ns - moments[0].time_ns < 0.9 * longest_ns:
            return None
        owns = np.stack([one.own for one in moments])
        theirs = np.stack([one.others for one in moments])
        straight_m = _residual_m(owns, theirs)
        exchanged_m = _residual_m(owns, np.roll(theirs, len(theirs) // 2, axis=0))
        if straight_m > min(self._parameters.alike_m, self._parameters.alike_share * exchanged_m):
            return None
        return float(np.nanmean(np.linalg.norm(owns - theirs, axis=-1)))


def _residual_m(points: Array, others: Array) -> float:
    """How far points (…, 3) are from others, root mean square, after the turn and shift that lay
    them best on these; infinite where too few are there (NaN) to tell."""
    seen = np.isfinite(points).all(axis=-1) & np.isfinite(others).all(axis=-1)
    if seen.sum() < FEWEST_JOINTS:
        return np.inf
    middled = points[seen] - points[seen].mean(axis=0)
    others_middled = others[seen] - others[seen].mean(axis=0)
    # Kabsch, "A solution for the best rotation to relate two sets of vectors" (1976).
    left, _, right = np.linalg.svd(middled.T @ others_middled)
    left[:, 2] *= np.sign(np.linalg.det(left @ right))
    off = middled @ (left @ right) - others_middled
    return float(np.sqrt(np.mean(np.sum(off**2, axis=1))))
