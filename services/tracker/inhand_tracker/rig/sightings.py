"""A person as one camera sees them, in the frame of reference of the rig's people."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from inhand_schemas.joints import MIRRORED_JOINTS
from inhand_schemas.messages import Person

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.placement import Placement
from inhand_tracker.rig.parameters import RigParameters
from inhand_tracker.wire.conversion import joints_of

MIRRORED = np.array(MIRRORED_JOINTS)
"""The same joint on the body's other side (20,)."""
_STATES = {"missing": 0, "inferred": 1, "tracked": 2}
STATES = tuple(_STATES)


@dataclass(frozen=True)
class CameraPeople:
    """The people in one frame of a camera, whose time is by the clock of the rig."""

    camera: str
    time_ns: int
    people: Sequence[Person]


@dataclass(frozen=True)
class Sighting:
    """A person in one camera's frame: ``joints`` (20, 3) in the rig's frame of reference, missing
    ones NaN; their ``deviations`` (20,) across the lines of sight ``rays`` (20, 3), in metres; and
    what the camera says of them, ``states`` (20,) as indices of ``STATES`` and ``confidences``
    (20,)."""

    camera: str
    camera_id: int
    time_ns: int
    joints: Array
    deviations: Array
    rays: Array
    states: Array
    confidences: Array

    def exchanged(self) -> "Sighting":
        """Return the sighting with left and right exchanged."""
        return replace(
            self,
            joints=self.joints[MIRRORED],
            deviations=self.deviations[MIRRORED],
            rays=self.rays[MIRRORED],
            states=self.states[MIRRORED],
            confidences=self.confidences[MIRRORED],
        )


def sightings_of(
    seen: CameraPeople, places: Mapping[str, Placement], parameters: RigParameters
) -> list[Sighting]:
    """Return the people of a camera's frame of whom any joint is seen; ``places`` are
    ``rig_from_camera`` by camera."""
    place = places[seen.camera]
    sightings = []
    for person in seen.people:
        joints = place.points(joints_of(person))
        if not np.isfinite(joints).any():
            continue
        states = np.array([_STATES[state] for state in person.states])
        confidences = np.array(person.confidences)
        ways = joints - place.translation
        sightings.append(
            Sighting(
                seen.camera,
                person.id,
                seen.time_ns,
                joints,
                _deviations(states, confidences, parameters),
                ways / np.maximum(np.linalg.norm(ways, axis=1, keepdims=True), 1e-6),
                states,
                confidences,
            )
        )
    return sightings


def _deviations(states: Array, confidences: Array, parameters: RigParameters) -> Array:
    """Standard deviations (20,), in metres, of joints as sure as that."""
    unsure = 1.0 + (parameters.unsure_factor - 1.0) * (1.0 - confidences)
    inferred = np.where(states == _STATES["inferred"], parameters.inferred_factor, 1.0)
    return np.asarray(parameters.tracked_m * unsure * inferred)
