"""What is known of an object beside where it is: its mesh, its use, and where its parts are."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from inhand_outcomes.arrays import Array, Indices

END_SHARE = 0.05
"""Share of the extent along an axis that counts as the end of an object."""
AXES = {"x": 0, "y": 1, "z": 2}


@dataclass(frozen=True, eq=False)
class Thing:
    """An object whose use is measured.

    ``vertices`` (V, 3) and ``faces`` (F, 3) are its mesh in metres in its own frame, in which
    things stand along z (``docs/teach.md``). ``parts`` are points (3,) of it by name, as the
    settings say them; ``part`` finds the others in the mesh.
    """

    name: str
    use: str
    vertices: Array
    faces: Indices
    parts: Mapping[str, Array] = field(default_factory=dict)

    def part(self, name: str, usual: str) -> Array:
        """Return the point (3,) of a part: as it was said, or else the middle of the ``usual`` end
        of the mesh, ``+z``, ``-y`` and so on."""
        if name in self.parts:
            return self.parts[name]
        return end_of(self.vertices, usual)


def end_of(vertices: Array, end: str) -> Array:
    """Return the middle (3,) of what lies at an end, ``+z`` and so on, of vertices (V, 3)."""
    sign, axis = (1.0 if end[0] == "+" else -1.0), AXES[end[1]]
    along = sign * vertices[:, axis]
    there = vertices[along >= along.max() - END_SHARE * np.ptp(along)]
    return 0.5 * (there.min(axis=0) + there.max(axis=0))
