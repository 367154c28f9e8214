"""The last seconds of each object in each person's hands, put together from messages."""

from collections import OrderedDict, deque
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from inhand_schemas.messages import CameraInfo, ObjectPose, Person, Pose, Skeletons

from inhand_outcomes.arrays import Array
from inhand_outcomes.days import NS_PER_S
from inhand_outcomes.parameters import DEFAULT_GATHERING, GatheringParameters
from inhand_outcomes.room import Room
from inhand_outcomes.rotations import matrices, multiply
from inhand_outcomes.track import Track

STILL = Pose((0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))


@dataclass(frozen=True)
class Holding:
    """Whose track it is: an object and the person who uses it, None for nobody."""

    object: str
    person: int | None


@dataclass(frozen=True)
class Sighting:
    """One frame of an object in the rig's frame: pose (7,), covariance (6, 6), joints (20, 3)."""

    time_ns: int
    sequence: int
    pose: Array
    covariance: Array
    seen: bool
    joints: Array


class Gathering:
    """What has come of one object in one person's hands and is still needed."""

    def __init__(self, parameters: GatheringParameters = DEFAULT_GATHERING) -> None:
        self.sightings: deque[Sighting] = deque()
        self._parameters = parameters

    @property
    def first_ns(self) -> int:
        """Capture time of the first sighting."""
        return self.sightings[0].time_ns

    @property
    def last_ns(self) -> int:
        """Capture time of the last sighting."""
        return self.sightings[-1].time_ns

    def continues(self, time_ns: int) -> bool:
        """Whether a sighting at this time goes on from the last: later, and soon enough."""
        gap = time_ns - self.last_ns
        return 0 < gap <= self._parameters.longest_gap_s * NS_PER_S

    def add(self, sighting: Sighting) -> None:
        """Take a sighting that continues; the oldest are forgotten in steps."""
        self.sightings.append(sighting)
        kept = self._parameters.window_s + self._parameters.forgotten_at_once_s
        if sighting.time_ns - self.first_ns > kept * NS_PER_S:
            oldest = sighting.time_ns - self._parameters.window_s * NS_PER_S
            while self.sightings[0].time_ns < oldest:
                self.sightings.popleft()

    def track(self, room: Room) -> Track:
        """Put the sightings together in the room; times count from ``first_ns``."""
        rows = self.sightings
        times = np.array([row.time_ns - self.first_ns for row in rows]) / NS_PER_S
        return room.place(
            Track(
                times,
                np.array([row.pose for row in rows]),
                np.array([row.covariance for row in rows]),
                np.array([row.seen for row in rows]),
                np.array([row.joints for row in rows]),
            )
        )


class Sightings:
    """Joins poses with the skeletons of the same frame, in the rig's frame."""

    def __init__(self, parameters: GatheringParameters = DEFAULT_GATHERING) -> None:
        self._parameters = parameters
        self._rig_from_camera: dict[str, Pose] = {}
        self._people: OrderedDict[tuple[str, int], Mapping[int, Person]] = OrderedDict()

    def hear_info(self, camera: str, info: CameraInfo) -> None:
        """Take note of where a camera stands in the rig."""
        self._rig_from_camera[camera] = info.rig_from_camera

    def hear_skeletons(self, camera: str, skeletons: Skeletons) -> None:
        """Keep the people of a frame for the poses that follow it."""
        people = {person.id: person for person in skeletons.people}
        self._people[camera, skeletons.time_ns] = people
        while len(self._people) > self._parameters.frames_that_wait:
            self._people.popitem(last=False)

    def knows(self, camera: str, time_ns: int) -> bool:
        """Whether the people of a frame have come."""
        return (camera, time_ns) in self._people

    def sighting(self, message: ObjectPose, last: Sighting | None) -> Sighting | None:
        """What a pose says after the ``last`` sighting of its track; None where neither says where
        the object is.

        A lost object is where it was seen last.
        """
        rig_from_camera = self._rig_from_camera.get(message.camera, STILL)
        turn = matrices(rig_from_camera.rotation)
        pose = None if last is None else last.pose
        covariance = np.eye(6)
        if message.camera_from_object is not None:
            inner = message.camera_from_object
            place = turn @ np.array(inner.translation) + rig_from_camera.translation
            rotation = multiply(np.array(rig_from_camera.rotation), np.array(inner.rotation))
            pose = np.concatenate([place, rotation])
            if message.covariance is not None:
                both = np.kron(np.eye(2), turn)
                covariance = both @ np.array(message.covariance).reshape(6, 6) @ both.T
        if pose is None:
            return None
        seen = (
            message.state == "tracked"
            and message.covariance is not None
            and message.confidence >= self._parameters.least_confidence
        )
        people = self._people.get((message.camera, message.time_ns), {})
        person = None if message.person is None else people.get(message.person)
        joints = np.full((20, 3), np.nan)
        if person is not None:
            joints = joints_of(person, rig_from_camera)
        return Sighting(message.time_ns, message.sequence, pose, covariance, seen, joints)


def joints_of(person: Person, rig_from_camera: Pose | None = None) -> Array:
    """A person's joints (20, 3), NaN where missing, in the rig, or else as the camera has them."""
    joints = np.array(person.joints)
    joints[[state == "missing" for state in person.states]] = np.nan
    if rig_from_camera is None:
        return joints
    turn = matrices(rig_from_camera.rotation)
    return joints @ turn.T + np.array(rig_from_camera.translation)
