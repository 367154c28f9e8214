"""Notices when a network takes a person's left for their right."""

import numpy as np
from inhand_schemas.joints import MIRRORED_JOINTS, Joint

from inhand_capture.estimation.conventions import forwards
from inhand_capture.estimation.found_person import Floats, FoundPerson
from inhand_capture.estimation.kernels.depth_choice import TRACKED
from inhand_capture.estimation.lifting import Lifted
from inhand_capture.estimation.parameters import DEFAULT_FOLLOWING, FollowingParameters

_MIRRORED = np.array(MIRRORED_JOINTS)
_SIDED = np.flatnonzero(np.arange(len(Joint)) != _MIRRORED)
_ANKLES = np.array([Joint.ANKLE_LEFT, Joint.ANKLE_RIGHT])
_FEET = np.array([Joint.FOOT_LEFT, Joint.FOOT_RIGHT])


class Sides:
    """Keeps one person's sides from frame to frame.

    Nobody turns round between two frames: joints that lie much nearer to where they were with left
    and right exchanged are exchanged back. Toes point forwards: where depth shows that they point
    backwards, left is right. While no toes are seen, a network that goes on about it is believed in
    the end.
    """

    def __init__(self, parameters: FollowingParameters = DEFAULT_FOLLOWING) -> None:
        self._parameters = parameters
        self._before: Floats | None = None
        self._exchanged_s = 0.0
        self._toes_m = 0.0
        """How far toes lie before ankles, as of late: 0 while no toes are seen."""

    def kept(self, person: FoundPerson, seconds: float) -> FoundPerson:
        """Return the person with their sides as they were so many seconds before."""
        before, self._before = self._before, person.pixels
        if before is None or not self._are_exchanged(person.pixels, before):
            self._exchanged_s = 0.0
            return person
        self._exchanged_s += seconds
        toes_say_nothing = self._toes_m < self._parameters.toes_m
        if self._exchanged_s > self._parameters.longest_exchange_s and toes_say_nothing:
            self._exchanged_s = 0.0
            return person
        return self.exchanged(person)

    def exchanged(self, person: FoundPerson) -> FoundPerson:
        """Return the person with left and right exchanged, as they are from now on."""
        other = FoundPerson(
            person.pixels[_MIRRORED], person.depths[_MIRRORED], person.visibilities[_MIRRORED]
        )
        self._before = other.pixels
        return other

    def are_wrong(self, lifted: Lifted, seconds: float) -> bool:
        """Whether, by this frame too, the person's toes point backwards."""
        tracked = (lifted.states[_FEET] == TRACKED) & (lifted.states[_ANKLES] == TRACKED)
        share = 1.0 if not self._toes_m else min(seconds / self._parameters.toes_s, 1.0)
        toes_m = 0.0
        if tracked.any():
            along = (lifted.seen[_FEET] - lifted.seen[_ANKLES]) @ forwards(lifted.seen)
            toes_m = float(along[tracked].mean())
        self._toes_m += share * (toes_m - self._toes_m)
        if self._toes_m > -self._parameters.toes_m:
            return False
        self._toes_m = -self._toes_m
        return True

    def _are_exchanged(self, pixels: Floats, before: Floats) -> bool:
        as_is = np.linalg.norm(pixels - before, axis=1)[_SIDED]
        exchanged = np.linalg.norm(pixels[_MIRRORED] - before, axis=1)[_SIDED]
        known = np.isfinite(as_is)
        limit = self._parameters.exchanged_below * as_is[known].sum()
        return bool(exchanged[known].sum() < limit)
