"""The movement of one body: its joints, and the frames of its parts that no skeleton shows."""

from __future__ import annotations

from dataclasses import dataclass

from inhand_tracker.body.skeleton import mirror_joints
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import Transform


@dataclass(frozen=True)
class BodyMotion:
    """A body over T frames: joints (T, 20, 3) and the frames a skeleton does not show."""

    joints: Array
    from_pelvis: Transform
    from_chest: Transform
    from_head: Transform
    from_right_hand: Transform
    from_left_hand: Transform

    def mirrored(self) -> BodyMotion:
        """The same movement by the other hand."""
        return BodyMotion(
            mirror_joints(self.joints),
            self.from_pelvis.mirrored(),
            self.from_chest.mirrored(),
            self.from_head.mirrored(),
            self.from_left_hand.mirrored(),
            self.from_right_hand.mirrored(),
        )

    def __getitem__(self, frames: slice) -> BodyMotion:
        return BodyMotion(
            self.joints[frames],
            self.from_pelvis[frames],
            self.from_chest[frames],
            self.from_head[frames],
            self.from_right_hand[frames],
            self.from_left_hand[frames],
        )

    def seen_from(self, viewer_from_world: Transform) -> BodyMotion:
        """The same body in another frame of reference."""
        return BodyMotion(
            viewer_from_world.apply(self.joints),
            viewer_from_world @ self.from_pelvis,
            viewer_from_world @ self.from_chest,
            viewer_from_world @ self.from_head,
            viewer_from_world @ self.from_right_hand,
            viewer_from_world @ self.from_left_hand,
        )
