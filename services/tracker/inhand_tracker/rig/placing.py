"""Learns how far a rig's cameras are from where their calibration has them, while objects are seen.

placing = Placing("front")
placing.place("front", HERE, deviation)
placing.place("left", home_from_left, deviation)
home_from_left = placing.found("left")
placing.note(pulls, time_ns)  # what each image alone said of an object that all of them show
placing.settle()
home_from_left = placing.found("left")

It is recursive least squares, with the calibration's deviations as a prior that is never forgotten,
while what was seen is, within minutes: so nothing drifts away. The first camera stays where it is,
as only differences show.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.image import ViewPull
from inhand_tracker.geometry.placement import Placement
from inhand_tracker.rig.parameters import DEFAULT_RIG, RigParameters

LONGEST_S = 1.0
"""Seconds, at the most, that count of the time between two things that were seen."""
LEAST_INFORMATION = 1e-3
"""Information in a pose, per square metre and square radian, that says as good as nothing."""


@dataclass(frozen=True)
class PlaceDeviation:
    """How far a camera may be from where it is said to be, by standard deviations along and about
    each axis."""

    translation_m: float
    rotation_rad: float

    def at_least(self, translation_m: float, rotation_rad: float) -> "PlaceDeviation":
        """Return the deviation, no smaller than that."""
        return PlaceDeviation(
            max(self.translation_m, translation_m), max(self.rotation_rad, rotation_rad)
        )

    @property
    def covariance(self) -> Array:
        """The covariance (6, 6) of the camera's translation and of its rotation about itself."""
        return np.diag(np.repeat(np.square([self.translation_m, self.rotation_rad]), 3))


