"""Describes a person's movement for recognition: the body now, and over the last three seconds."""

from collections import deque
from collections.abc import Callable

import numpy as np
from inhand_schemas.joints import JOINT_NAMES

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.recognition.parameters import DEFAULT_RECOGNITION, RecognitionParameters

# Not the hips, which the pelvis basis fixes, nor the feet, which are the noisiest.
_JOINTS = np.array(
    [JOINT_NAMES.index(name) for name in JOINT_NAMES if not name.startswith(("Hip", "Foot"))]
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


def body_description(pose: Array) -> Array:
    """The joints of a body pose (60,), and the distances of pairs of them."""
    joints = pose.reshape(20, 3)
    distances = np.linalg.norm(joints[_FROM] - joints[_TO], axis=1)
    return np.concatenate((joints[_JOINTS].ravel(), distances))


class MovementWindow:
    """Keeps the last poses of one person; before the first one the person is taken to have stood
    in it.

    Frames may come at any rate: the past is read at 30 Hz, each moment by the last pose before it.
    ``describe`` makes D numbers of a body pose (60,).
    """

    def __init__(
        self,
        parameters: RecognitionParameters = DEFAULT_RECOGNITION,
        describe: Callable[[Array], Array] = body_description,
    ) -> None:
        self._parameters = parameters
        self._describe = describe
        longest = max(parameters.windows) + parameters.speed_lag
        self._ages_ns = np.rint(np.arange(longest) / parameters.rate_hz * 1e9).astype(np.int64)
        self._kept_ns = round((longest + 1) / parameters.rate_hz * 1e9)
        # Clocks jitter.
        self._tolerance_ns = round(0.5 / parameters.rate_hz * 1e9)
        self._times: deque[int] = deque()
        self._descriptions: deque[Array] = deque()

    def add(self, time_ns: int, pose: Array) -> None:
        """Take the body pose (60,) of a frame; a clock that went back starts anew."""
        if self._times and time_ns <= self._times[-1]:
            self._times.clear()
            self._descriptions.clear()
        self._times.append(time_ns)
        self._descriptions.append(self._describe(pose))
        oldest = time_ns - self._kept_ns
        while len(self._times) > 1 and self._times[1] <= oldest:
            self._times.popleft()
            self._descriptions.popleft()

    def features(self) -> Array:
        """Describe the present (D,), its changes by the lags, and over each window the mean, the
        spread and the speed: (D (1 + L + 3 W),)."""
        past = self._past()
        step = self._parameters.speed_lag
        speeds = np.abs(past[:-step] - past[step:])
        features = [past[0], *(past[0] - past[lag] for lag in self._parameters.lags)]
        for window in self._parameters.windows:
            features += [
                past[:window].mean(axis=0),
                past[:window].std(axis=0),
                speeds[:window].mean(axis=0),
            ]
        return np.concatenate(features)

    def _past(self) -> Array:
        """The descriptions (T, D) at 30 Hz, newest first."""
        moments = self._times[-1] - self._ages_ns
        times = np.fromiter(self._times, np.int64) - self._tolerance_ns
        rows = np.maximum(np.searchsorted(times, moments, side="right") - 1, 0)
        return np.stack(list(self._descriptions))[rows]
