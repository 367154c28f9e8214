"""Notices when a network takes a person's left for their right."""

import numpy as np
from inhand_schemas.joints import MIRRORED_JOINTS, Joint

from inhand_capture.estimation.found_person import Floats, FoundPerson
from inhand_capture.estimation.parameters import DEFAULT_FOLLOWING, FollowingParameters

_MIRRORED = np.array(MIRRORED_JOINTS)
_SIDED = np.flatnonzero(np.arange(len(Joint)) != _MIRRORED)


class Sides:
    """Keeps one person's sides from frame to frame.

    Nobody turns round between two frames: joints that lie much nearer to where they were with left
    and right exchanged are exchanged back. A network that goes on about it is believed in the end.
    """

    def __init__(self, parameters: FollowingParameters = DEFAULT_FOLLOWING) -> None:
        self._parameters = parameters
        self._before: Floats | None = None
        self._exchanged_s = 0.0

    def kept(self, person: FoundPerson, seconds: float) -> FoundPerson:
        """Return the person with their sides as they were so many seconds before."""
        before, self._before = self._before, person.pixels
        if before is None or not self._are_exchanged(person.pixels, before):
            self._exchanged_s = 0.0
            return person
        self._exchanged_s += seconds
        if self._exchanged_s > self._parameters.longest_exchange_s:
            self._exchanged_s = 0.0
            return person
        self._before = person.pixels[_MIRRORED]
        return FoundPerson(
            person.pixels[_MIRRORED], person.depths[_MIRRORED], person.visibilities[_MIRRORED]
        )

    def _are_exchanged(self, pixels: Floats, before: Floats) -> bool:
        as_is = np.linalg.norm(pixels - before, axis=1)[_SIDED]
        exchanged = np.linalg.norm(pixels[_MIRRORED] - before, axis=1)[_SIDED]
        known = np.isfinite(as_is)
        limit = self._parameters.exchanged_below * as_is[known].sum()
        return bool(exchanged[known].sum() < limit)
