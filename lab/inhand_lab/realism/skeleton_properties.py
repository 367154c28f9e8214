"""Measures what recorded skeletons show of the tracker that made them, without any truth.

A bone's length is constant, so whatever it does is the tracker's error; second differences of a
joint that rests are its jitter. Both depend on how fast the joint moves, so each is measured by
pace. Everything is measured on recordings at 30 Hz.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from inhand_schemas.joints import PARENTS, Joint
from inhand_tracker.geometry.arrays import Array, Flags, Indices

from inhand_lab.realism.parameters import DEFAULT_REALISM

FRAME_RATE = 30.0
"""Frames a second of all recordings that are measured."""

GROUPS: dict[str, tuple[Joint, ...]] = {
    "trunk": (Joint.SPINE, Joint.SHOULDER_CENTER, Joint.HIP_LEFT, Joint.HIP_RIGHT),
    "head": (Joint.HEAD,),
    "upper arm": (
        Joint.SHOULDER_LEFT,
        Joint.ELBOW_LEFT,
        Joint.SHOULDER_RIGHT,
        Joint.ELBOW_RIGHT,
    ),
    "wrist": (Joint.WRIST_LEFT, Joint.WRIST_RIGHT),
    "hand": (Joint.HAND_LEFT, Joint.HAND_RIGHT),
    "leg": (Joint.KNEE_LEFT, Joint.ANKLE_LEFT, Joint.KNEE_RIGHT, Joint.ANKLE_RIGHT),
    "foot": (Joint.FOOT_LEFT, Joint.FOOT_RIGHT),
}
"""Joints by kind, each with the bone from its parent."""
ARMS = (
    (Joint.ELBOW_LEFT, Joint.WRIST_LEFT, Joint.HAND_LEFT),
    (Joint.ELBOW_RIGHT, Joint.WRIST_RIGHT, Joint.HAND_RIGHT),
)
"""Joints of each arm below the shoulder."""

Arm = tuple[Joint, Joint, Joint]
PACES = {pace.name: pace for pace in DEFAULT_REALISM.paces}


@dataclass(frozen=True)
class SensorProperty:
    """One measured property: its name and unit, and what it was measured ``on``.

    The value is NaN where nothing was recorded that shows it.
    """

    name: str
    unit: str
    on: str
    value: float


@dataclass(frozen=True)
class ObservedSkeletons:
    """A recording over T frames: joints (T, 20, 3), their speeds (T, 20) in metres a second, and
    the length (T, 20) of the bone from each joint's parent to it."""

    joints: Array
    speeds: Array
    bones: Array

    @classmethod
    def of(cls, joints: Array) -> ObservedSkeletons:
        """Measure speeds and bones of joints (T, 20, 3), once for all properties."""
        return cls(joints, _speeds(joints), np.linalg.norm(joints - joints[:, PARENTS], axis=2))

    def at(self, pace: str) -> Flags:
        """Flags (T, 20) of the joints that go at a pace."""
        _, lowest, highest = PACES[pace]
        return (self.speeds >= lowest) & (self.speeds < highest)


def skeleton_properties(people: Sequence[Sequence[ObservedSkeletons]]) -> list[SensorProperty]:
    """Measure people's recordings: the same properties in the same order for any people."""
    seen = [recording for recordings in people for recording in recordings]
    return [
        *_jitter(seen),
        *_drift(seen),
        *_bone_steps(seen),
        *_bone_deviations(seen),
        *_bone_stretches(people),
        *_departures(seen),
        *_turns(seen),
        *_proportions(seen),
    ]


def hand_bends(joints: Array, arm: Arm) -> Array:
    """Angle (T,) in degrees between the forearm's direction and the hand's."""
    elbow, wrist, hand = arm
    fore, ahead = joints[:, wrist] - joints[:, elbow], joints[:, hand] - joints[:, wrist]
    across = np.linalg.norm(np.cross(fore, ahead), axis=1)
    return np.degrees(np.arctan2(across, np.sum(fore * ahead, axis=1)))


