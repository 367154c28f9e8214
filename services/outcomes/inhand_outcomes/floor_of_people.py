"""Where the floor is, from skeletons alone: people stand upright, and their feet are on the floor.

The plane is fitted by least squares to where feet rested and to the directions from the feet of
people who stand up to their shoulders. People who sit or stoop say nothing of up.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from inhand_schemas.joints import Joint

from inhand_outcomes.arrays import Array, Flags
from inhand_outcomes.floor import Floor


@dataclass(frozen=True)
class StandingParameters:
    """How much standing people say of the floor."""

    straight: float = 0.97
    """Distance from hip to ankle as a share of the way over the knee, at least, in a leg that
    stands: 0.97 is a knee bent by 28 degrees."""
    upright_deg: float = 18.0
    """Angle between the spine and the way from the feet to the hips, at most, of who stands and
    does not stoop."""
    lean_deg: float = 3.0
    """Deviation of one person's way from feet to shoulders from up: people sway and lean, and
    their skeletons are read with a bias."""
    ankle_m: float = 0.075
    """Height of an ankle above the floor: 0.039 statures (Drillis and Contini, 1966), and
    skeleton trackers' ankles are a little higher."""
    ankle_deviation_m: float = 0.025
    """Deviation of it between people and of its reading."""
    still_m_s: float = 0.15
    """Speed of a foot that rests, at most."""
    stay_m: float = 0.25
    """Distance within which feet that rest, and people who stand, are one piece of evidence."""
    least_stays: int = 20
    """Number of frames of standing people without which nothing is said."""
    surest_deg: float = 1.0
    """Deviation of up below which no number of people brings it: they are read alike."""


DEFAULT_STANDING = StandingParameters()


def find_floor_of_people(
    times: Array, joints: Array, people: Array, parameters: StandingParameters = DEFAULT_STANDING
) -> Floor | None:
    """Find the floor from N skeletons in the rig's frame; None where nobody surely stood.

    ``times`` (N,) are seconds, rising for each person; ``joints`` (N, 20, 3) have NaN where
    missing; ``people`` (N,) tell people apart.
    """
    standing = _standing(joints, parameters)
    if standing.sum() < parameters.least_stays:
        return None
    feet = joints[:, [Joint.ANKLE_LEFT, Joint.ANKLE_RIGHT]]
    ups = joints[:, Joint.SHOULDER_CENTER] - feet.mean(axis=1)
    ups /= np.linalg.norm(ups, axis=1, keepdims=True)
    middle = feet.mean(axis=1)
    directions, places = [], []
    for person in np.unique(people):
        of = people == person
        for stay in _stays(middle[of & standing], parameters):
            directions.append(np.median(ups[of & standing][stay], axis=0))
        for side in range(2):
            rests = of & _rests(times, feet[:, side], people, parameters)
            resting = feet[rests, side]
            places += [np.median(resting[stay], axis=0) for stay in _stays(resting, parameters)]
    if not directions or not places:
        return None
    return _fitted(
        np.array(directions), np.array(places), len(np.unique(people[standing])), parameters
    )


def _standing(joints: Array, parameters: StandingParameters) -> Flags:
    """Where (N,) both legs are straight and the trunk is in line with them."""
    standing = np.ones(len(joints), bool)
    hips = 0.5 * (joints[:, Joint.HIP_LEFT] + joints[:, Joint.HIP_RIGHT])
    for hip, knee, ankle in (
        (Joint.HIP_LEFT, Joint.KNEE_LEFT, Joint.ANKLE_LEFT),
        (Joint.HIP_RIGHT, Joint.KNEE_RIGHT, Joint.ANKLE_RIGHT),
    ):
        whole = np.linalg.norm(joints[:, hip] - joints[:, ankle], axis=1)
        thigh = np.linalg.norm(joints[:, hip] - joints[:, knee], axis=1)
        shank = np.linalg.norm(joints[:, knee] - joints[:, ankle], axis=1)
        standing &= whole >= parameters.straight * (thigh + shank)
    legs = hips - 0.5 * (joints[:, Joint.ANKLE_LEFT] + joints[:, Joint.ANKLE_RIGHT])
    spine = joints[:, Joint.SHOULDER_CENTER] - hips
    lengths = np.linalg.norm(legs, axis=1) * np.linalg.norm(spine, axis=1)
    cosine = np.sum(legs * spine, axis=1) / np.maximum(lengths, 1e-9)
    return standing & (cosine >= np.cos(np.radians(parameters.upright_deg)))


