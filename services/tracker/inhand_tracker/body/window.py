"""Keeps and describes the last moments of a body: its pose, where it goes, where it has been.

Priors are learned from these descriptions.

A brush on its way up and one on its way down meet the same body pose, and arms that hang do not
show whether glasses are worn or lie on a table: what the hands did before does.
"""

from collections import deque

import numpy as np
from inhand_schemas.joints import JOINT_NAMES, Joint

from inhand_tracker.body.kernels import describe as kernels
from inhand_tracker.body.parameters import DEFAULT_BODY, BodyParameters
from inhand_tracker.geometry.arrays import Array, Indices, Singles

UPPER_BODY = np.array(
    [Joint.SPINE, Joint.SHOULDER_CENTER, Joint.HEAD]
    + [
        JOINT_NAMES.index(part + side)
        for side in ("Left", "Right")
        for part in ("Shoulder", "Elbow", "Wrist", "Hand")
    ]
)
# Whose places are remembered.
REMEMBERED = np.array(
    [
        JOINT_NAMES.index(name)
        for name in ("Head", "HandLeft", "WristLeft", "HandRight", "WristRight")
    ]
)
VIEWS = 3
"""Number of descriptions of a body: of the whole body, of the upper body (legs say little of most
objects, and all of a shoe), and of the upper body with where its hands have been."""


def continues(before_ns: int, time_ns: int, gap_ns: int = DEFAULT_BODY.gap_ns) -> bool:
    """Whether a frame continues the one before: the clock went on, and there is no gap."""
    return 0 < time_ns - before_ns <= gap_ns


def describe_bodies(
    joints: Array, earlier: Array, remembered: Array, height: float
) -> list[Singles]:
    """Describe bodies by their joints (T, 20, 3): the ``VIEWS`` descriptions, each (T, D).

    ``earlier`` (T, L, 20, 3) are the joints at each of the lags before, ``remembered`` (T, M, 5, 3)
    the memories of ``PlaceMemory``. Places are from the middle of the trunk; places and ways are in
    the trunk's directions and in body heights.
    """
    places = trunk_places(joints, height)
    ways = kernels.ways(joints, earlier, height)
    described = np.concatenate((places[:, None], ways), axis=1)
    whole, upper, memories = (
        array.reshape(len(joints), -1).astype(np.float32)
        for array in (described, described[:, :, UPPER_BODY], remembered)
    )
    return [whole, upper, np.concatenate((upper, memories), axis=1)]


def trunk_places(joints: Array, height: float) -> Array:
    """Give joints (..., 20, 3) from the middle of the trunk, in its directions, in body heights."""
    return kernels.places(joints, height)


def earlier_frames(
    frames: Indices, frame_rate: float, parameters: BodyParameters = DEFAULT_BODY
) -> Indices:
    """Find the rows (T, L) that stand for each lag before usable frames (T,) of a recording."""
    lags = np.rint(np.array(parameters.lags_s) * frame_rate).astype(np.int64)
    rows = np.searchsorted(frames, frames[:, None] - lags, side="right") - 1
    return np.maximum(rows, 0)


class PlaceMemory:
    """Remembers where hands and head have been: fading means (M, 5, 3), one a time constant.

    Until a time constant has passed everything that was seen counts the same.
    """

    def __init__(self, parameters: BodyParameters = DEFAULT_BODY) -> None:
        self._times_s = np.array(parameters.memories_s)
        self._means = np.zeros((len(self._times_s), len(REMEMBERED), 3))
        self._elapsed_s = 0.0

    def add(self, places: Array, step_s: float) -> Array:
        """Take the places (20, 3) of a frame that is ``step_s`` later than the last one."""
        self._elapsed_s += step_s
        share = np.maximum(1.0 - np.exp(-step_s / self._times_s), step_s / self._elapsed_s)
        self._means = self._means + share[:, None, None] * (places[REMEMBERED] - self._means)
        return self._means


def remember_places(places: Array, times: Array, step_s: float) -> Array:
    """Give the memories (T, M, 5, 3) of a recording's places (T, 20, 3) at times in seconds.

    The first frame counts for one step.
    """
    memory = PlaceMemory()
    steps = np.diff(times, prepend=times[0] - step_s)
    return np.array([memory.add(one, step) for one, step in zip(places, steps, strict=True)])


class BodyWindow:
    """Keeps the last moments of one person."""

    def __init__(self, parameters: BodyParameters = DEFAULT_BODY) -> None:
        self._parameters = parameters
        self._frames: deque[tuple[int, Array]] = deque()
        self._memory = PlaceMemory(parameters)

    def add(self, joints: Array, time_ns: int, height: float) -> list[Singles]:
        """Take a frame's joints (20, 3), and describe it: (1, D) for each view."""
        step_ns = self._step(time_ns)
        self._keep(joints, time_ns)
        places = trunk_places(joints[None], height)[0]
        remembered = self._memory.add(places, step_ns / 1e9)
        return describe_bodies(joints[None], self._earlier(time_ns), remembered[None], height)

    def _step(self, time_ns: int) -> int:
        """Nanoseconds since the last frame; after a gap, start anew with those of one at 30 Hz."""
        last_ns = self._frames[-1][0] if self._frames else time_ns
        if continues(last_ns, time_ns, self._parameters.gap_ns):
            return time_ns - last_ns
        self._frames.clear()
        self._memory = PlaceMemory(self._parameters)
        return round(1e9 / 30.0)

    def _keep(self, joints: Array, time_ns: int) -> None:
        self._frames.append((time_ns, joints))
        while time_ns - self._frames[0][0] > 2e9 * max(self._parameters.lags_s):
            self._frames.popleft()

    def _earlier(self, time_ns: int) -> Array:
        """The joints (1, L, 20, 3) of the frames nearest to each lag."""
        nearest = [self._nearest(time_ns - round(1e9 * lag)) for lag in self._parameters.lags_s]
        return np.array(nearest)[None]

    def _nearest(self, time_ns: int) -> Array:
        """The joints (20, 3) of the frame nearest to a time."""
        return min(self._frames, key=lambda frame: abs(frame[0] - time_ns))[1]
