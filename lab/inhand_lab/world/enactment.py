"""What somebody does with an object in the person's world, and its mirror image."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Bytes

from inhand_lab.geometry.transforms import Transform
from inhand_lab.motions.furniture import Furniture
from inhand_lab.motions.performance import ContactKind
from inhand_lab.motions.timeline import Stage
from inhand_lab.people.body_motion import BodyMotion

MIRRORED_CONTACT = np.array(
    [
        ContactKind.RESTING,
        ContactKind.LEFT_HAND,
        ContactKind.RIGHT_HAND,
        ContactKind.BOTH_HANDS,
        ContactKind.WORN,
    ],
    np.uint8,
)
"""ContactKind of the mirror image, by the contact's number."""


@dataclass(frozen=True)
class Enactment:
    """Body and object over T frames; ``contact`` (T,) holds values of ContactKind.

    ``stages`` are what is done when, in seconds from the first frame of the performance.
    """

    body: BodyMotion
    world_from_object: Transform
    contact: Bytes
    furniture: Furniture = ()
    stages: Sequence[Stage] = ()

    def mirrored(self) -> Enactment:
        """The same by a left-handed person."""
        return Enactment(
            self.body.mirrored(),
            self.world_from_object.mirrored(),
            MIRRORED_CONTACT[self.contact],
            tuple(box.mirrored() for box in self.furniture),
            self.stages,
        )

    def __getitem__(self, frames: slice) -> Enactment:
        return Enactment(
            self.body[frames],
            self.world_from_object[frames],
            self.contact[frames],
            self.furniture,
            self.stages,
        )