def _rests(times: Array, foot: Array, people: Array, parameters: StandingParameters) -> Flags:
    """Where (N,) a foot (N, 3) moves so slowly that it is on the floor."""
    rests = np.zeros(len(times), bool)
    for person in np.unique(people):
        rows = np.flatnonzero((people == person) & np.isfinite(foot).all(axis=1))
        if len(rows) < 3:
            continue
        # Over a quarter of a second: from frame to frame the noise moves a foot faster than this.
        span = 0.25
        later = np.clip(np.searchsorted(times[rows], times[rows] + span), 0, len(rows) - 1)
        elapsed = times[rows][later] - times[rows]
        way = np.linalg.norm(foot[rows][later] - foot[rows], axis=1)
        rests[rows] = (
            (elapsed > 0.5 * span)
            & (elapsed < 2.0 * span)
            & (way < parameters.still_m_s * np.maximum(elapsed, 1e-9))
        )
    return rests


def _stays(places: Array, parameters: StandingParameters) -> list[Flags]:
    """Groups of places (N, 3), each near one of them, as flags (N,)."""
    stays: list[Flags] = []
    left = np.isfinite(places).all(axis=1)
    while left.any():
        centre = places[np.flatnonzero(left)[0]]
        stay = left & (np.linalg.norm(places - centre, axis=1) < parameters.stay_m)
        left &= ~stay
        if stay.sum() >= 3:
            stays.append(stay)
    return stays


def _fitted(
    directions: Array, places: Array, persons: int, parameters: StandingParameters
) -> Floor | None:
    """The plane by iterated weighted least squares; outliers of both kinds count little."""
    lean = np.radians(parameters.lean_deg)
    up = np.median(directions, axis=0)
    up /= np.linalg.norm(up)
    information = np.zeros((2, 2))
    centre = places.mean(axis=0)
    trust = np.ones(len(places))
    for _ in range(10):
        level = np.stack(_level_axes(up))
        off = directions @ level.T
        faith = 1.0 / (1.0 + np.sum(off**2, axis=1) / (2.0 * lean) ** 2)
        # One person leans alike wherever they stand: stays add to what a person says, not squared.
        share = min(len(directions), 4 * persons) / len(directions)
        by_spines = share * faith / lean**2
        centre = np.average(places, axis=0, weights=trust)
        across = (places - centre) @ level.T
        heights = (places - centre) @ up
        trust = 1.0 / (1.0 + (heights / (2.0 * parameters.ankle_deviation_m)) ** 2)
        by_feet = trust / parameters.ankle_deviation_m**2
        information = by_spines.sum() * np.eye(2) + (across * by_feet[:, None]).T @ across
        push = (by_spines[:, None] * off).sum(axis=0) - (across * by_feet[:, None]).T @ heights
        up = up + np.linalg.solve(information, push) @ level
        up /= np.linalg.norm(up)
    covariance = np.linalg.inv(information)
    angle = float(np.hypot(np.degrees(np.sqrt(np.trace(covariance) / 2.0)), parameters.surest_deg))
    height = float(centre @ up) - parameters.ankle_m
    stays = max(min(len(places), 2 * persons), 1)
    deviation = parameters.ankle_deviation_m * float(np.hypot(1.0 / np.sqrt(stays), 0.5))
    return Floor(up, height, angle, deviation)


def _level_axes(up: Array) -> Sequence[Array]:
    """Two unit vectors (3,) across up (3,), square to each other."""
    side = np.eye(3)[int(np.argmin(np.abs(up)))]
    first = np.cross(up, side)
    first /= np.linalg.norm(first)
    return first, np.cross(up, first)
