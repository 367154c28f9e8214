"""Every number of the evaluation that can be tuned: what counts as close, lost, or found again.

`inhand evaluate DATASET --report DIR` shows the measures that they define.
"""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class EvaluationParameters:
    """The limits of the measures, and how finely an object's surface is compared."""

    close_m: float = 0.05
    """Error of translation in metres below which a pose is close: the field's "5 cm 5°"."""
    close_rad: float = float(np.deg2rad(5.0))
    """Error of rotation in radians below which a pose is close: the field's "5 cm 5°"."""
    add_limit_m: float = 0.10
    """Largest threshold on ADD(-S) in metres, up to which the area under the curve is taken
    (Xiang et al. 2018)."""

    lost_m: float = 0.20
    """Vertex error in metres beyond which a track is lost."""
    found_m: float = 0.10
    """Vertex error in metres below which a lost track is found again: half of ``lost_m``,
    so that noise about one limit does not count as many losses."""
    body_lost_m: float = 0.20
    """Distance in metres of an upper joint from its true place beyond which the body is lost."""

    surface_points: int = 2000
    """Number of points on an object's surface among which the nearest is found: about 3 mm apart on
    a mug."""
    compared_points: int = 200
    """Number of these, the first ones, whose distances are averaged."""
    chunk: int = 1024
    """Number of poses whose surface points are held in memory at once."""
    least_variance_ratio: float = 1e-9
    """Share of the largest variance below which the least one counts as zero: such a covariance
    leaves out a direction, and has no region."""

    part_errors_step: int = 3
    """Number of frames from one that is looked at for the parts' errors to the next."""


DEFAULT_EVALUATION = EvaluationParameters()