def _speeds(joints: Array) -> Array:
    """Speeds (T, 20) of joints (T, 20, 3), in metres a second."""
    frames = np.arange(len(joints))
    before = np.clip(frames - DEFAULT_REALISM.speed_reach, 0, len(frames) - 1)
    after = np.clip(frames + DEFAULT_REALISM.speed_reach, 0, len(frames) - 1)
    way = np.linalg.norm(joints[after] - joints[before], axis=2)
    return np.asarray(way * (FRAME_RATE / (after - before)[:, None]))


def _jitter(recordings: Sequence[ObservedSkeletons]) -> Iterator[SensorProperty]:
    """Measure the second differences of resting joints' positions."""
    for group, joints in GROUPS.items():
        for pace in ("still", "slow"):
            jitters = []
            for seen in recordings:
                second = np.linalg.norm(np.diff(seen.joints[:, joints], 2, axis=0), axis=2)
                jitters.append(second[seen.at(pace)[1:-1, joints]])
            yield from _spread(f"{group} jitter", f"{pace} {group}", jitters)


def _drift(recordings: Sequence[ObservedSkeletons]) -> Iterator[SensorProperty]:
    """Measure how much further a resting joint gets in several frames than in one.

    The ratio is the number of frames where a joint drifts, and about 1 where it trembles.
    """
    lag = DEFAULT_REALISM.drift_lag
    for group, joints in GROUPS.items():
        near, far = [], []
        for seen in recordings:
            still, places = seen.at("still")[:, joints], seen.joints[:, joints]
            one = np.linalg.norm(places[1:] - places[:-1], axis=2)
            many = np.linalg.norm(places[lag:] - places[:-lag], axis=2)
            near.append(one[still[1:]])
            far.append(many[still[lag // 2 : lag // 2 - lag]])
        ratio = _quantile(far, 0.5) / max(_quantile(near, 0.5), 1e-9)
        yield SensorProperty(f"{group} drift over jitter", "", f"still {group}", ratio)


def _bone_steps(recordings: Sequence[ObservedSkeletons]) -> Iterator[SensorProperty]:
    """Measure the change of a bone's length from frame to frame, by pace."""
    for group, joints in GROUPS.items():
        for pace in PACES:
            changes = [
                np.abs(np.diff(seen.bones[:, joints], axis=0))[seen.at(pace)[1:, joints]]
                for seen in recordings
            ]
            yield from _spread(f"{group} bone, change a frame", f"{pace} {group}", changes)


def _bone_deviations(recordings: Sequence[ObservedSkeletons]) -> Iterator[SensorProperty]:
    """Measure a bone's deviation over a window of frames, by the way that the joint goes then."""
    for group, joints in GROUPS.items():
        lengths, ways = [], []
        for seen in recordings:
            for window in _windows(seen):
                lengths += list(seen.bones[window, joints].T)
                ways += list(seen.speeds[window, joints].sum(axis=0) / FRAME_RATE)
        for lowest, highest in DEFAULT_REALISM.ways_m:
            chosen = [
                values for values, way in zip(lengths, ways, strict=True) if lowest <= way < highest
            ]
            on = f"{group} that goes {lowest:.1f} to {highest:.1f} m in 1.5 s"
            for name, spread in (("", np.std), ("robust ", _robust_deviation)):
                spreads = [float(spread(values)) for values in chosen]
                value = 1000.0 * float(np.mean(spreads)) if spreads else np.nan
                yield SensorProperty(f"{group} bone, {name}deviation", "mm", on, value)


def _bone_stretches(people: Sequence[Sequence[ObservedSkeletons]]) -> Iterator[SensorProperty]:
    """Measure how much a bone's usual length differs between windows of one person, in whatever
    recording: its deviation, the mean over people and bones."""
    medians = [
        np.array(
            [
                np.median(seen.bones[window], axis=0)
                for seen in recordings
                for window in _windows(seen)
            ]
        )
        for recordings in people
    ]
    spreads = [np.std(one, axis=0, ddof=1) for one in medians if len(one) > 1]
    for group, joints in GROUPS.items():
        value = 1000.0 * float(np.mean(np.array(spreads)[:, joints])) if spreads else np.nan
        name = f"{group} bone, deviation between stretches"
        yield SensorProperty(name, "mm", "1.5 s of one person", value)


def _windows(seen: ObservedSkeletons) -> Iterator[slice]:
    """Yield the windows of a recording one after the other; a rest of it is left out."""
    width = DEFAULT_REALISM.window
    for start in range(0, len(seen.joints) - width + 1, width):
        yield slice(start, start + width)


def _departures(recordings: Sequence[ObservedSkeletons]) -> Iterator[SensorProperty]:
    """Measure how often and how long wrists and hands leave the arm."""
    for name, place, limit in (
        ("forearm", 1, DEFAULT_REALISM.forearm_off_share),
        ("hand", 2, DEFAULT_REALISM.hand_off_share),
    ):
        masks = []
        for seen in recordings:
            usual = np.median(seen.bones, axis=0)
            away = np.abs(seen.bones - usual) > limit * usual
            masks += [(seen.speeds[:, arm[1]], away[:, arm[place]]) for arm in ARMS]
        yield from _episodes(f"{name} off by {100 * limit:.0f} %", masks)


def _turns(recordings: Sequence[ObservedSkeletons]) -> Iterator[SensorProperty]:
    """Measure how often and how long hands are turned against the forearm."""
    limit = DEFAULT_REALISM.turned_deg
    masks = [
        (seen.speeds[:, arm[1]], hand_bends(seen.joints, arm) > limit)
        for seen in recordings
        for arm in ARMS
    ]
    yield from _episodes(f"hand turned by {limit:.0f}°", masks)


def _episodes(name: str, masks: list[tuple[Array, Flags]]) -> Iterator[SensorProperty]:
    """Measure the share of frames by the wrist's speed (T,), and the mean length of an episode."""
    speed = np.concatenate([speed for speed, _ in masks])
    concerned = np.concatenate([mask for _, mask in masks])
    for pace in ("slow", "brisk", "fast"):
        _, lowest, highest = PACES[pace]
        inside = concerned[(speed >= lowest) & (speed < highest)]
        share = 100.0 * float(inside.mean()) if len(inside) else np.nan
        yield SensorProperty(name, "% of frames", f"{pace} wrist", share)
    lengths = np.concatenate([_run_lengths(mask) for _, mask in masks])
    mean = float(lengths.mean()) if len(lengths) else np.nan
    yield SensorProperty(f"{name}, length", "frames", "all", mean)


def _proportions(recordings: Sequence[ObservedSkeletons]) -> Iterator[SensorProperty]:
    """Measure bones over the trunk, from hip centre to shoulder centre."""
    medians = np.mean([np.median(seen.bones, axis=0) for seen in recordings], axis=0)
    trunk = float(medians[Joint.SPINE] + medians[Joint.SHOULDER_CENTER])
    for group, joints in GROUPS.items():
        if group != "trunk":
            length = float(np.mean(medians[list(joints)]))
            yield SensorProperty(f"{group} bone over trunk", "", "all", length / trunk)


def _spread(name: str, on: str, values: list[Array]) -> Iterator[SensorProperty]:
    """Give the median and the ninth decile of values in metres, in millimetres."""
    yield SensorProperty(f"{name}, median", "mm", on, 1000.0 * _quantile(values, 0.5))
    yield SensorProperty(f"{name}, 90 %", "mm", on, 1000.0 * _quantile(values, 0.9))


def _quantile(values: list[Array], share: float) -> float:
    """Quantile of all values; NaN where there is none."""
    together = np.concatenate(values)
    return float(np.quantile(together, share)) if len(together) else np.nan


def _robust_deviation(values: Array) -> float:
    """Standard deviation by the median distance from the median, which few outliers change."""
    return float(1.4826 * np.median(np.abs(values - np.median(values))))


def _run_lengths(mask: Flags) -> Indices:
    """Numbers of frames in a row in which a mask (T,) is set."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]])))
    return np.asarray(edges[1::2] - edges[::2])
