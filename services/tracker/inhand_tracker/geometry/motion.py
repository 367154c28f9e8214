"""How a rigid object moves for a moment: evenly."""

from dataclasses import dataclass

from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.placement import Placement


@dataclass(frozen=True)
class Motion:
    """An object that passes ``start`` (3,) with a ``velocity`` (3,), in metres a second, and turns
    about it by ``turning`` (3,), a rotation vector in radians a second."""

    start: Array
    velocity: Array
    turning: Array

    def placement(self, seconds: float) -> Placement:
        """Return the rigid transform of space that takes the object to where it is after a time,
        which may be negative."""
        rotation = rotations.from_vector(seconds * self.turning)
        end = self.start + seconds * self.velocity
        return Placement(end - rotations.rotate(rotation, self.start), rotation)
