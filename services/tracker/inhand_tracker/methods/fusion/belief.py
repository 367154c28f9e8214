"""What is believed of a pose before an image is seen: the body's part, and what is carried over.

The prior (``prior``) errs by habits: how this person holds this mug is not to be seen in a body,
but it stays as it is. So what is tracked is how the pose differs from the prior's, in the object's
own frame: what an image showed of it fades away, as learned, while the object is hidden. And an
object that was left somewhere stays there, whatever the body does.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from inhand_tracker.body.anchors import ANCHORS, find_anchors
from inhand_tracker.body.reader import Body
from inhand_tracker.body.skeleton import mirror_pose
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array, Singles
from inhand_tracker.geometry.pose_gaussian import (
    PoseGaussian,
    PoseMixture,
    moved_covariance,
    turn_blocks,
)
from inhand_tracker.geometry.weights import normalised_weights
from inhand_tracker.methods.fusion.parameters import FusionParameters
from inhand_tracker.prior.parameters import DEFAULT_PRIOR, PriorParameters
from inhand_tracker.prior.prediction import Prediction
from inhand_tracker.prior.prior import Prior, predict_apart, predict_both


@dataclass(frozen=True)
class Expected:
    """The poses that a body alone makes likely: ``whole`` is one distribution of all of them.

    Where the posture is so unlike those that were learned that the object is likelier held as
    people hold it than where they had it in what they did, these are its ``alternatives``, two
    different places; the first one has a probability of ``held_share``.
    """

    whole: PoseGaussian
    alternatives: tuple[PoseGaussian, PoseGaussian] | None = None
    held_share: float = 0.0

    @property
    def strange(self) -> bool:
        """Whether the posture is that unlike, and the body says little."""
        return self.alternatives is not None


@dataclass(frozen=True)
class BodyExpectation:
    """The prior of one object for people of one handedness.

    Poses are those of a ``pivot`` (3,), in the object's frame: where people hold the object, as it
    turns about there; or its centre, where nobody was seen to hold it.
    """

    prior: Prior
    mirror_normal: Array
    left_handed: bool
    parameters: PriorParameters = DEFAULT_PRIOR

    @cached_property
    def centre(self) -> Array:
        """The object's centre (3,), in its frame."""
        return self._of_this_hand(self.prior.centre)

    @cached_property
    def pivot(self) -> Array:
        """The point (3,) of the object, in its frame, that poses are of."""
        return self._of_this_hand(self.prior.centre + self._grip)

    @cached_property
    def _grip(self) -> Array:
        """The way (3,) from the centre to the pivot, as right-handed people hold it."""
        return np.zeros(3) if self.prior.hold is None else self.prior.hold.grip

    def _of_this_hand(self, point: Array) -> Array:
        normal = self.mirror_normal
        return point - 2.0 * (point @ normal) * normal if self.left_handed else point

    def expect(
        self, body: Body, descriptions: Sequence[Singles], *, apart: bool = True
    ) -> Expected:
        """Return the poses that the body alone makes likely, by its window's descriptions; where
        they are not wanted ``apart``, as no image can choose, as one distribution."""
        anchors = find_anchors(body.joints)
        predicted = predict_both(self.prior, descriptions, anchors, body.height, self.parameters)
        whole = self._of_pivot(predicted.whole)
        held_share = predicted.strangeness * (1.0 - self.parameters.held_doubt)
        if self.prior.hold is None or held_share <= 1 / 2 or not apart:
            return Expected(whole)
        held = self._of_pivot(self.prior.hold.of(anchors))
        return Expected(whole, (held, self._of_pivot(predicted.regressed)), held_share)

    def expect_apart(self, body: Body, descriptions: Sequence[Singles]) -> dict[str, PoseGaussian]:
        """Return the pose that each part of the body makes likely by itself, without covariance,
        and that of ``expect``, named ``body``."""
        anchors = find_anchors(body.joints)
        apart = predict_apart(self.prior, descriptions[0], anchors, body.height, self.parameters)
        parts = {name: self._of_pivot(one) for name, one in zip(ANCHORS, apart, strict=True)}
        return parts | {"body": self.expect(body, descriptions, apart=False).whole}

    def _of_pivot(self, predicted: Prediction) -> PoseGaussian:
        """The distribution of the pivot's pose, for a prediction of the centre's as of right-handed
        people."""
        arm = predicted.rotation @ self._grip
        place, covariance = predicted.centre + arm, moved_covariance(predicted.covariance, arm)
        rotation = rotations.from_matrix(predicted.rotation)
        if self.left_handed:
            # A rotation vector is mirrored as an axis is: its x stays, its y and z change sign.
            signs = np.array([-1.0, 1.0, 1.0, 1.0, -1.0, -1.0])
            origin = place - rotations.rotate(rotation, self.prior.centre + self._grip)
            origin, rotation = mirror_pose(origin, rotation, self.mirror_normal)
            place = origin + rotations.rotate(rotation, self.pivot)
            covariance = covariance * signs[:, None] * signs
        return PoseGaussian(place, rotation, covariance)


