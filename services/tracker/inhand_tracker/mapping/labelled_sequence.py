"""What is learned from: one recording of one person, with the object's pose in every frame."""

from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np

from inhand_tracker.body.skeleton import mirror_joints, mirror_pose, part_lengths, typical_lengths
from inhand_tracker.body.stand_ins import put_stand_ins, seen_stature
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array


@dataclass(frozen=True)
class LabelledSequence:
    """One recording of one person with the object's pose in every frame, in the camera frame.

    ``joints`` (N, 20, 3), ``translations`` (N, 3), ``rotations`` (N, 4). Frames that are not
    usable (a missing joint or label) hold NaN and are left out, with the step into them.
    ``frame_rate`` is in Hz; ``convention`` names whose joints these are, None where that is not
    said. Stretches of one recording have its name as their ``recording``; one without a name is a
    recording by itself. ``own`` are the user's, by which what was learned of others is adapted.
    """

    participant: str
    left_handed: bool
    joints: Array
    translations: Array
    rotations: Array
    frame_rate: float = 30.0
    convention: str | None = None
    recording: str = ""
    own: bool = False

    def right_handed(self, mirror_normal: Array) -> "LabelledSequence":
        """The sequence with unit quaternions, and mirrored where the person is left-handed.

        ``mirror_normal`` (3,) is the object's.
        """
        with np.errstate(invalid="ignore", divide="ignore"):
            unit = replace(self, rotations=rotations.normalise(self.rotations))
        if not self.left_handed:
            return unit
        translations, turns = mirror_pose(unit.translations, unit.rotations, mirror_normal)
        return replace(
            unit,
            left_handed=False,
            joints=mirror_joints(self.joints),
            translations=translations,
            rotations=turns,
        )

    def with_stand_ins(self, absent: Collection[int]) -> "LabelledSequence":
        """Return the sequence with stand-ins for absent joints."""
        if not absent:
            return self
        height = seen_stature(typical_lengths(part_lengths(self.joints)), absent)
        return replace(self, joints=put_stand_ins(self.joints, absent, height))

    def cut(self, first: int, end: int) -> "LabelledSequence":
        """Return the frames from ``first`` up to, and without, ``end``."""
        return replace(
            self,
            joints=self.joints[first:end],
            translations=self.translations[first:end],
            rotations=self.rotations[first:end],
        )
