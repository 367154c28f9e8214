"""How far estimated joints are from the true ones, summed up."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from inhand_schemas.joints import JOINT_NAMES
from inhand_tracker.geometry.arrays import Array


@dataclass(frozen=True)
class JointDistances:
    """Distances of joints that were found, centimetres, and shares of them that are off by more
    than 10 and 20 cm; ``missing`` is the share that was not found."""

    joints: int
    median_cm: float
    mean_cm: float
    p90_cm: float
    over_10_cm: float
    over_20_cm: float
    missing: float


def summed_up(distances: Array) -> JointDistances:
    """Sum up distances of any shape in metres, NaN where a joint is missing."""
    measured = 100.0 * distances[np.isfinite(distances)]
    if not len(measured):
        nothing = float("nan")
        return JointDistances(
            distances.size, nothing, nothing, nothing, nothing, nothing, missing=1.0
        )
    return JointDistances(
        joints=distances.size,
        median_cm=float(np.median(measured)),
        mean_cm=float(measured.mean()),
        p90_cm=float(np.quantile(measured, 0.9)),
        over_10_cm=float((measured > 10.0).mean()),
        over_20_cm=float((measured > 20.0).mean()),
        missing=1.0 - len(measured) / distances.size,
    )


def by_joint(distances: Sequence[Array]) -> dict[str, JointDistances]:
    """Sum up distances (20,) of many frames, joint by joint."""
    columns = np.array(distances).T
    return {name: summed_up(column) for name, column in zip(JOINT_NAMES, columns, strict=True)}