@dataclass(frozen=True)
class Belief:
    """The end of a frame: what the body alone made likely, and what was believed at last;
    ``earlier`` is the frame before it, where there is one. Where the body leapt, and has the object
    elsewhere than is believed since, ``steady`` is the last frame before that."""

    expected: Expected
    believed: PoseGaussian
    time_ns: int
    earlier: "Belief | None" = None
    steady: "Belief | None" = None


def carry_over(
    before: Belief,
    expected: Expected,
    time_ns: int,
    persistence_s: float,
    parameters: FusionParameters,
) -> PoseMixture:
    """Mix what is expected now with what was believed before.

    The parts are, in this order: the difference from the prior stays; it is another one; where
    ``parameters.leaves``, the object stays where it was; and, where the posture is strange or the
    body leaps, it goes on as it went. ``persistence_s`` is the time constant with which a
    difference fades. Of a body that leaps a joint is likely wrong, and so the last two are likelier
    than what it makes likely, until it is back, or long enough away to be believed.
    """
    elapsed_s = (time_ns - before.time_ns) / 1e9
    steady = steady_before(before, expected, time_ns, parameters)
    stays = _stays(steady or before, expected, time_ns, persistence_s, parameters.forgetting_s)
    afresh = expect_afresh(expected)
    parts = [stays, *afresh.parts]
    shares = [parameters.stays_share, *(parameters.afresh_share * afresh.weights)]
    of_body = len(parts)
    if parameters.leaves:
        parts.append(_left(before.believed, parameters))
        shares.append(parameters.left_share)
    if (expected.strange or steady is not None) and before.earlier is not None:
        parts.append(_goes_on(before.earlier, before, elapsed_s, parameters))
        shares.append(parameters.goes_on_share)
    off = np.array([expected.whole.square_distance(part) for part in parts])
    weights = normalised_weights(np.log(shares) - 0.5 * off / parameters.doubt)
    if steady is not None and len(parts) > of_body:
        by_body = np.arange(len(parts)) < of_body
        weights = np.array(shares)
        weights[by_body] *= (1.0 - parameters.leap_doubt) / weights[by_body].sum()
        weights[~by_body] *= parameters.leap_doubt / weights[~by_body].sum()
    return PoseMixture(tuple(parts), weights, (0, *range(of_body, len(parts))))


def carry_on(before: Belief, time_ns: int, parameters: FusionParameters) -> PoseMixture:
    """Return what is believed where no body is seen: the object stays where it was, and, where it
    is known how it went, goes on so."""
    left = _left(before.believed, parameters)
    if before.earlier is None:
        return PoseMixture((left,), np.ones(1), (0,))
    elapsed_s = (time_ns - before.time_ns) / 1e9
    goes_on = _goes_on(before.earlier, before, elapsed_s, parameters)
    shares = np.array([parameters.left_share, parameters.goes_on_share])
    return PoseMixture((left, goes_on), shares / shares.sum(), (0, 1))