class Placing:
    """Knows where cameras of a rig are, in the frame of the ``home`` one: where they were said to
    be (``place``), moved by a translation and a rotation about themselves that were learned."""

    def __init__(self, home: str, parameters: RigParameters = DEFAULT_RIG) -> None:
        self._home = home
        self._parameters = parameters
        self._said: dict[str, tuple[Placement, PlaceDeviation]] = {}
        self._start()

    def place(self, camera: str, home_from_camera: Placement, deviation: PlaceDeviation) -> None:
        """Take a camera to be at a place; what was learned is of no use where it was another."""
        before = self._said.get(camera)
        if before is not None and _same(before, (home_from_camera, deviation)):
            return
        self._said[camera] = home_from_camera, deviation
        self._start()

    @property
    def cameras(self) -> tuple[str, ...]:
        """The cameras whose places are known."""
        return tuple(self._said)

    def found(self, camera: str) -> Placement:
        """Return ``home_from_camera`` as it is believed to be since the last ``settle``."""
        place = self._said[camera][0]
        if camera not in self._others:
            return place
        shift, turn = np.split(self._believed[self._part(camera)], 2)
        return Placement(
            place.translation + shift,
            rotations.multiply(rotations.from_vector(turn), place.rotation),
        )

    def covariance(self, camera: str) -> Array:
        """Return the covariance (6, 6) of a camera's translation, and of its rotation about itself,
        that remains; that of the home camera is zero. What was learned and is not believed remains
        too."""
        if camera not in self._others:
            return np.zeros((6, 6))
        part = self._part(camera)
        rest = self._mean[part] - self._believed[part]
        return self._covariance[part, part] + np.outer(rest, rest)

    @property
    def misplaced(self) -> dict[str, float]:
        """Cameras that are farther from where they were said to be than their calibration allows,
        and by how many metres what they see is off."""
        return {
            camera: self._off_m(camera)
            for camera in self._others
            if self._excesses[camera] >= self._parameters.place_most
        }

    def settle(self) -> None:
        """Believe cameras to be where they were found to be by now, as far as their calibration
        allows. What is noted is of images that were looked at by what is believed."""
        for camera in self._others:
            share = min(1.0, self._parameters.place_most / max(self._excesses[camera], 1e-9))
            part = self._part(camera)
            self._believed[part] = share * self._mean[part]

    def restart(self) -> None:
        """Forget what was learned."""
        self._start()

    def note(self, pulls: Sequence[ViewPull], time_ns: int) -> None:
        """Take what images of several cameras said of one object at a time."""
        self._take(self._of_objects, pulls, time_ns)

    def note_person(self, pulls: Sequence[ViewPull], time_ns: int) -> None:
        """Take where several cameras have one person at a time. All times together say no more than
        one: skeletons of a camera err the same way for long."""
        self._take(self._of_people, pulls, time_ns)

    def _take(self, evidence: "_Evidence", pulls: Sequence[ViewPull], time_ns: int) -> None:
        known = [one for one in pulls if one.camera in self._said]
        if not self._others or len({one.camera for one in known}) < 2:
            return
        evidence.forget(time_ns, self._parameters.place_memory_s)
        levers = [self._lever_of(one) for one in known]
        share = self._share(known, levers)
        information, pull = _evidence_of(known, levers)
        evidence.information += share * information
        evidence.pull += share * (information @ self._believed + pull)
        evidence.times += 1.0
        self._seen_at = np.mean([one.at for one in known], axis=0)
        self._solve()

    def _start(self) -> None:
        """Start anew, from where cameras are said to be."""
        self._others = [camera for camera in self._said if camera != self._home]
        size = 6 * len(self._others)
        self._of_objects = _Evidence(np.zeros((size, size)), np.zeros(size))
        self._of_people = _Evidence(np.zeros((size, size)), np.zeros(size))
        self._mean, self._believed = np.zeros(size), np.zeros(size)
        self._seen_at = np.zeros(3)
        self._prior = self._said_covariance()
        self._known = np.linalg.inv(self._prior)
        self._covariance = self._prior
        self._excesses = dict.fromkeys(self._others, 0.0)

    def _said_covariance(self) -> Array:
        """The covariance (6 N, 6 N) of other cameras' places in the frame of the home one: that
        camera's own error moves all of them."""
        size = 6 * len(self._others)
        covariance = np.zeros((size, size))
        if self._home in self._said:
            places = [self._said[camera][0] for camera in self._others]
            levers = np.reshape([_lever(place.translation) for place in places], (size, 6))
            covariance += levers @ self._said[self._home][1].covariance @ levers.T
        for camera in self._others:
            part = self._part(camera)
            covariance[part, part] += self._said[camera][1].covariance
        return covariance

    def _part(self, camera: str) -> slice:
        first = 6 * self._others.index(camera)
        return slice(first, first + 6)

    def _lever_of(self, pull: ViewPull) -> Array:
        """The matrix (6, 6 N) that takes errors of places to those of an object in an image."""
        lever = np.zeros((6, len(self._mean)))
        if pull.camera in self._others:
            arm = pull.at - self.found(pull.camera).translation
            lever[:, self._part(pull.camera)] = _lever(arm)
        return lever

    def _share(self, pulls: Sequence[ViewPull], levers: Sequence[Array]) -> float:
        """How much a time counts: hardly where images disagree by far more than places explain, as
        something else is wrong then (Student's t, and its square, so that no leap counts)."""
        parameters = self._parameters
        errors = np.diag([parameters.pull_error_m**2] * 3 + [parameters.pull_error_rad**2] * 3)
        said = []
        for one, lever in zip(pulls, levers, strict=True):
            unsure = lever @ self._covariance @ lever.T + errors
            less = np.linalg.solve(np.eye(6) + one.information @ unsure, one.information)
            said.append(np.asarray(less, np.float64))
        moved = _agreed(said, [one.deviation for one in pulls])
        square = sum(
            float((one.deviation - moved) @ weight @ (one.deviation - moved))
            for one, weight in zip(pulls, said, strict=True)
        )
        freedom, expected = parameters.place_freedom, 6.0 * (len(pulls) - 1)
        share = (freedom + expected) / (freedom + max(square, expected))
        return share * share

    def _solve(self) -> None:
        """Find the most probable places by what was said, and what was seen since."""
        objects, people = self._of_objects, self._of_people
        share, times = self._parameters.place_share, max(people.times, 1.0)
        seen = share * objects.information + people.information / times
        self._covariance = np.asarray(np.linalg.inv(self._known + seen), np.float64)
        self._mean = self._covariance @ (share * objects.pull + people.pull / times)
        self._excesses = {camera: self._excess(camera) for camera in self._others}

    def _off_m(self, camera: str) -> float:
        """How far what was seen last is from where it would be if the camera were where it was said
        to be."""
        lever = _lever(self._seen_at - self._said[camera][0].translation)
        return float(np.linalg.norm((lever @ self._mean[self._part(camera)])[:3]))

    def _excess(self, camera: str) -> float:
        """How far a camera is from where it was said to be by what was learned, in deviations."""
        part = self._part(camera)
        off = self._mean[part]
        return float(np.sqrt(off @ np.linalg.solve(self._prior[part, part], off)))


