"""``inhand bench outcomes --real``: golf with a measured club, tennis mimed before a Kinect.

Speeds are looked at 30 times a second, and held against the club's markers at their full rate.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from inhand_lab.importers.motion_archive import Motion, read_motion
from inhand_lab.importers.utd_mhad import RECORDED_RATE, SKELETON_SUFFIX, read_trial
from inhand_lab.objects.racket import racket
from inhand_outcomes.achievement import Achievement, Amount
from inhand_outcomes.arrays import Array
from inhand_outcomes.measures.swinging import golf as find_swings
from inhand_outcomes.measures.swinging import tennis as find_strokes
from inhand_outcomes.room import Room
from inhand_outcomes.thing import Thing
from inhand_outcomes.track import Track
from inhand_runtime.errors import SettingsError
from inhand_schemas.joints import Joint
from rich.table import Table
from scipy.spatial.transform import Rotation

from inhand.results import listing

FRAME_RATE = 30.0
"""Frames a second that are used of faster recordings: a depth camera's."""
SURE = 0.5
"""Probability from which an achievement counts."""
GOLF = "hitGolfBall"
"""The interaction that an archive of golf names."""
TENNIS_ACTIONS = ("a15", "a17")
"""Tennis swing and tennis serve of UTD-MHAD: one stroke in each file."""
ERROR_M, ERROR_RAD = 0.01, np.radians(3.0)
"""Deviation of a measured club's place and rotation, and of a hand's where it was tracked."""


@dataclass(frozen=True)
class RealGolf:
    """A golf swing: one reading of it for each of the ways to take 30 frames of a second's.

    Of each: swings found, and the speed (m/s), its deviation and the plane (degrees) of the
    fastest, NaN where there is none; ``measured_m_s`` is from the markers at their full rate.
    """

    name: str
    swings: Sequence[int]
    speeds_m_s: Sequence[float]
    deviations_m_s: Sequence[float]
    angles_deg: Sequence[float]
    measured_m_s: float


@dataclass(frozen=True)
class RealTennis:
    """A mimed stroke: how many were found, and how fast the head of a racket in that hand was."""

    name: str
    strokes: int
    speed_m_s: float


@dataclass(frozen=True)
class RealSwings:
    """What was found in recordings of real people."""

    golf: Sequence[RealGolf]
    tennis: Sequence[RealTennis]


def check_real_swings(folders: Sequence[Path]) -> RealSwings:
    """Find the swings of motion archives and the strokes of UTD-MHAD's tennis in folders.

    Raises SettingsError where there are none, and DatasetError for a file that cannot be read.
    """
    for folder in folders:
        if not folder.is_dir():
            raise SettingsError(f"there is no folder {folder}")
    golf, strokes = golf_swings(folders), tennis_strokes(folders)
    if not golf and not strokes:
        raise SettingsError(
            f"no motion archive of a golf swing, and no tennis of UTD-MHAD "
            f"({', '.join(TENNIS_ACTIONS)}), is in {', '.join(map(str, folders))}"
        )
    return RealSwings(golf, strokes)


def golf_swings(folders: Sequence[Path]) -> list[RealGolf]:
    """Find the swings of the motion archives in folders that show golf; raises DatasetError."""
    motions = [read_motion(path) for folder in folders for path in sorted(folder.glob("*.npz"))]
    return [
        _golf_swing(one) for one in motions if one.interaction == GOLF and one.object is not None
    ]


def tennis_strokes(folders: Sequence[Path]) -> list[RealTennis]:
    """Find the strokes of UTD-MHAD's tennis skeletons in folders; raises DatasetError."""
    files = [path for one in folders for path in sorted(one.glob(f"*{SKELETON_SUFFIX}"))]
    return [_tennis(path) for path in files if path.name.split("_")[0] in TENNIS_ACTIONS]


def golf_table(swings: Sequence[RealGolf]) -> Table:
    """A row a swing: the head's speed beside the measured one."""
    title = "golf swings of real people at 30 frames a second, beside the club's markers"
    columns = ("one", "m/s", "by markers", "off", "from", "to", "plane")
    table = listing(("swing",), columns, title)
    for one in swings:
        off = np.array(one.speeds_m_s) / one.measured_m_s - 1.0
        table.add_row(
            one.name,
            f"{one.swings.count(1)}/{len(one.swings)}",
            f"{np.nanmean(one.speeds_m_s):.1f}",
            f"{one.measured_m_s:.1f}",
            *(f"{value:+.1%}" for value in (np.nanmean(off), np.nanmin(off), np.nanmax(off))),
            f"{np.nanmean(one.angles_deg):.0f}",
        )
    return table


def tennis_table(strokes: Sequence[RealTennis]) -> Table:
    """A row an action: one stroke is in each recording."""
    table = listing(
        ("action",), ("recordings", "none", "one", "more"), "mimed strokes of real people"
    )
    for action in TENNIS_ACTIONS:
        counts = [one.strokes for one in strokes if one.name.split("_")[0] == action]
        numbers = (len(counts), counts.count(0), counts.count(1), sum(one > 1 for one in counts))
        table.add_row(action, *map(str, numbers))
    return table


