"""Skeletons of the people in pictures with depth, one picture after the other."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from inhand_runtime.errors import InhandError
from inhand_runtime.pinhole import Pinhole
from inhand_schemas.fields import MOST_PEOPLE, JointState
from inhand_schemas.joints import PARENTS
from inhand_schemas.messages import CameraInfo, Person
from numpy.typing import NDArray

from inhand_capture.estimation.body_lengths import BodyLengths
from inhand_capture.estimation.found_person import Floats, FoundPerson, PoseNetwork
from inhand_capture.estimation.kernels.depth_choice import TRACKED
from inhand_capture.estimation.lifting import DepthPicture, Lifted, Lifter, Surfaces, lens_of
from inhand_capture.estimation.limbs import DERIVED, HANDS_AND_FEET, TRUNK_ENDS
from inhand_capture.estimation.parameters import DEFAULT_FOLLOWING
from inhand_capture.estimation.people import FollowedPerson, PeopleFollowed

JOINT_STATES: tuple[JointState, ...] = ("missing", "inferred", "tracked")
SHORTEST_S = 1e-3
"""Seconds that two pictures lie apart at the least."""


class EstimationError(InhandError):
    """A picture from which no skeletons can be estimated; the message says why."""


class SkeletonEstimator:
    """Estimates skeletons of one camera: a network's joints, lifted, followed and smoothed."""

    def __init__(self, network: PoseNetwork, info: CameraInfo) -> None:
        self._network = network
        self._info = info
        self._people = PeopleFollowed()
        self._lifter = Lifter(lens_of(info, info.width, info.height))
        self._size = (info.width, info.height)
        compile_lifting(lens_of(info, info.width, info.height))

    def estimate(
        self,
        colour: NDArray[np.uint8] | None,
        depth: NDArray[np.uint16] | None,
        time_ns: int,
        people_found: Sequence[FoundPerson] | None = None,
    ) -> tuple[Person, ...]:
        """Estimate the people in a picture: colour (H, W, 3) RGB, depth (h, w) of the same view.

        ``people_found`` are those whom the network found in it, if it was asked already. Raises
        EstimationError where colour or depth is missing.
        """
        if colour is None or depth is None:
            what = "colour" if colour is None else "depth"
            raise EstimationError(
                f"no skeletons without {what}: the camera gives none; turn its {what} on"
            )
        lifter = self._lifter_for(colour)
        # Of what cannot be written, or has gaps, the compiled code would have to be compiled again.
        picture = DepthPicture(np.require(depth, np.uint16, ["C", "W"]), self._info.depth_scale)
        if people_found is None:
            people_found = self._network.find(colour)
        found = [(one, lifter.read(one, picture)) for one in people_found]
        near = [_Seen(one, surfaces, picture) for one, surfaces in found if surfaces is not None]
        matched = self._people.match([seen.surfaces.middle for seen in near], time_ns)
        people = [
            self._follow(seen, known or FollowedPerson(seen.surfaces.middle, time_ns), time_ns)
            for seen, known in zip(near, matched, strict=True)
        ]
        return tuple(person for person in people if person is not None)[:MOST_PEOPLE]

    def _follow(self, seen: "_Seen", person: FollowedPerson, time_ns: int) -> Person | None:
        """Lift somebody by what is remembered of them; None for what is no person."""
        seconds = (time_ns - person.seen_ns) / 1e9
        kept = person.sides.kept(seen.person, seconds)
        lifted = self._lift(seen, kept, person, _joints_before(person, seconds))
        if lifted is not None and person.sides.are_wrong(lifted, seconds):
            kept = person.sides.exchanged(kept)
            lifted = self._lift(seen, kept, person, np.full_like(person.seen, np.nan))
        if lifted is None:
            return None
        number = self._people.see(person, seen.surfaces.middle, lifted, time_ns)
        joints = person.filter.smooth(lifted.joints, max(seconds, SHORTEST_S))
        return person_message(number, joints, lifted, kept.visibilities)

    def _lift(
        self, seen: "_Seen", kept: FoundPerson, person: FollowedPerson, before: Floats
    ) -> Lifted | None:
        """Lift somebody whose sides may be other than the network said."""
        surfaces = seen.surfaces
        if kept is not seen.person:
            surfaces = self._lifter.read(kept, seen.picture) or surfaces
        return self._lifter.lift(kept, surfaces, person.body, before)

    def _lifter_for(self, colour: NDArray[np.uint8]) -> Lifter:
        height, width = colour.shape[:2]
        if self._size != (width, height):
            self._lifter = Lifter(lens_of(self._info, width, height))
            self._size = (width, height)
        return self._lifter


@dataclass(frozen=True)
class _Seen:
    """Somebody whom the network found, and what lies about their joints in the depth."""

    person: FoundPerson
    surfaces: Surfaces
    picture: DepthPicture


def _joints_before(person: FollowedPerson, seconds: float) -> Floats:
    """Return the network's joints (20, 3) so many seconds before; NaN where that is long."""
    recent = 0.0 < seconds <= DEFAULT_FOLLOWING.remembered_s
    return person.seen if recent else np.full_like(person.seen, np.nan)


def compile_lifting(lens: Pinhole) -> None:
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
    for joint in HANDS_AND_FEET:
        seen[joint] = seen[joint] or seen[PARENTS[joint]]  # as sure as what it is derived from
    confidences = np.where(lifted.states == TRACKED, seen, 0.5 * seen)
    confidences = np.clip(np.where(lifted.states > 0, confidences, 0.0), 0.0, 1.0)
    return Person(
        id=number,
        joints=tuple((x, y, z) for x, y, z in np.nan_to_num(joints).tolist()),
        states=tuple(JOINT_STATES[state] for state in lifted.states),
        confidences=tuple(confidences.tolist()),
    )
