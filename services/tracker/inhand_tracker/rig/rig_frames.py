"""One frame of a rig, of what each camera captured about then: its people, and all its images.

frames = RigFrames({"front": rig_from_front, "left": rig_from_left})
frame = frames.join([Capture("front", time_ns, people, image), Capture("left", …)])
estimate = tracker.step(frame.people[0].joints, frame.time_ns, frame.image)

People and poses are in the frame of the first camera, whether it sees anything or not: so nothing
leaps where a camera fails. The frame's time is that of the first capture. Where the other cameras
stand from the first one is learned meanwhile (``placing``), also from what trackers tell of images.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from inhand_schemas.messages import Person

from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.image import Image, OtherView, ViewPull
from inhand_tracker.geometry.placement import HERE, Placement
from inhand_tracker.rig.parameters import DEFAULT_RIG, RigParameters
from inhand_tracker.rig.people_fusing import PeopleFuser
from inhand_tracker.rig.person_track import FusedPerson
from inhand_tracker.rig.placing import PlaceDeviation, Placing
from inhand_tracker.rig.sightings import CameraPeople


@dataclass(frozen=True)
class Capture:
    """What one camera has of a moment: its people, whose time is by the clock of the rig, and its
    image, None where that has not come."""

    camera: str
    time_ns: int
    people: Sequence[Person]
    image: Image | None


@dataclass(frozen=True)
class RigFrame:
    """The people and the images of a moment, in the frame of the rig's first camera; an image of
    another camera is one of the image's others. None where there is no image at all."""

    time_ns: int
    people: list[FusedPerson]
    image: Image | None


class RigFrames:
    """Joins what the cameras of a rig capture; ``places`` are their ``rig_from_camera``, in the
    order in which they are believed."""

    def __init__(
        self, places: Mapping[str, Placement], parameters: RigParameters = DEFAULT_RIG
    ) -> None:
        self._home = next(iter(places))
        self._home_from_rig = places[self._home].inverse()
        self._home_from: dict[str, Placement] = {}
        self._parameters = parameters
        self._placing = Placing(self._home, parameters)
        self._time_ns = 0
        self._fuser = PeopleFuser(self._home_from, parameters)
        for camera, place in places.items():
            self.place(camera, place)

    def place(
        self, camera: str, rig_from_camera: Placement, deviation: PlaceDeviation | None = None
    ) -> None:
        """Take a camera to be at a place of the rig, as surely as its calibration has it there; the
        frame of reference stays."""
        parameters = self._parameters
        if deviation is None:
            deviation = PlaceDeviation(parameters.place_m, parameters.place_rad)
        sure = deviation.at_least(parameters.least_place_m, parameters.least_place_rad)
        self._placing.place(camera, self._home_from_rig @ rig_from_camera, sure)
        self._move()

    @property
    def misplaced(self) -> Mapping[str, float]:
        """Cameras that are farther from where they are said to be than their calibration allows,
        and by how many metres what they see would be off."""
        return self._placing.misplaced

    def rig_from(self, camera: str) -> Placement:
        """Return ``rig_from_camera`` as far as it is known by now."""
        return self._home_from_rig.inverse() @ self._home_from[camera]

    def _move(self) -> None:
        """Let cameras be where they were found to be."""
        self._placing.settle()
        for camera in self._placing.cameras:
            self._home_from[camera] = self._placing.found(camera)

    def _learn(self, pulls: Sequence[ViewPull]) -> None:
        self._placing.note(pulls, self._time_ns)

    def view_of(self, camera: str) -> Placement | None:
        """Return ``view_from_reference`` of a camera; None of the one whose frame it is."""
        place = self._home_from[camera]
        is_home = camera == self._home and np.allclose(place.translation, 0.0, atol=1e-9)
        return None if is_home else place.inverse()

    @property
    def left_out(self) -> Mapping[str, float]:
        """Cameras that are not where they are said to be, and by how many metres they are off."""
        return self._fuser.left_out

    def join(self, captures: Sequence[Capture]) -> RigFrame:
        """Join what cameras captured about the time of the first of them; a camera that is left out
        adds nothing."""
        time_ns = self._time_ns = captures[0].time_ns
        self._move()
        seen = [CameraPeople(one.camera, one.time_ns, one.people) for one in captures]
        left_out = set(self.left_out)
        people = self._fuser.fuse(seen, time_ns)
        if left_out == set(self.left_out):
            for pulls in self._fuser.pulls:
                self._placing.note_person(pulls, time_ns)
        else:
            # Somebody moved a camera, of which the others' places were learned.
            self._placing.restart()
            self._move()
        shown = [
            (one, one.image)
            for one in captures
            if one.image is not None and one.camera not in self.left_out
        ]
        return RigFrame(time_ns, people, self._image(shown, time_ns))

    def _image(self, shown: Sequence[tuple[Capture, Image]], time_ns: int) -> Image | None:
        """The first camera's image of this very time, with the others beside it."""
        if not shown:
            return None
        own = _nothing(shown[0][1].camera)
        others = []
        for one, image in shown:
            seen, view = replace(image, source=one.camera), self.view_of(one.camera)
            if view is None and one.time_ns == time_ns:
                own = seen
            else:
                later_s = (one.time_ns - time_ns) / 1e9
                covariance = None if view is None else self._placing.covariance(one.camera)
                others.append(OtherView(seen, view or HERE, later_s, covariance))
        return replace(own, others=tuple(others), on_pulls=self._learn)


def _nothing(camera: Intrinsics) -> Image:
    """An image without anything in it."""
    return Image(None, camera)
