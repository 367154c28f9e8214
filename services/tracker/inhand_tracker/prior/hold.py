"""How an object is held or worn: its pose in what holds it, whatever the body does.

Regressions know where an object is in postures that people were seen in. Of a body that moves as
nobody did in training, or whose joints another sensor puts elsewhere, they know little: a hand that
hangs held nothing there, and the object lay on a table. What carries over is the hold.
"""

from dataclasses import dataclass

import numpy as np

from inhand_tracker.body.anchors import Anchors
from inhand_tracker.body.holders import find_holder
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.kernels.nearest_rotation import nearest_rotation
from inhand_tracker.prior.kernels import hold as kernels
from inhand_tracker.prior.prediction import Prediction


@dataclass(frozen=True)
class Hold:
    """How somebody carries or wears the object, in the mean over all frames of all people.

    ``holder`` is its number in ``HOLDERS``. ``rotation`` (3, 3) is the object's in the holder's
    axes, and ``grip`` (3,) where the holder is in the object's, from its centre, in metres. Where
    both hands hold it, the object turns towards the other one: ``pull`` (3,) is where that is in
    the object's axes from the holder, times how much surer that is than the rotation, in 1/m; 0
    where one hand holds. ``covariance`` (6, 6) of (translation, rotation vector on the left) is in
    the object's axes, in metres and radians. ``leanings`` (L, 2) say how far the truth lies from
    the regressions towards the hold at each landmark of the prior, of people who were held out:
    the product, in the mean over vertices, of the ways from there to both, and the square of that
    to the hold, in m².
    """

    holder: int
    rotation: Array
    grip: Array
    pull: Array
    covariance: Array
    leanings: Array

    def of(self, anchors: Anchors, growth: float = 1.0) -> Prediction:
        """Predict the object's pose as it is held, for one body's anchors, or poses for many; the
        covariance is ``growth`` times the hold's."""
        return Prediction(
            *kernels.held(
                *find_holder(anchors, self.holder),
                self.rotation,
                self.grip,
                self.pull,
                self.covariance,
                growth,
            )
        )


def rotation_near(matrix: Array) -> Array:
    """Find the rotation (3, 3) that is nearest to a matrix, as to a mean of rotations."""
    rotation = np.empty((3, 3))
    nearest_rotation(np.ascontiguousarray(matrix), rotation)
    return rotation
