"""What recorded skeletons tell of the tracker that made them, without any truth beside them.

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

FRAME_RATE = 30.0
REACH = 3
"""A joint's speed is that between this many frames before and after."""
WINDOW = 45
"""Frames over which the deviation of a bone's length is taken."""
LAG = 8
"""Frames between which a slow wander is measured."""

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
FLIPPED = 90.0
"""Degrees between forearm and hand."""
PACES = {
    "still": (0.0, 0.05),
    "slow": (0.05, 0.3),
    "brisk": (0.3, 1.0),
    "fast": (1.0, 2.5),
}
"""Speeds of a joint, metres a second."""
WAYS = ((0.0, 0.2), (0.2, 1.0), (1.0, 4.0))
"""How far, in metres, a joint goes in WINDOW frames."""


Arm = tuple[Joint, Joint, Joint]


@dataclass(frozen=True)
class Figure:
    """One measured property: a name, its unit, and what it was measured on.

    nan where nothing was recorded to tell.
    """

    name: str
    unit: str
    on: str
    value: float


@dataclass(frozen=True)
class Observed:
    """A recording over T frames: joints (T, 20, 3), their speeds (T, 20) in metres a second, and
    the length (T, 20) of the bone from each joint's parent to it."""

    joints: Array
    speeds: Array
    bones: Array

    @classmethod
    def of(cls, joints: Array) -> Observed:
        """What is measured again and again of joints (T, 20, 3)."""
        return cls(joints, _speeds(joints), np.linalg.norm(joints - joints[:, PARENTS], axis=2))

    def at(self, pace: str) -> Flags:
        """Which joints (T, 20) go at a pace."""
        lowest, highest = PACES[pace]
        return (self.speeds >= lowest) & (self.speeds < highest)


def measure_skeletons(people: Sequence[Sequence[Observed]]) -> list[Figure]:
    """Figures of people's recordings, the same in the same order for any people."""
    seen = [recording for recordings in people for recording in recordings]
    return [
        *_jitter(seen),
        *_drift(seen),
        *_bone_steps(seen),
        *_bone_deviations(seen),
        *_bone_stretches(people),
        *_departures(seen),
        *_flips(seen),
        *_proportions(seen),
    ]


def hand_bends(joints: Array, arm: Arm) -> Array:
    """The angle (T,) in degrees between the forearm's direction and the hand's."""
    elbow, wrist, hand = arm
    fore, ahead = joints[:, wrist] - joints[:, elbow], joints[:, hand] - joints[:, wrist]
    across = np.linalg.norm(np.cross(fore, ahead), axis=1)
    return np.degrees(np.arctan2(across, np.sum(fore * ahead, axis=1)))


def _speeds(joints: Array) -> Array:
    frames = np.arange(len(joints))
    before = np.clip(frames - REACH, 0, len(frames) - 1)
    after = np.clip(frames + REACH, 0, len(frames) - 1)
    way = np.linalg.norm(joints[after] - joints[before], axis=2)
    return np.asarray(way * (FRAME_RATE / (after - before)[:, None]))


def _jitter(recordings: Sequence[Observed]) -> Iterator[Figure]:
    """Second differences of positions."""
    for group, joints in GROUPS.items():
        for pace in ("still", "slow"):
            found = []
            for seen in recordings:
                second = np.linalg.norm(np.diff(seen.joints[:, joints], 2, axis=0), axis=2)
                found.append(second[seen.at(pace)[1:-1, joints]])
            yield from _spread(f"{group} jitter", f"{pace} {group}", found)


