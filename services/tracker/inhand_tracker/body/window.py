"""The body over time, as the prior is learned from it: its pose, where it goes, where it has been.

A brush on its way up and one on its way down meet the same body pose, and arms that hang tell
nothing of whether glasses are worn or lie on a table: that shows in what the hands did before.
"""

from collections import deque

import numpy as np
from inhand_schemas.joints import JOINT_NAMES, Joint

from inhand_tracker.body.anchors import trunk_axes
from inhand_tracker.geometry.arrays import Array, Indices, Singles

LAGS_S = (0.13, 0.33)
"""How long ago joints are compared with, seconds."""
MEMORIES_S = (1.0, 3.0)
"""Time constants of the means of where hands and head have been, seconds."""
GAP_NS = 500_000_000
"""After a gap of half a second nothing before it counts."""

WHOLE_BODY = np.arange(20)
UPPER_BODY = np.array(
    [Joint.SPINE, Joint.SHOULDER_CENTER, Joint.HEAD]
    + [
        JOINT_NAMES.index(part + side)
        for side in ("Left", "Right")
        for part in ("Shoulder", "Elbow", "Wrist", "Hand")
    ]
)
REMEMBERED = np.array(
    [
        JOINT_NAMES.index(name)
        for name in ("Head", "HandLeft", "WristLeft", "HandRight", "WristRight")
    ]
)
VIEWS = 3
"""A description of the whole body, of the upper body (legs say little of most objects, and all of
a shoe), and of the upper body with where its hands have been."""


def describe(joints: Array, earlier: Array, remembered: Array, height: float) -> list[Singles]:
    """The three descriptions, each (T, D), of joints (T, 20, 3).

    ``earlier`` (T, L, 20, 3) are the joints at each of the lags before, ``remembered`` (T, M, 5, 3)
    the memories of ``Memory``. Places are from the middle of the trunk; places and ways are in the
    trunk's directions and in body heights.
    """
    axes = trunk_axes(joints)
    ways = 0.5 * np.einsum("tljk,tki->tlji", joints[:, None] - earlier, axes) / height
    seen = np.concatenate((places(joints, height)[:, None], ways), axis=1)
    whole, upper, memories = (
        array.reshape(len(joints), -1).astype(np.float32)
        for array in (seen[:, :, WHOLE_BODY], seen[:, :, UPPER_BODY], remembered)
    )
    return [whole, upper, np.concatenate((upper, memories), axis=1)]


def places(joints: Array, height: float) -> Array:
    """Joints (T, 20, 3) from the middle of the trunk, in its directions and in body heights."""
    middle = 0.5 * (joints[:, Joint.HIP_CENTER] + joints[:, Joint.SHOULDER_CENTER])
    return np.asarray((joints - middle[:, None]) @ trunk_axes(joints)) / height


def earlier_frames(frames: Indices, frame_rate: float) -> Indices:
    """For usable frames (T,) of a recording, the rows (T, L) that stand for each lag before."""
    lags = np.rint(np.array(LAGS_S) * frame_rate).astype(np.int64)
    rows = np.searchsorted(frames, frames[:, None] - lags, side="right") - 1
    return np.maximum(rows, 0)


class Memory:
    """Fading means of where hands and head have been, (M, 5, 3), one for each of MEMORIES_S.

    At first all that was seen counts the same.
    """

    def __init__(self) -> None:
        self._means = np.zeros((len(MEMORIES_S), len(REMEMBERED), 3))
        self._elapsed_s = 0.0

    def add(self, place: Array, step_s: float) -> Array:
        """Take the places (20, 3) of a frame that is so much later than the last one."""
        self._elapsed_s += step_s
        share = np.maximum(1.0 - np.exp(-step_s / np.array(MEMORIES_S)), step_s / self._elapsed_s)
        self._means = self._means + share[:, None, None] * (place[REMEMBERED] - self._means)
        return self._means


def remember(all_places: Array, times: Array, step_s: float) -> Array:
    """The memories (T, M, 5, 3) of a recording's places (T, 20, 3) at times in seconds, whose first
    frame counts for one step."""
    memory = Memory()
    steps = np.diff(times, prepend=times[0] - step_s)
    return np.array(
        [memory.add(place, step) for place, step in zip(all_places, steps, strict=True)]
    )


class BodyWindow:
    """What is known of the last moments of one person."""

    def __init__(self) -> None:
        self._seen: deque[tuple[int, Array]] = deque()
        self._memory = Memory()

    def add(self, joints: Array, time_ns: int, height: float) -> list[Singles]:
        """Take a frame's joints (20, 3), and describe it, a (1, D) for each view."""
        step_ns = time_ns - self._seen[-1][0] if self._seen else 0
        if not 0 < step_ns <= GAP_NS:
            self._seen.clear()
            self._memory = Memory()
            step_ns = round(1e9 / 30.0)
        self._seen.append((time_ns, joints))
        while time_ns - self._seen[0][0] > 2e9 * max(LAGS_S):
            self._seen.popleft()
        ages = np.array([time_ns - seen_ns for seen_ns, _ in self._seen]) / 1e9
        earlier = [self._seen[int(np.argmin(np.abs(ages - lag)))][1] for lag in LAGS_S]
        remembered = self._memory.add(places(joints[None], height)[0], step_ns / 1e9)
        return describe(joints[None], np.stack(earlier)[None], remembered[None], height)
