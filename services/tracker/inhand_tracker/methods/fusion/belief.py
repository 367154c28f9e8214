"""What is believed of a pose before an image is seen: the body's part, and what is carried over.

The prior (``prior``) errs by habits: how this person holds this mug is not to be seen in a body,
but it stays as it is. So what is tracked is how the pose differs from the prior's, in the object's
own frame: what an image showed of it fades away, as learned, while the object is hidden. And an
object that was left somewhere stays there, whatever the body does.
"""

from dataclasses import dataclass, replace

import numpy as np

from inhand_tracker.body.anchors import find_anchors
from inhand_tracker.body.reader import Body
from inhand_tracker.body.skeleton import mirror_pose
from inhand_tracker.body.window import BodyWindow
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.pose_gaussian import PoseGaussian, PoseMixture, mixture
from inhand_tracker.prior.prior import Prior, predict

CARRIED, AFRESH, LEFT = 0.6, 0.2, 0.2
"""How likely the difference stays, is another one, or the object stays where it is."""
DOUBT = 4.0
"""By how much the prior's covariance is stretched where it speaks against what was believed."""
LEFT_DEVIATIONS = np.array([0.01, 0.01, 0.01, 0.05, 0.05, 0.05])
"""By how much an object that was left, or the camera, moves from frame to frame."""
FORGETTING_S = 0.3
"""How long what was seen makes sure of a pose: one frame errs as the next does."""


@dataclass(frozen=True)
class BodyExpectation:
    """The prior of one object for people of one handedness."""

    prior: Prior
    mirror_normal: Array
    left_handed: bool

    @property
    def centre(self) -> Array:
        """Of the object (3,), in its frame."""
        centre, normal = self.prior.centre, self.mirror_normal
        return centre - 2.0 * (centre @ normal) * normal if self.left_handed else centre

    def expect(self, body: Body, window: BodyWindow, time_ns: int) -> PoseGaussian:
        """What the body alone makes one expect; the window takes the frame."""
        descriptions = window.add(body.joints, time_ns, body.height)
        predicted = predict(self.prior, descriptions, find_anchors(body.joints), body.height)
        centre, covariance = predicted.centre, predicted.covariance
        rotation = rotations.from_matrix(predicted.rotation)
        if self.left_handed:
            # A rotation vector is mirrored as an axis is: what x keeps of it, y and z turn round.
            signs = np.array([-1.0, 1.0, 1.0, 1.0, -1.0, -1.0])
            origin = centre - rotations.rotate(rotation, self.prior.centre)
            origin, rotation = mirror_pose(origin, rotation, self.mirror_normal)
            centre = origin + rotations.rotate(rotation, self.centre)
            covariance = covariance * signs[:, None] * signs
        return PoseGaussian(centre, rotation, covariance)


@dataclass(frozen=True)
class Belief:
    """At the end of a frame: what the body alone made one expect, and what was believed."""

    expected: PoseGaussian
    believed: PoseGaussian
    time_ns: int


def carry_over(
    before: Belief, expected: PoseGaussian, time_ns: int, persistence_s: float, *, leaves: bool
) -> PoseMixture:
    """What is expected now, after what was believed before; first, that the difference stays.

    ``leaves`` tells whether the object may have been left somewhere.
    """
    elapsed_s = (time_ns - before.time_ns) / 1e9
    believed = before.believed
    kept = float(np.exp(-elapsed_s / persistence_s))
    inverse = rotations.conjugate(before.expected.rotation)
    moved = rotations.rotate(inverse, believed.centre - before.expected.centre)
    turned = rotations.to_vector(rotations.multiply(inverse, believed.rotation))
    rotation = rotations.multiply(expected.rotation, rotations.from_vector(kept * turned))
    turn = rotations.multiply(rotation, rotations.conjugate(believed.rotation))
    axes = np.kron(np.eye(2), rotations.to_matrix(turn))
    sure = float(np.exp(-elapsed_s / FORGETTING_S))
    carried = PoseGaussian(
        expected.centre + rotations.rotate(expected.rotation, kept * moved),
        rotation,
        sure**2 * axes @ believed.covariance @ axes.T + (1.0 - sure**2) * expected.covariance,
    )
    left = replace(believed, covariance=believed.covariance + np.diag(np.square(LEFT_DEVIATIONS)))
    parts = (carried, expected, left) if leaves else (carried, expected)
    off = np.array([expected.square_distance(part) for part in parts])
    return mixture(parts, np.log([CARRIED, AFRESH, LEFT])[: len(parts)] - 0.5 * off / DOUBT)