def _drift(recordings: Sequence[Observed]) -> Iterator[Figure]:
    """How much further a resting joint gets in LAG frames than in one: LAG where it drifts, and
    hardly further where it trembles."""
    for group, joints in GROUPS.items():
        near, far = [], []
        for seen in recordings:
            still, places = seen.at("still")[:, joints], seen.joints[:, joints]
            one = np.linalg.norm(places[1:] - places[:-1], axis=2)
            many = np.linalg.norm(places[LAG:] - places[:-LAG], axis=2)
            near.append(one[still[1:]])
            far.append(many[still[LAG // 2 : LAG // 2 - LAG]])
        ratio = _quantile(far, 0.5) / max(_quantile(near, 0.5), 1e-9)
        yield Figure(f"{group} drift over jitter", "", f"still {group}", ratio)


def _bone_steps(recordings: Sequence[Observed]) -> Iterator[Figure]:
    for group, joints in GROUPS.items():
        for pace in PACES:
            found = [
                np.abs(np.diff(seen.bones[:, joints], axis=0))[seen.at(pace)[1:, joints]]
                for seen in recordings
            ]
            yield from _spread(f"{group} bone, change a frame", f"{pace} {group}", found)


def _bone_deviations(recordings: Sequence[Observed]) -> Iterator[Figure]:
    """Deviation over WINDOW frames, by how far the joint goes in them."""
    for group, joints in GROUPS.items():
        lengths, ways = [], []
        for seen in recordings:
            for start in range(0, len(seen.joints) - WINDOW + 1, WINDOW):
                window = slice(start, start + WINDOW)
                lengths += list(seen.bones[window, joints].T)
                ways += list(seen.speeds[window, joints].sum(axis=0) / FRAME_RATE)
        for lowest, highest in WAYS:
            chosen = [
                values for values, way in zip(lengths, ways, strict=True) if lowest <= way < highest
            ]
            on = f"{group} that goes {lowest:.1f} to {highest:.1f} m in 1.5 s"
            for name, spread in (("", np.std), ("robust ", _robust_deviation)):
                found = [float(spread(values)) for values in chosen]
                value = 1000.0 * float(np.mean(found)) if found else np.nan
                yield Figure(f"{group} bone, {name}deviation", "mm", on, value)


def _bone_stretches(people: Sequence[Sequence[Observed]]) -> Iterator[Figure]:
    """How much a bone's usual length in WINDOW frames differs between such stretches of a person,
    in whatever recording: their deviation, its mean over people and bones."""
    medians = [
        np.array(
            [
                np.median(seen.bones[start : start + WINDOW], axis=0)
                for seen in recordings
                for start in range(0, len(seen.joints) - WINDOW + 1, WINDOW)
            ]
        )
        for recordings in people
    ]
    spreads = [np.std(one, axis=0, ddof=1) for one in medians if len(one) > 1]
    for group, joints in GROUPS.items():
        value = 1000.0 * float(np.mean(np.array(spreads)[:, joints])) if spreads else np.nan
        name = f"{group} bone, deviation between stretches"
        yield Figure(name, "mm", "1.5 s of one person", value)


def _departures(recordings: Sequence[Observed]) -> Iterator[Figure]:
    """Wrists and hands that leave the arm."""
    for name, place, limit in (("forearm", 1, 0.3), ("hand", 2, 0.5)):
        masks = []
        for seen in recordings:
            usual = np.median(seen.bones, axis=0)
            away = np.abs(seen.bones - usual) > limit * usual
            masks += [(seen.speeds[:, arm[1]], away[:, arm[place]]) for arm in ARMS]
        yield from _episodes(f"{name} off by {100 * limit:.0f} %", masks)


def _flips(recordings: Sequence[Observed]) -> Iterator[Figure]:
    masks = [
        (seen.speeds[:, arm[1]], hand_bends(seen.joints, arm) > FLIPPED)
        for seen in recordings
        for arm in ARMS
    ]
    yield from _episodes(f"hand turned by {FLIPPED:.0f}°", masks)


def _episodes(name: str, masks: list[tuple[Array, Flags]]) -> Iterator[Figure]:
    """Share of the frames by the wrist's speed (T,), and the mean number of frames in a row."""
    speed = np.concatenate([speed for speed, _ in masks])
    concerned = np.concatenate([mask for _, mask in masks])
    for pace in ("slow", "brisk", "fast"):
        lowest, highest = PACES[pace]
        inside = concerned[(speed >= lowest) & (speed < highest)]
        share = 100.0 * float(inside.mean()) if len(inside) else np.nan
        yield Figure(name, "% of frames", f"{pace} wrist", share)
    lengths = np.concatenate([_run_lengths(mask) for _, mask in masks])
    mean = float(lengths.mean()) if len(lengths) else np.nan
    yield Figure(f"{name}, length", "frames", "all", mean)


def _proportions(recordings: Sequence[Observed]) -> Iterator[Figure]:
    """Bones over the trunk, hip centre to shoulder centre."""
    medians = np.mean([np.median(seen.bones, axis=0) for seen in recordings], axis=0)
    trunk = float(medians[Joint.SPINE] + medians[Joint.SHOULDER_CENTER])
    for group, joints in GROUPS.items():
        if group != "trunk":
            length = float(np.mean(medians[list(joints)]))
            yield Figure(f"{group} bone over trunk", "", "all", length / trunk)


def _spread(name: str, on: str, found: list[Array]) -> Iterator[Figure]:
    """Median and ninth decile in millimetres."""
    yield Figure(f"{name}, median", "mm", on, 1000.0 * _quantile(found, 0.5))
    yield Figure(f"{name}, 90 %", "mm", on, 1000.0 * _quantile(found, 0.9))


def _quantile(found: list[Array], share: float) -> float:
    values = np.concatenate(found)
    return float(np.quantile(values, share)) if len(values) else np.nan


def _robust_deviation(values: Array) -> float:
    return float(1.4826 * np.median(np.abs(values - np.median(values))))


def _run_lengths(mask: Flags) -> Indices:
    edges = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]])))
    return np.asarray(edges[1::2] - edges[::2])
