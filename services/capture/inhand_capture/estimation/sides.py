"""Notices when a network takes a person's left for their right."""

from collections.abc import Sequence

import numpy as np
from inhand_schemas.joints import MIRRORED_JOINTS, Joint
from numpy.typing import NDArray

from inhand_capture.estimation.body_lengths import trunk_length
from inhand_capture.estimation.conventions import forwards
from inhand_capture.estimation.found_person import Floats, FoundPerson
from inhand_capture.estimation.kernels.depth_choice import TRACKED
from inhand_capture.estimation.lifting import Lifted
from inhand_capture.estimation.limbs import LIMBS
from inhand_capture.estimation.parameters import (
    DEFAULT_FOLLOWING,
    DEFAULT_LIFTING,
    FollowingParameters,
)

_MIRRORED = np.array(MIRRORED_JOINTS)
_LEFTS = [Joint.SHOULDER_LEFT, Joint.HIP_LEFT]
_RIGHTS = [Joint.SHOULDER_RIGHT, Joint.HIP_RIGHT]
_ANKLES = np.array([Joint.ANKLE_LEFT, Joint.ANKLE_RIGHT])
_FEET = np.array([Joint.FOOT_LEFT, Joint.FOOT_RIGHT])
_ARMS, _LEGS = (np.concatenate([LIMBS[side], LIMBS[2 + side]]) for side in (0, 1))


def mirrored_parts(parts: Sequence[NDArray[np.int64]]) -> NDArray[np.int64]:
    """Return the order (20,) of joints in which those of these parts are exchanged."""
    order = np.arange(len(Joint))
    for part in parts:
        order[part] = _MIRRORED[part]
    return order


class Sides:
    """Keeps one person's sides from frame to frame.

    Nobody turns round between two frames: arms, or legs, whose left lies where their right has lain
    are exchanged back. Toes point forwards: where depth shows that they point backwards, left is
    right. While no toes are seen, a network that goes on about it is believed in the end.
    """

    def __init__(self, parameters: FollowingParameters = DEFAULT_FOLLOWING) -> None:
        self._parameters = parameters
        self._across: Floats | None = None
        """Means of vectors (2, 3) from right to left, of shoulders and of hips, metres."""
        self._exchanged_s = np.zeros(2)
        """Seconds for which arms, and legs, have been exchanged."""
        self._toes_m = 0.0
        """How far toes lie before ankles, as of late: 0 while no toes are seen."""

    def kept(self, person: FoundPerson, seconds: float) -> FoundPerson:
        """Return the person with their sides as they were so many seconds before."""
        across, parameters = across_of(person), self._parameters
        if self._across is None:
            self._across = across
            return person
        wrong = (across * self._across).sum(axis=1) < -(parameters.across_m**2)
        self._exchanged_s = np.where(wrong, self._exchanged_s + seconds, 0.0)
        if self._toes_m < parameters.toes_m:
            believed = self._exchanged_s > parameters.longest_exchange_s
            self._across[believed], wrong[believed] = across[believed], False
            self._exchanged_s[believed] = 0.0
        across[wrong] *= -1.0
        # Without depths somebody who turns has no width on the way, and a mean would lag behind.
        flat = np.isnan(person.depths[_LEFTS] - person.depths[_RIGHTS])
        share = np.where(flat, 1.0, min(seconds / parameters.across_s, 1.0))
        self._across += share[:, None] * (across - self._across)
        parts = [part for part, is_wrong in zip((_ARMS, _LEGS), wrong, strict=True) if is_wrong]
        return _in_order(person, mirrored_parts(parts)) if parts else person

    def exchanged(self, person: FoundPerson) -> FoundPerson:
        """Return the person with left and right exchanged, as they are from now on."""
        if self._across is not None:
            self._across = -self._across
        return _in_order(person, _MIRRORED)

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


def across_of(person: FoundPerson) -> Floats:
    """Return vectors (2, 3) from right to left, of shoulders and of hips, in metres.

    Depths count where the network says any, and pixels by the length of the trunk.
    """
    metre = max(trunk_length(person.pixels), 1.0) / DEFAULT_LIFTING.usual_trunk_m
    places = np.column_stack([person.pixels / metre, np.nan_to_num(person.depths)])
    across: Floats = places[_LEFTS] - places[_RIGHTS]
    return across


def _in_order(person: FoundPerson, order: NDArray[np.int64]) -> FoundPerson:
    """Return a person whose joints stand in another order."""
    return FoundPerson(person.pixels[order], person.depths[order], person.visibilities[order])
