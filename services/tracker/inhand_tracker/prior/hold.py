"""How an object is held or worn: its pose in what turns with it, whatever the body does.

Regressions know where an object is in postures that people were seen in. Of a body that moves as
nobody did in training, or whose joints another sensor puts elsewhere, they know little: a hand that
hangs held nothing there, and the object lay on a table. What carries over is the hold.
"""

from dataclasses import dataclass

import numpy as np

from inhand_tracker.body.anchors import Anchors
from inhand_tracker.body.parameters import DEFAULT_BODY
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.kernels.nearest_rotation import nearest_rotation
from inhand_tracker.prior.kernels import hold as kernels
from inhand_tracker.prior.prediction import Prediction


@dataclass(frozen=True)
class Hold:
    """The object's mean pose in a holder, over all frames in which somebody carries or wears it.

    ``holder`` is its number in ``HOLDERS``; the ``place`` (3,) of the object's centre is in body
    heights. ``covariance`` (6, 6) of (translation, rotation vector on the left) is in the holder's
    axes and body heights.
    """

    holder: int
    place: Array
    rotation: Array
    covariance: Array


def held_in(hold: Hold, anchors: Anchors, height: float) -> Prediction:
    """Predict the object's pose as it is held, for one body's anchors and height."""
    return Prediction(
        *kernels.held(
            anchors.origins,
            anchors.axes,
            hold.holder,
            DEFAULT_BODY.hands_together_m,
            hold.place,
            hold.rotation,
            hold.covariance,
            height,
        )
    )


def rotation_near(matrix: Array) -> Array:
    """Find the rotation (3, 3) that is nearest to a matrix, as to a mean of rotations."""
    rotation = np.empty((3, 3))
    nearest_rotation(np.ascontiguousarray(matrix), rotation)
    return rotation