@dataclass
class _Evidence:
    """What was seen so far: ``information`` (6 N, 6 N) in places of N cameras, and it times those
    that are the most probable ones by it, ``pull`` (6 N,); of about so many ``times``, the last one
    at ``time_ns``."""

    information: Array
    pull: Array
    times: float = 0.0
    time_ns: int | None = None

    def forget(self, time_ns: int, memory_s: float) -> None:
        """Let what was seen count less by the time that has passed; a pause is no time."""
        elapsed_s = 0.0 if self.time_ns is None else (time_ns - self.time_ns) / 1e9
        kept = np.exp(-min(max(elapsed_s, 0.0), LONGEST_S) / memory_s)
        self.information *= kept
        self.pull *= kept
        self.times *= kept
        self.time_ns = time_ns


def _evidence_of(pulls: Sequence[ViewPull], levers: Sequence[Array]) -> tuple[Array, Array]:
    """What images say of where cameras are, beyond where they are taken to be, whatever the
    object's true pose is: information (6 N, 6 N), and that times the error, (6 N,)."""
    each = [one.information for one in pulls]
    moved = _agreed(each, [one.deviation for one in pulls])
    across = np.sum([said @ lever for said, lever in zip(each, levers, strict=True)], axis=0)
    information = -across.T @ np.linalg.solve(_whole(each), across)
    pull = np.zeros(len(information))
    for one, lever in zip(pulls, levers, strict=True):
        information += lever.T @ one.information @ lever
        pull += lever.T @ one.information @ (moved - one.deviation)
    return information, pull


def _agreed(informations: Sequence[Array], deviations: Sequence[Array]) -> Array:
    """Average deviations (6,) by their informations (6, 6)."""
    both = zip(informations, deviations, strict=True)
    pull = np.sum([information @ deviation for information, deviation in both], axis=0)
    return np.asarray(np.linalg.solve(_whole(informations), pull))


def _whole(informations: Sequence[Array]) -> Array:
    """Add up informations (6, 6), with as much as makes the sum regular."""
    return np.asarray(np.sum(informations, axis=0) + LEAST_INFORMATION * np.eye(6))


def _lever(arm: Array) -> Array:
    """The matrix (6, 6) that takes a small motion, a translation and a rotation about a point, to
    that of what is at ``arm`` (3,) from that point."""
    x, y, z = arm
    lever = np.eye(6)
    lever[:3, 3:] = [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]]
    return lever


def _same(one: tuple[Placement, PlaceDeviation], other: tuple[Placement, PlaceDeviation]) -> bool:
    return (
        np.array_equal(one[0].translation, other[0].translation)
        and np.array_equal(one[0].rotation, other[0].rotation)
        and one[1] == other[1]
    )
