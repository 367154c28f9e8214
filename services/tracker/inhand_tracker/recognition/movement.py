"""What recognition reads of a person's movement: the body now, and over the last three seconds."""

from collections import deque

import numpy as np
from inhand_schemas.joints import JOINT_NAMES

from inhand_tracker.geometry.arrays import Array

RATE_HZ = 30.0
WINDOWS = (15, 45, 90)
"""Frames at 30 Hz over which means, spreads and speeds are taken."""
LAGS = (5, 10, 20)
"""Frames at 30 Hz back to the poses that the present one is compared with."""
SPEED_LAG = 2
LONGEST = max(WINDOWS) + SPEED_LAG

_JOINTS = np.array(
    [
        JOINT_NAMES.index(name)
        for name in JOINT_NAMES
        if not name.startswith(("Hip", "Foot"))  # what the pelvis basis fixes, and the noisiest
    ]
)
_PAIRS = (
    ("HandRight", "Head"),
    ("HandLeft", "Head"),
    ("HandRight", "HandLeft"),
    ("HandRight", "ShoulderRight"),
    ("HandLeft", "ShoulderLeft"),
    ("WristRight", "AnkleRight"),
    ("WristLeft", "AnkleLeft"),
    ("HandRight", "AnkleLeft"),
    ("HandLeft", "AnkleRight"),
    ("ElbowRight", "ElbowLeft"),
    ("WristRight", "WristLeft"),
    ("HandRight", "HipCenter"),
    ("HandLeft", "HipCenter"),
)
_FROM = np.array([JOINT_NAMES.index(first) for first, _ in _PAIRS])
_TO = np.array([JOINT_NAMES.index(second) for _, second in _PAIRS])

PRESENT = 3 * len(_JOINTS) + len(_PAIRS)
FEATURES = PRESENT * (1 + len(LAGS) + 3 * len(WINDOWS))


class Movement:
    """The last poses of one person; before the first one the person is taken to have stood in it.

    Frames may come at any rate: the past is read at 30 Hz, each moment by the last pose before it.
    """

    def __init__(self) -> None:
        self._times: deque[int] = deque()
        self._parts: deque[Array] = deque()

    def add(self, time_ns: int, pose: Array) -> None:
        """Take the body pose (60,) of a frame; a clock that went back starts anew."""
        if self._times and time_ns <= self._times[-1]:
            self._times.clear()
            self._parts.clear()
        self._times.append(time_ns)
        self._parts.append(_present(pose))
        oldest = time_ns - round((LONGEST + 1) / RATE_HZ * 1e9)
        while len(self._times) > 1 and self._times[1] <= oldest:
            self._times.popleft()
            self._parts.popleft()

    def features(self) -> Array:
        """(FEATURES,): the present, its changes, and means, spreads and speeds over windows."""
        moments = self._times[-1] - np.rint(np.arange(LONGEST) / RATE_HZ * 1e9).astype(np.int64)
        # Half a frame of tolerance: clocks jitter.
        known = np.fromiter(self._times, np.int64) - round(0.5 / RATE_HZ * 1e9)
        chosen = np.maximum(np.searchsorted(known, moments, side="right") - 1, 0)
        past = np.stack(list(self._parts))[chosen]
        speeds = np.abs(past[:-SPEED_LAG] - past[SPEED_LAG:])
        parts = [past[0], *(past[0] - past[lag] for lag in LAGS)]
        for window in WINDOWS:
            parts += [
                past[:window].mean(axis=0),
                past[:window].std(axis=0),
                speeds[:window].mean(axis=0),
            ]
        return np.concatenate(parts)


def _present(pose: Array) -> Array:
    joints = pose.reshape(20, 3)
    apart = np.linalg.norm(joints[_FROM] - joints[_TO], axis=1)
    return np.concatenate((joints[_JOINTS].ravel(), apart))
