"""All clock offsets at once by Fourier transforms are those of one rigid fit after another."""

import numpy as np
from inhand_calibration.arrays import Array
from inhand_calibration.from_people.common_movement import hypotheses
from inhand_calibration.from_people.middles import middles
from inhand_calibration.from_people.parameters import SearchParameters
from inhand_calibration.from_people.tracks import Track
from scipy.spatial.transform import Rotation

PARAMETERS = SearchParameters(least_overlap_s=3.0)


def _track(start: float, joints: Array, known: Array) -> Track:
    """A track whose nodes are as far apart as the offsets that are tried."""
    positions = np.where(known[..., None], joints, 0.0)
    return Track(0, start, PARAMETERS.step_s, positions, 0.0 * positions, known.astype(float))


def _one_fit(first: Track, second: Track, lag: int) -> tuple[float, Array, Array]:
    """Mean squared distance, rotation and translation of the second's points on the first's, whose
    node ``lag + k`` is at the same time as the second's node k."""
    own, own_known = middles(first.positions, first.support)
    other, other_known = middles(second.positions, second.support)
    begin, end = max(0, -lag), min(len(other), len(own) - lag)
    theirs, ours = other[begin:end], own[begin + lag : end + lag]
    both = other_known[begin:end] & own_known[begin + lag : end + lag]
    a, b = ours[both], theirs[both]
    turn, _ = Rotation.align_vectors(a - a.mean(axis=0), b - b.mean(axis=0))
    rotation = turn.as_matrix()
    translation = a.mean(axis=0) - rotation @ b.mean(axis=0)
    error = np.mean(np.sum((a - b @ rotation.T - translation) ** 2, axis=1))
    return float(error), rotation, translation


def test_the_best_offset_and_its_pose_are_those_of_the_best_single_fit() -> None:
    random = np.random.default_rng(3)
    walk = np.cumsum(random.normal(size=(120, 1, 3)), axis=0) * 0.05
    body = walk + 0.3 * random.normal(size=(1, 20, 3)) + 0.02 * random.normal(size=(120, 20, 3))
    turn = Rotation.from_rotvec([0.4, -1.2, 0.7]).as_matrix()
    seen = (body + 0.02 * random.normal(size=body.shape) - [1.0, 0.2, 2.0]) @ turn
    first = _track(0.0, body[:90], random.random((90, 20)) > 0.1)
    second = _track(5.0, seen[25:], random.random((95, 20)) > 0.1)
    found = min(hypotheses([first], [second], PARAMETERS), key=lambda one: abs(one.offset + 2.5))
    fits = {lag: _one_fit(first, second, lag) for lag in range(-60, 60)}
    best = min(fits, key=lambda lag: fits[lag][0])
    _, rotation, translation = fits[best]
    assert best == 25
    # The first's start, and the lag, less the second's start.
    assert abs(found.offset - (0.0 + 2.5 - 5.0)) < 1e-9
    np.testing.assert_allclose(found.rotation, rotation, atol=1e-6)
    np.testing.assert_allclose(found.translation, translation, atol=1e-6)
