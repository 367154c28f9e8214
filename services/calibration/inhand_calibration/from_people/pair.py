"""How two cameras are placed and timed relative to each other, found from nothing.

The best hypotheses of ``common_movement`` are refined, and the one at which the cameras agree best
is taken, if it is surely better than all that are not the same.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from inhand_calibration.arrays import Array
from inhand_calibration.from_people.agreement import seen
from inhand_calibration.from_people.common_movement import hypotheses
from inhand_calibration.from_people.estimate import CameraEstimate, still
from inhand_calibration.from_people.parameters import PeopleCalibrationParameters
from inhand_calibration.from_people.refinement import Refined, agree, refine
from inhand_calibration.from_people.tracks import Track, observe


@dataclass(frozen=True)
class PairFound:
    """The second camera relative to the first: its estimate, ``common_s`` seconds for which both
    see the same person, the ``share`` that these are of the time in which both see anybody, and
    ``surely``, the standard errors by which it is better than any other hypothesis."""

    second: CameraEstimate
    common_s: float
    share: float
    surely: float


def find_pair(
    first: Sequence[Track], second: Sequence[Track], parameters: PeopleCalibrationParameters
) -> PairFound | None:
    """Find how the second camera is placed and timed; None where nothing agrees at all."""
    tracks = (first, second)
    coarse = replace(
        parameters, agreement=parameters.search.agreement, refinement=parameters.search.refinement
    )
    screened = [
        (_cost(tracks, hypothesis, coarse).sum(), index, hypothesis)
        for index, hypothesis in enumerate(hypotheses(first, second, parameters.search))
    ]
    best: list[tuple[float, int, CameraEstimate]] = []
    for candidate in sorted(screened, key=lambda one: one[:2]):
        if not any(_alike(candidate[2], other[2], parameters) for other in best):
            best.append(candidate)
    refined = [
        refine(tracks, [still(), one], coarse) for _, _, one in best[: parameters.search.refined]
    ]
    costs = [_cost(tracks, one.estimates[1], coarse) for one in refined]
    if not costs:
        return None
    winner = int(np.argmin([cost.sum() for cost in costs]))
    rivals = [
        cost
        for one, cost in zip(refined, costs, strict=True)
        if not _alike(one.estimates[1], refined[winner].estimates[1], parameters)
    ]
    surely = min((_surely(costs[winner], rival, coarse) for rival in rivals), default=np.inf)
    return _found(tracks, refined[winner], float(surely), coarse)


def _alike(
    one: CameraEstimate, other: CameraEstimate, parameters: PeopleCalibrationParameters
) -> bool:
    """Whether two hypotheses are the same but for what refinement changes."""
    apart = abs(one.offset - other.offset)
    turned = one.angle_to(other)
    return apart < parameters.search.apart_s and turned < parameters.search.apart_rad


def _cost(
    tracks: Sequence[Sequence[Track]],
    estimate: CameraEstimate,
    parameters: PeopleCalibrationParameters,
) -> Array:
    """Cost of each moment (K,) of the first camera's: 0 where both agree, 1 where they do not or
    only the first sees anybody."""
    times = _times_of(tracks[0], parameters)
    agreement = agree(tracks, [still(), estimate], times, parameters)[0, 1]
    cost = np.ones(len(times))
    squares = (agreement.distances / parameters.agreement.gate_m) ** 2
    np.minimum.at(cost, agreement.moments, squares)
    return cost


def _times_of(tracks: Sequence[Track], parameters: PeopleCalibrationParameters) -> Array:
    """Times (K,) over all of a camera's movements."""
    start, end = min(t.start for t in tracks), max(t.end for t in tracks)
    return np.arange(start, end, parameters.agreement.step_s)


def _surely(best: Array, rival: Array, parameters: PeopleCalibrationParameters) -> float:
    """Standard errors by which the rival's cost (K,) is greater, over blocks of time."""
    length = round(parameters.search.block_s / parameters.agreement.step_s)
    counted = (best < 1.0) | (rival < 1.0)
    difference = (rival - best)[counted]
    blocks = np.array_split(difference, max(len(difference) // length, 2))
    means = np.array([block.mean() for block in blocks if len(block)])
    return float(means.mean() / max(means.std(ddof=1) / np.sqrt(len(means)), 1e-9))


def _found(
    tracks: Sequence[Sequence[Track]],
    refined: Refined,
    surely: float,
    parameters: PeopleCalibrationParameters,
) -> PairFound:
    observed = [
        observe(own, estimate.camera_times(refined.times))
        for own, estimate in zip(tracks, refined.estimates, strict=True)
    ]
    both = int((seen(observed[0]) & seen(observed[1])).sum())
    common = len(np.unique(refined.agreements[0, 1].moments))
    return PairFound(
        refined.estimates[1],
        common * parameters.agreement.step_s,
        common / max(both, 1),
        surely,
    )
