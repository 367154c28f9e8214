"""Skeletons of the people in pictures with depth, one picture after the other."""

import numpy as np
from inhand_runtime.errors import InhandError
from inhand_schemas.joints import PARENTS
from inhand_schemas.messages import CameraInfo, JointState, Person
from numpy.typing import NDArray

from inhand_capture.estimation.body_lengths import BodyLengths
from inhand_capture.estimation.found_person import Floats, FoundPerson, PoseNetwork
from inhand_capture.estimation.kernels.depth_choice import TRACKED
from inhand_capture.estimation.lifting import DepthPicture, Lens, Lifted, Lifter, lens_of
from inhand_capture.estimation.limbs import DERIVED, TRUNK_ENDS
from inhand_capture.estimation.parameters import DEFAULT_FOLLOWING, FollowingParameters
from inhand_capture.estimation.people import FollowedPerson, PeopleFollowed

JOINT_STATES: tuple[JointState, ...] = ("missing", "inferred", "tracked")
SHORTEST_S = 1e-3
"""Seconds that two pictures lie apart at the least."""
MOST_PEOPLE = 64
"""Number of people that a message holds at the most."""


class EstimationError(InhandError):
    """A picture from which no skeletons can be estimated; the message says why."""


class SkeletonEstimator:
    """Estimates skeletons of one camera: a network's joints, lifted, followed and smoothed."""

    def __init__(
        self,
        network: PoseNetwork,
        info: CameraInfo,
        parameters: FollowingParameters = DEFAULT_FOLLOWING,
    ) -> None:
        self._network = network
        self._info = info
        self._parameters = parameters
        self._people = PeopleFollowed(parameters)
        self._lifter: Lifter | None = None
        self._size = (0, 0)
        compile_lifting(lens_of(info, info.width, info.height))

    def estimate(
        self, colour: NDArray[np.uint8] | None, depth: NDArray[np.uint16] | None, time_ns: int
    ) -> tuple[Person, ...]:
        """Estimate the people in a picture: colour (H, W, 3) RGB, depth (h, w) of the same view.

        Raises EstimationError where one of them is missing.
        """
        if colour is None or depth is None:
            what = "colour" if colour is None else "depth"
            raise EstimationError(
                f"no skeletons without {what}: the camera gives none; turn its {what} on"
            )
        lifter = self._lifter_for(colour)
        picture = DepthPicture(depth, self._info.depth_scale)
        found = [(one, lifter.read(one, picture)) for one in self._network.find(colour)]
        near = [(one, surfaces) for one, surfaces in found if surfaces is not None]
        matched = self._people.match([surfaces.middle for _, surfaces in near], time_ns)
        people = []
        for (one, surfaces), known in zip(near, matched, strict=True):
            person = known or FollowedPerson(surfaces.middle, time_ns)
            seconds = (time_ns - person.seen_ns) / 1e9
            kept = person.sides.kept(one, seconds)
            if kept is not one:
                surfaces = lifter.read(kept, picture) or surfaces
            lifted = lifter.lift(kept, surfaces, person.body, self._joints_before(person, seconds))
            if lifted is not None:
                number = self._people.see(person, surfaces.middle, lifted, time_ns)
                joints = person.filter.smooth(lifted.joints, max(seconds, SHORTEST_S))
                people.append(person_message(number, joints, lifted, kept.visibilities))
        return tuple(people[:MOST_PEOPLE])

    def _lifter_for(self, colour: NDArray[np.uint8]) -> Lifter:
        height, width = colour.shape[:2]
        if self._lifter is None or self._size != (width, height):
            self._lifter = Lifter(lens_of(self._info, width, height))
            self._size = (width, height)
        return self._lifter

    def _joints_before(self, person: FollowedPerson, seconds: float) -> Floats:
        """Return the network's joints (20, 3) so many seconds before; NaN where that is long."""
        recent = 0.0 < seconds <= self._parameters.remembered_s
        return person.seen if recent else np.full_like(person.seen, np.nan)


def compile_lifting(lens: Lens) -> None:
    """Compile, or load, what the first person would have to wait for: it lifts nobody's joints."""
    spread = np.random.default_rng(0).uniform(0.4, 0.6, size=(20, 2))
    nobody = FoundPerson(spread * [lens.width, lens.height], np.zeros(20), np.ones(20))
    wall = DepthPicture(np.full((lens.height, lens.width), 2000, np.uint16), 0.001)
    lifter = Lifter(lens)
    if (surfaces := lifter.read(nobody, wall)) is not None:
        lifter.lift(nobody, surfaces, BodyLengths(), np.zeros((20, 3)))


def person_message(number: int, joints: Floats, lifted: Lifted, visibilities: Floats) -> Person:
    """Make the message of one person's joints (20, 3) in space."""
    seen = visibilities.copy()
    seen[list(DERIVED)] = visibilities[list(TRUNK_ENDS)].min()
    seen = np.where(seen > 0.0, seen, seen[list(PARENTS)])
    confidences = np.where(lifted.states == TRACKED, seen, 0.5 * seen)
    confidences = np.clip(np.where(lifted.states > 0, confidences, 0.0), 0.0, 1.0)
    return Person(
        id=number,
        joints=tuple((x, y, z) for x, y, z in np.nan_to_num(joints).tolist()),
        states=tuple(JOINT_STATES[state] for state in lifted.states),
        confidences=tuple(confidences.tolist()),
    )
