"""What is believed of a pose before an image is seen: the body's part, and what is carried over.

The prior (``prior``) errs by habits: how this person holds this mug is not to be seen in a body,
but it stays as it is. So what is tracked is how the pose differs from the prior's, in the object's
own frame: what an image showed of it fades away, as learned, while the object is hidden. And an
object that was left somewhere stays there, whatever the body does.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from inhand_tracker.body.anchors import ANCHORS, find_anchors
from inhand_tracker.body.reader import Body
from inhand_tracker.body.skeleton import mirror_pose
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array, Singles
from inhand_tracker.geometry.pose_gaussian import (
    PoseGaussian,
    PoseMixture,
    mixture,
    turn_blocks,
)
from inhand_tracker.methods.fusion.parameters import FusionParameters
from inhand_tracker.prior.parameters import DEFAULT_PRIOR, PriorParameters
from inhand_tracker.prior.prediction import Prediction
from inhand_tracker.prior.prior import Prior, predict, predict_apart


@dataclass(frozen=True)
class BodyExpectation:
    """The prior of one object for people of one handedness."""

    prior: Prior
    mirror_normal: Array
    left_handed: bool
    parameters: PriorParameters = DEFAULT_PRIOR

    @property
    def centre(self) -> Array:
        """The object's centre (3,), in its frame."""
        centre, normal = self.prior.centre, self.mirror_normal
        return centre - 2.0 * (centre @ normal) * normal if self.left_handed else centre

    def expect(self, body: Body, descriptions: Sequence[Singles]) -> PoseGaussian:
        """Return the pose that the body alone makes likely, by its window's descriptions."""
        anchors = find_anchors(body.joints)
        return self._of_person(
            predict(self.prior, descriptions, anchors, body.height, self.parameters)
        )

    def expect_apart(self, body: Body, descriptions: Sequence[Singles]) -> dict[str, PoseGaussian]:
        """Return the pose that each part of the body makes likely by itself, without covariance,
        and that of ``expect``, named ``body``."""
        anchors = find_anchors(body.joints)
        apart = predict_apart(self.prior, descriptions[0], anchors, body.height, self.parameters)
        parts = {name: self._of_person(one) for name, one in zip(ANCHORS, apart, strict=True)}
        return parts | {"body": self.expect(body, descriptions)}

    def _of_person(self, predicted: Prediction) -> PoseGaussian:
        """A prediction, which is of right-handed people, as this person's."""
        centre, covariance = predicted.centre, predicted.covariance
        rotation = rotations.from_matrix(predicted.rotation)
        if self.left_handed:
            # A rotation vector is mirrored as an axis is: its x stays, its y and z change sign.
            signs = np.array([-1.0, 1.0, 1.0, 1.0, -1.0, -1.0])
            origin = centre - rotations.rotate(rotation, self.prior.centre)
            origin, rotation = mirror_pose(origin, rotation, self.mirror_normal)
            centre = origin + rotations.rotate(rotation, self.centre)
            covariance = covariance * signs[:, None] * signs
        return PoseGaussian(centre, rotation, covariance)


@dataclass(frozen=True)
class Belief:
    """The end of a frame: what the body alone made likely, and what was believed at last."""

    expected: PoseGaussian
    believed: PoseGaussian
    time_ns: int


def carry_over(
    before: Belief,
    expected: PoseGaussian,
    time_ns: int,
    persistence_s: float,
    parameters: FusionParameters,
) -> PoseMixture:
    """Mix what is expected now with what was believed before.

    The parts are, in this order: the difference from the prior stays; it is another one; and, where
    ``parameters.leaves``, the object stays where it was. ``persistence_s`` is the time constant
    with which a difference fades.
    """
    elapsed_s = (time_ns - before.time_ns) / 1e9
    parts = [_stays(before, expected, elapsed_s, persistence_s, parameters.forgetting_s), expected]
    if parameters.leaves:
        parts.append(_left(before.believed, parameters))
    shares = [parameters.stays_share, parameters.afresh_share, parameters.left_share]
    off = np.array([expected.square_distance(part) for part in parts])
    return mixture(parts, np.log(shares)[: len(parts)] - 0.5 * off / parameters.doubt)


def _stays(
    before: Belief,
    expected: PoseGaussian,
    elapsed_s: float,
    persistence_s: float,
    forgetting_s: float,
) -> PoseGaussian:
    """The pose that differs from the expected one as it did before, a little less."""
    kept = float(np.exp(-elapsed_s / persistence_s))
    inverse = rotations.conjugate(before.expected.rotation)
    moved = rotations.rotate(inverse, before.believed.centre - before.expected.centre)
    turned = rotations.to_vector(rotations.multiply(inverse, before.believed.rotation))
    rotation = rotations.multiply(expected.rotation, rotations.from_vector(kept * turned))
    turn = rotations.multiply(rotation, rotations.conjugate(before.believed.rotation))
    turned_covariance = turn_blocks(before.believed.covariance, rotations.to_matrix(turn))
    sure = float(np.exp(-elapsed_s / forgetting_s)) ** 2
    return PoseGaussian(
        expected.centre + rotations.rotate(expected.rotation, kept * moved),
        rotation,
        sure * turned_covariance + (1.0 - sure) * expected.covariance,
    )


def _left(believed: PoseGaussian, parameters: FusionParameters) -> PoseGaussian:
    """The pose of an object that stays where it was believed to be."""
    deviations = np.repeat([parameters.left_deviation_m, parameters.left_deviation_rad], 3)
    return replace(believed, covariance=believed.covariance + np.diag(np.square(deviations)))
