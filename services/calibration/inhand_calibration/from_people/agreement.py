"""At which moments two cameras see the same person, and how far they agree about them."""

from dataclasses import dataclass

import numpy as np
from inhand_schemas.joints import MIRRORED_JOINTS

from inhand_calibration.arrays import Array, Flags, Indices
from inhand_calibration.from_people.estimate import CameraEstimate
from inhand_calibration.from_people.middles import LEFT, RIGHT, middles
from inhand_calibration.from_people.parameters import AgreementParameters
from inhand_calibration.from_people.tracks import Observed

_SIDES = (*LEFT, *RIGHT)


@dataclass(frozen=True)
class Agreement:
    """M moments at which two cameras see the same person, each in its own frame.

    ``moments`` (M,) are places in the times that were compared; a moment is there once for each
    person. Positions and velocities are (M, 20, 3), supports (M, 20); the second's left and right
    are exchanged where the cameras did not agree about them, which ``exchanged`` (M,) says.
    ``distances`` (M,) are root mean squares over the body's middles, metres.
    """

    moments: Indices
    first: Observed
    second: Observed
    exchanged: Flags
    distances: Array


def find_agreement(
    first: tuple[Observed, CameraEstimate],
    second: tuple[Observed, CameraEstimate],
    parameters: AgreementParameters,
) -> Agreement:
    """Return where the people of two cameras, observed at the same moments, are the same."""
    distances = _distances(first, second, parameters)
    moments, ours, theirs = _nearest_to_each_other(distances, parameters.gate_m)
    own, other = _chosen(first[0], ours, moments), _chosen(second[0], theirs, moments)
    exchanged = _exchanged(own, first[1], other, second[1], parameters)
    for values in (other.positions, other.velocities, other.support):
        values[exchanged] = values[exchanged][:, list(MIRRORED_JOINTS)]
    return Agreement(moments, own, other, exchanged, distances[ours, theirs, moments])


def seen(observed: Observed) -> Flags:
    """Return whether (K,) anybody is seen at a moment."""
    return np.asarray((observed.support > 0.0).any(axis=(0, 2)))


def _distances(
    first: tuple[Observed, CameraEstimate],
    second: tuple[Observed, CameraEstimate],
    parameters: AgreementParameters,
) -> Array:
    """Distances (A, B, K) of A people from B people at each moment, infinite where not known."""
    (own, own_known), (other, other_known) = (
        middles(estimate.apply(observed.positions), observed.support)
        for observed, estimate in (first, second)
    )
    result = np.full((len(own), len(other), own.shape[1]), np.inf)
    for row in range(len(own)):
        for column in range(len(other)):
            both = own_known[row] & other_known[column]
            enough = np.flatnonzero(both.sum(axis=1) >= parameters.least_joints)
            squares = np.sum((own[row, enough] - other[column, enough]) ** 2, axis=2)
            capped = np.minimum(squares, parameters.most_m**2) * both[enough]
            result[row, column, enough] = np.sqrt(capped.sum(axis=1) / both[enough].sum(axis=1))
    return result


def _nearest_to_each_other(distances: Array, gate: float) -> tuple[Indices, Indices, Indices]:
    """Moments and the people who are each other's nearest there, within the gate."""
    ours, theirs, moments = np.nonzero(
        (distances <= gate)
        & (distances == distances.min(axis=0, keepdims=True, initial=np.inf))
        & (distances == distances.min(axis=1, keepdims=True, initial=np.inf))
    )
    return moments, ours, theirs


def _chosen(observed: Observed, people: Indices, moments: Indices) -> Observed:
    return Observed(
        observed.positions[people, moments],
        observed.velocities[people, moments],
        observed.support[people, moments],
    )


def _exchanged(
    own: Observed,
    own_estimate: CameraEstimate,
    other: Observed,
    other_estimate: CameraEstimate,
    parameters: AgreementParameters,
) -> Flags:
    """Whether (M,) the other camera takes the person's left for the right."""
    place = own_estimate.apply(own.positions[:, _SIDES])
    there = other_estimate.apply(other.positions)
    costs = []
    for joints in (_SIDES, (*RIGHT, *LEFT)):
        both = (own.support[:, _SIDES] > 0.0) & (other.support[:, joints] > 0.0)
        squares = np.sum((place - there[:, joints]) ** 2, axis=2)
        capped = np.minimum(squares, parameters.most_m**2) * both
        costs.append(capped.sum(axis=1) / np.maximum(both.sum(axis=1), 1))
    return np.asarray(costs[1] < costs[0])