def steady_before(
    before: Belief, expected: Expected, time_ns: int, parameters: FusionParameters
) -> Belief | None:
    """Return the last frame before the body leapt, where it has the object elsewhere than was
    believed since; None where it did not leap, or too long ago."""
    steady = before.steady
    if _leaps(before, expected, (time_ns - before.time_ns) / 1e9, parameters):
        return before if steady is None else steady
    if steady is None or time_ns - steady.time_ns > 1e9 * parameters.leap_lasts_s:
        return None
    apart = float(np.linalg.norm(expected.whole.centre - before.believed.centre))
    return steady if apart > parameters.leap_apart_m else None


def _leaps(
    before: Belief, expected: Expected, elapsed_s: float, parameters: FusionParameters
) -> bool:
    """Whether a body takes what is expected away from where it was, as fast as no object goes that
    was not on its way already."""
    if before.earlier is None:
        return False
    leap = float(np.linalg.norm(expected.whole.centre - before.expected.whole.centre))
    return leap > farthest_way(before, elapsed_s, parameters)


def farthest_way(before: Belief, elapsed_s: float, parameters: FusionParameters) -> float:
    """Metres that an object goes at the most, by how fast it was on its way already."""
    speed = 0.0
    if before.earlier is not None:
        went = float(np.linalg.norm(before.believed.centre - before.earlier.believed.centre))
        speed = went / ((before.time_ns - before.earlier.time_ns) / 1e9)
    return elapsed_s * (parameters.leap_m_per_s + parameters.quickening * speed)


def expect_afresh(expected: Expected) -> PoseMixture:
    """Return what a body alone makes likely: where that is two things, first the object held."""
    if expected.alternatives is None:
        return PoseMixture((expected.whole,), np.ones(1))
    share = expected.held_share
    return PoseMixture(expected.alternatives, np.array([share, 1.0 - share]))


def _stays(
    before: Belief,
    expected: Expected,
    time_ns: int,
    persistence_s: float,
    forgetting_s: float,
) -> PoseGaussian:
    """The pose that differs from the expected one as what was believed ``before`` did from what
    was expected then, a little less."""
    elapsed_s = (time_ns - before.time_ns) / 1e9
    was, now, believed = before.expected.whole, expected.whole, before.believed
    if before.expected.alternatives is not None and expected.alternatives is not None:
        was, now = before.expected.alternatives[0], expected.alternatives[0]
    kept = float(np.exp(-elapsed_s / persistence_s))
    inverse = rotations.conjugate(was.rotation)
    moved = rotations.rotate(inverse, believed.centre - was.centre)
    turned = rotations.to_vector(rotations.multiply(inverse, believed.rotation))
    rotation = rotations.multiply(now.rotation, rotations.from_vector(kept * turned))
    turn = rotations.multiply(rotation, rotations.conjugate(believed.rotation))
    turned_covariance = turn_blocks(believed.covariance, rotations.to_matrix(turn))
    sure = float(np.exp(-elapsed_s / forgetting_s)) ** 2
    return PoseGaussian(
        now.centre + rotations.rotate(now.rotation, kept * moved),
        rotation,
        sure * turned_covariance + (1.0 - sure) * now.covariance,
    )


def _left(believed: PoseGaussian, parameters: FusionParameters) -> PoseGaussian:
    """The pose of an object that stays where it was believed to be."""
    deviations = np.repeat([parameters.left_deviation_m, parameters.left_deviation_rad], 3)
    return replace(believed, covariance=believed.covariance + np.diag(np.square(deviations)))


def _goes_on(
    earlier: Belief, before: Belief, elapsed_s: float, parameters: FusionParameters
) -> PoseGaussian:
    """The pose of an object that moves on from two frames as it went from one to the other."""
    ratio = elapsed_s / ((before.time_ns - earlier.time_ns) / 1e9)
    was, now = earlier.believed, before.believed
    turned = rotations.to_vector(
        rotations.multiply(now.rotation, rotations.conjugate(was.rotation))
    )
    deviations = np.repeat([parameters.goes_on_deviation_m, parameters.goes_on_deviation_rad], 3)
    return PoseGaussian(
        now.centre + ratio * (now.centre - was.centre),
        rotations.multiply(rotations.from_vector(ratio * turned), now.rotation),
        (1.0 + ratio) ** 2 * now.covariance
        + ratio**2 * was.covariance
        + np.diag(np.square(deviations)),
    )
