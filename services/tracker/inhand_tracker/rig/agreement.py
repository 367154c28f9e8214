"""Finds a camera that is not where it is said to be: somebody has bumped it.

Its people stand aside of where the other cameras have them, for seconds and whatever they do. Who
of two is wrong nobody can tell; then it is the one that is not the first of the rig.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.rig.parameters import DEFAULT_RIG, RigParameters

FEWEST_JOINTS = 5
"""Number of joints that two cameras must both see to be compared."""


@dataclass
class _Difference:
    """The mean way (3,) by which a camera's people are off the others', and the seconds for which
    it was compared; ``time_ns`` is that of the last time."""

    way: Array
    seconds: float
    time_ns: int


class Agreement:
    """Watches whether cameras agree; ``left_out`` are those that do not, with how far they are off,
    in metres."""

    def __init__(self, parameters: RigParameters = DEFAULT_RIG) -> None:
        self._parameters = parameters
        self._differences: dict[str, _Difference] = {}
        self.left_out: dict[str, float] = {}

    def compare(self, seen: Mapping[str, Sequence[Array]], time_ns: int) -> None:
        """Take what cameras saw at a time, those that are believed first: of each, the same
        people's joints (20, 3) in one frame of reference, all NaN of somebody it does not see."""
        for camera in seen:
            trusted = [one for one in seen if one != camera and (one not in self.left_out)]
            if trusted:
                self._note(camera, seen[camera], [seen[one] for one in trusted], time_ns)
        self._decide(list(seen))

    def leave_out(self, camera: str, off_m: float) -> None:
        """Take a camera to be off by so much, until it is compared and agrees."""
        self.left_out[camera] = off_m
        self._differences.pop(camera, None)

    def _note(
        self, camera: str, own: Sequence[Array], others: Sequence[Sequence[Array]], time_ns: int
    ) -> None:
        """Take by how much a camera's people are off the others'."""
        ways = []
        for person, joints in enumerate(own):
            rest = np.stack([one[person] for one in others])
            seen = np.isfinite(joints).all(axis=1) & np.isfinite(rest).all(axis=2).any(axis=0)
            if seen.sum() >= FEWEST_JOINTS:
                middle = _medians(rest[:, seen])
                ways.append(np.median(joints[seen] - middle, axis=0))
        if not ways:
            return
        way = np.mean(ways, axis=0)
        before = self._differences.get(camera)
        if before is None or time_ns <= before.time_ns:
            self._differences[camera] = _Difference(way, 0.0, time_ns)
            return
        # A pause counts for no more than the times around it.
        most_s = 2e-9 * self._parameters.compared_every_ns
        elapsed = min((time_ns - before.time_ns) / 1e9, most_s)
        share = elapsed / (self._parameters.settling_s + elapsed)
        share = max(share, elapsed / (before.seconds + elapsed))
        self._differences[camera] = _Difference(
            before.way + share * (way - before.way), before.seconds + elapsed, time_ns
        )

    def _decide(self, cameras: Sequence[str]) -> None:
        """Leave the camera out that is farthest off; take those back that agree again."""
        parameters = self._parameters
        off = {
            camera: float(np.linalg.norm(one.way))
            for camera, one in self._differences.items()
            if one.seconds >= parameters.least_compared_s
        }
        for camera in list(self.left_out):
            if camera in off:
                self.left_out[camera] = off[camera]
            if off.get(camera, np.inf) < parameters.together_m:
                del self.left_out[camera]
        rest = [camera for camera in cameras if camera in off and camera not in self.left_out]
        if len(rest) < 2:
            return
        candidates = rest[1:] if len(rest) == 2 else rest
        worst = max(candidates, key=lambda camera: off[camera])
        if off[worst] > parameters.apart_m:
            self.left_out[worst] = off[worst]
            # The others were compared with it.
            for camera in rest:
                if camera != worst:
                    del self._differences[camera]


def _medians(values: Array) -> Array:
    """Medians (...) of what is finite of values (N, ...), at least one of each; ``np.nanmedian``
    takes several times as long with the few cameras of a rig."""
    ordered = np.sort(values, axis=0)  # NaN last
    known = np.isfinite(ordered).sum(axis=0)[None]
    low = np.take_along_axis(ordered, (known - 1) // 2, axis=0)[0]
    high = np.take_along_axis(ordered, known // 2, axis=0)[0]
    return np.asarray(0.5 * (low + high))