def _golf_swing(motion: Motion) -> RealGolf:
    """Of the marked points, the head's are those that move farthest from the first frame on."""
    rotations = Rotation.from_quat(_filled(motion.orientations), scalar_first=True)
    places = _filled(motion.translations)
    points = np.stack([rotations.apply(p) + places for p in motion.marked_vertices], axis=1)
    way = np.linalg.norm(np.diff(points, axis=0), axis=2).sum(axis=0)
    head = motion.marked_vertices[way > 0.5 * (way.min() + way.max())].mean(axis=0)
    path = rotations.apply(head) + places
    speeds = np.linalg.norm(np.gradient(path, axis=0), axis=1) * motion.recorded_rate
    whole = _track(motion, places, rotations)
    club = Thing("club", "golf", motion.marked_vertices, np.empty((0, 3), int), {"head": head})
    step = max(round(motion.recorded_rate / FRAME_RATE), 1)
    readings = [
        [
            one
            for one in find_swings(whole[slice(first, None, step)], club)
            if one.probability >= SURE
        ]
        for first in range(step)
    ]
    fastest = [max(found, key=_speed).amounts if found else {} for found in readings]
    nothing = Amount(float("nan"), float("nan"))
    speeds_found = [one.get("speed_m_s", nothing) for one in fastest]
    return RealGolf(
        motion.path.stem,
        [len(found) for found in readings],
        [one.value for one in speeds_found],
        [one.deviation for one in speeds_found],
        [one.get("angle_deg", nothing).value for one in fastest],
        float(np.nanmax(speeds)),
    )


def _speed(one: Achievement) -> float:
    return one.amounts["speed_m_s"].value


def _track(motion: Motion, places: Array, rotations: Rotation) -> Track:
    """The club, with up where the player's hips are above the feet."""
    seen = np.asarray(np.isfinite(motion.translations).all(axis=1))
    feet = motion.joints[:, [Joint.ANKLE_LEFT, Joint.ANKLE_RIGHT]].mean(axis=1)
    up = np.nanmedian(motion.joints[:, Joint.HIP_CENTER] - feet, axis=0)
    poses = np.hstack([places, rotations.as_quat(scalar_first=True)])
    count = len(places)
    whole = Track(
        np.arange(count) / motion.recorded_rate,
        poses,
        _covariances(count),
        seen,
        motion.joints,
    )
    return Room(up / np.linalg.norm(up)).place(whole)


def _covariances(count: int) -> Array:
    return np.tile(np.diag([ERROR_M**2] * 3 + [ERROR_RAD**2] * 3), (count, 1, 1))


def _filled(values: Array) -> Array:
    """Values (T, K) with the last known one where one is missing, from the first known on."""
    known = np.flatnonzero(np.isfinite(values).all(axis=1))
    last = np.clip(np.searchsorted(known, np.arange(len(values)), side="right") - 1, 0, None)
    return values[known[last]]


def _tennis(path: Path) -> RealTennis:
    """The strokes of the hand that moves most, with a racket imagined in line with the forearm."""
    trial = read_trial(path)
    model = racket()
    thing = Thing(model.name, "tennis", np.asarray(model.vertices, float), np.asarray(model.faces))
    found: Sequence[Achievement] = max(
        (
            [one for one in find_strokes(track, thing) if one.probability >= SURE]
            for track in _hands(trial.joints_in_camera)
        ),
        key=lambda strokes: max((_speed(one) for one in strokes), default=0.0),
    )
    fastest = max((_speed(one) for one in found), default=float("nan"))
    return RealTennis(trial.stem, len(found), fastest)


def _hands(joints: Array) -> Iterator[Track]:
    """A racket in either hand of somebody (T, 20, 3) before a level camera."""
    count = len(joints)
    for elbow, hand in (
        (Joint.ELBOW_RIGHT, Joint.HAND_RIGHT),
        (Joint.ELBOW_LEFT, Joint.HAND_LEFT),
    ):
        forearm = joints[:, hand] - joints[:, elbow]
        seen = np.asarray(np.isfinite(forearm).all(axis=1))
        if seen.sum() < 2:
            continue
        along = _filled(forearm / np.linalg.norm(forearm, axis=1, keepdims=True))
        side = np.cross(along, [0.0, 1.0, 0.0])
        side /= np.maximum(np.linalg.norm(side, axis=1, keepdims=True), 1e-9)
        turns = np.stack([side, np.cross(along, side), along], axis=2)
        rotations = Rotation.from_matrix(turns)
        poses = np.hstack([_filled(joints[:, hand]), rotations.as_quat(scalar_first=True)])
        times = np.arange(count) / RECORDED_RATE
        track = Track(times, poses, _covariances(count), seen, joints)
        yield Room(np.array([0.0, -1.0, 0.0])).place(track)
