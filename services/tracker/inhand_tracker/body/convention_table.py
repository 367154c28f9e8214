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
            *(0.0418, 0.0931, -0.0045, 0.3152, 0.2973, 0.1083),
            *(0.0520, 0.1151, 0.1534, 0.0405, 0.2585, 0.0494),
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
            *(0.0432, 0.0926, 0.0000, 0.3303, 0.3088, 0.1081),
            *(0.0528, 0.1159, 0.1507, 0.0465, 0.2542, 0.1127),
        )
    ),
}
"""Measures of conventions, by name."""
PEOPLE_DIFFER = np.array(
    (
        *(0.0020, 0.0029, 0.0036, 0.0067, 0.0068, 0.0049),
        *(0.0020, 0.0068, 0.0065, 0.0055, 0.0106, 0.0023),
    )
)
"""Deviations of people of one convention: root mean squares of those of the first two rows and of
six more simulated people, of seed 172."""


def shared_convention(names: Iterable[str | None]) -> str | None:
    """Name the convention that all have; None where one is not said, or they differ."""
    different = set(names)
    return different.pop() if len(different) == 1 else None
