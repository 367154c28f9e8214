"""Looks for the floor, and so for up, now and then: in depth images, or else in people."""

from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from inhand_runtime.pixels import decode_depth
from inhand_schemas.messages import CameraInfo, Person, RgbdFrame, Skeletons
from numpy.typing import NDArray

from inhand_outcomes.arrays import Array
from inhand_outcomes.days import NS_PER_S
from inhand_outcomes.floor import Floor, find_floor, together
from inhand_outcomes.floor_of_people import find_floor_of_people
from inhand_outcomes.gathering import joints_of
from inhand_outcomes.room import Room


@dataclass(frozen=True)
class FloorWatchParameters:
    """How often is looked, and for how long it counts."""

    first_looks: int = 3
    """Number of depth images in which the floor is found before it is looked for less often."""
    first_period_s: float = 2.0
    """Seconds from one look to the next until then."""
    period_s: float = 300.0
    """Seconds from one look to the next afterwards: cameras are bumped, and turned."""
    floors: int = 5
    """Number of looks that count together."""
    people_period_s: float = 0.5
    """Seconds between the skeletons that are kept, where there is no depth."""
    people_frames: int = 600
    """Number of skeletons that are kept: five minutes."""
    people_look_s: float = 15.0
    """Seconds from one look at them to the next."""


DEFAULT_FLOOR_WATCH = FloorWatchParameters()

OnDepth = Callable[[NDArray[np.uint16], CameraInfo, Room, Sequence[Array]], None]
"""What is told of each depth image with a floor: depth (H, W), its camera, the room, and the joints
(20, 3) in the rig of the people in it."""


class FloorWatch:
    """The floor of a rig by its cameras; times are those of captures.

    ``room`` is None until a floor was found. Depth comes before what people's bodies say.
    ``on_depth`` is told of each depth image in which the floor was found.
    """

    def __init__(
        self,
        on_depth: OnDepth,
        parameters: FloorWatchParameters = DEFAULT_FLOOR_WATCH,
    ) -> None:
        self._on_depth = on_depth
        self.room: Room | None = None
        self._parameters = parameters
        self._infos: dict[str, CameraInfo] = {}
        self._people: dict[str, tuple[Person, ...]] = {}
        self._floors: deque[Floor] = deque(maxlen=parameters.floors)
        self._looked_ns: int | None = None
        self._bodies: deque[tuple[int, int, Array]] = deque(maxlen=parameters.people_frames)
        self._bodies_looked_ns = 0

    def hear_info(self, camera: str, info: CameraInfo) -> None:
        """Take note of how a camera sees, and where it stands."""
        self._infos[camera] = info

    def hear_skeletons(self, camera: str, skeletons: Skeletons) -> None:
        """Take the people of a frame."""
        self._people[camera] = skeletons.people
        for person in skeletons.people:
            self._keep_body(camera, skeletons.time_ns, person)
        waited_ns = abs(skeletons.time_ns - self._bodies_looked_ns)
        if not self._floors and waited_ns > self._parameters.people_look_s * NS_PER_S:
            self._bodies_looked_ns = skeletons.time_ns
            self._look_at_bodies()

    def wants_frame(self, now_ns: int) -> bool:
        """Whether a depth image is to be looked at now."""
        if self._looked_ns is None:
            return True
        found = len(self._floors) >= self._parameters.first_looks
        period_s = self._parameters.period_s if found else self._parameters.first_period_s
        return abs(now_ns - self._looked_ns) >= period_s * NS_PER_S

    def hear_frame(self, camera: str, frame: RgbdFrame) -> None:
        """Look at a frame's depth, if it is time to; raises MessageError for damaged depth."""
        info = self._infos.get(camera)
        if info is None or not self.wants_frame(frame.time_ns):
            return
        self._looked_ns = frame.time_ns
        if frame.depth is None:
            return
        depth, people = decode_depth(frame.depth), self._people.get(camera, ())
        floor = find_floor(depth, info, [joints_of(one) for one in people])
        if floor is None:
            return
        self._floors.append(floor.in_rig(info.rig_from_camera))
        found = together(self._floors)
        if found is None:  # the camera was moved: only the newest holds
            newest = self._floors[-1]
            self._floors.clear()
            self._floors.append(newest)
            found = newest
        self.room = found.room
        in_rig = [joints_of(one, info.rig_from_camera) for one in people]
        self._on_depth(depth, info, self.room, in_rig)

    def _keep_body(self, camera: str, time_ns: int, person: Person) -> None:
        if self._bodies:
            apart_ns = abs(time_ns - self._bodies[-1][0])
            if apart_ns < self._parameters.people_period_s * NS_PER_S:
                return
        info = self._infos.get(camera)
        joints = joints_of(person, None if info is None else info.rig_from_camera)
        self._bodies.append((time_ns, person.id, joints))

    def _look_at_bodies(self) -> None:
        if not self._bodies:
            return
        times, people, joints = zip(*self._bodies, strict=True)
        seconds = (np.array(times) - times[0]) / NS_PER_S
        floor = find_floor_of_people(seconds, np.array(joints), np.array(people))
        if floor is not None:
            self.room = floor.room
