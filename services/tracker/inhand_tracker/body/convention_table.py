"""Conventions of skeletons as a table: where joints lie in people who stand, in body heights.

Each row is written by ``python tests/scenes/skeleton_conventions.py DATASET``, which says of what.
"""

from collections.abc import Iterable

import numpy as np
from inhand_schemas import conventions

from inhand_tracker.geometry.arrays import Array

CANONICAL = conventions.SIMULATED
"""Name of the convention that all others are mapped to in training."""

MEASURES = (
    "HipCenter up",
    "Spine up",
    "Spine ahead",
    "ShoulderCenter up",
    "shoulders up",
    "shoulders aside",
    "hips aside",
    "neck",
    "forearm",
    "hand",
    "thigh",
    "foot",
)
"""What is measured, in its order: places from the middle of the hips, up towards the middle of the
shoulders, and lengths from joint to joint."""
STAY = [MEASURES.index(name) for name in ("shoulders up", "shoulders aside", "hips aside")]
"""Measures that tell conventions from each other, and by which no joint is moved."""
OF_THE_TRUNK = 7
"""Number of measures, the first ones, that nobody shows but who stands with arms down."""

TABLE: dict[str | None, Array] = {
    # `inhand simulate DATASET --seed 171 --participants 6 --frames 150 --interactions liftWeights
    # hammerNail paintWall hitTennisBall hitGolfBall`
    conventions.SIMULATED: np.array(
        (
            *(0.0416, 0.0936, -0.0047, 0.3163, 0.2932, 0.1079),
            *(0.0518, 0.1145, 0.1536, 0.0420, 0.2584, 0.0496),
        )
    ),
    # `inhand import utd-mhad`, participants s1 s3 s5 s7: the others' mean is within 0.004.
    conventions.KINECT_V1: np.array(
        (
            *(0.0468, 0.0887, -0.0229, 0.3024, 0.2328, 0.1038),
            *(0.0466, 0.1185, 0.1460, 0.0397, 0.2889, 0.0492),
        )
    ),
    # `inhand recording skeletons --replace` of pictures of simulated people, seed 172 and otherwise
    # as above: participant p00.
    conventions.BLAZEPOSE: np.array(
        (
            *(0.0427, 0.0915, -0.0000, 0.3265, 0.3051, 0.1127),
            *(0.0579, 0.1156, 0.1537, 0.0459, 0.2536, 0.1032),
        )
    ),
}
"""Measures of conventions, by name."""
PEOPLE_DIFFER = np.array(
    (
        *(0.0020, 0.0013, 0.0042, 0.0091, 0.0055, 0.0049),
        *(0.0020, 0.0053, 0.0069, 0.0066, 0.0125, 0.0025),
    )
)
"""Deviations of people of one convention: root mean squares over the people of the first two."""


def shared_convention(names: Iterable[str | None]) -> str | None:
    """Name the convention that all have; None where one is not said, or they differ."""
    different = set(names)
    return different.pop() if len(different) == 1 else None
