"""All cameras placed in the reference's frame, from pairs that see the same person."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np

from inhand_calibration.errors import CalibrationError
from inhand_calibration.from_people.estimate import CameraEstimate, still
from inhand_calibration.from_people.pair import PairFound, find_pair
from inhand_calibration.from_people.parameters import (
    PeopleCalibrationParameters,
)
from inhand_calibration.from_people.tracks import Track

_MIRROR = np.array([-1.0, 1.0, 1.0])


def chain_of_pairs(
    names: Sequence[str],
    tracks: Sequence[Sequence[Track]],
    parameters: PeopleCalibrationParameters,
    begins_s: Sequence[float],
    clocks_within_s: float,
) -> list[CameraEstimate]:
    """Return each camera's estimate relative to the first, over the pairs that share most.

    ``begins_s`` are when the cameras' times begin, each by its own clock, and ``clocks_within_s``
    is how far clocks are apart at the most. Raises CalibrationError where a camera shares nobody,
    or where a walk repeats itself so that clocks cannot be told apart.
    """
    found = {
        (first, second): one
        for first, second in combinations(range(len(names)), 2)
        if (
            one := find_pair(
                tracks[first],
                tracks[second],
                parameters,
                _offsets(begins_s[second] - begins_s[first], clocks_within_s, parameters),
            )
        )
        is not None
    }
    clear = {pair: one for pair, one in found.items() if _is_clear(one, parameters)}
    estimates = {0: still()}
    while len(estimates) < len(names):
        reached = [pair for pair in clear if (pair[0] in estimates) != (pair[1] in estimates)]
        if not reached:
            raise _unreached(names, tracks, estimates, found, parameters)
        longest = max(reached, key=lambda pair: clear[pair].common_s)
        near, far = longest if longest[0] in estimates else longest[::-1]
        second = clear[longest].second
        relative = second if near == longest[0] else second.inverse()
        estimates[far] = relative.after(estimates[near])
    return [estimates[camera] for camera in range(len(names))]


def _offsets(
    between: float, within: float, parameters: PeopleCalibrationParameters
) -> tuple[float, float]:
    """The least and the largest clock offset, where the second begins so much later by its clock;
    a step more on either side, as steps do not begin there."""
    within += parameters.search.step_s
    return between - within, between + within


def _is_clear(found: PairFound, parameters: PeopleCalibrationParameters) -> bool:
    acceptance = parameters.acceptance
    enough = found.common_s >= acceptance.least_common_s and found.share >= acceptance.least_share
    return enough and found.surely >= parameters.search.surely


def _unreached(
    names: Sequence[str],
    tracks: Sequence[Sequence[Track]],
    estimates: Mapping[int, CameraEstimate],
    found: Mapping[tuple[int, int], PairFound],
    parameters: PeopleCalibrationParameters,
) -> CalibrationError:
    """What is wrong with the cameras that are not placed."""
    acceptance = parameters.acceptance
    placed = ", ".join(names[camera] for camera in sorted(estimates))
    missing = ", ".join(name for camera, name in enumerate(names) if camera not in estimates)
    pairs = [pair for pair in found if (pair[0] in estimates) != (pair[1] in estimates)]
    if max(track.spread for own in tracks for track in own) < acceptance.least_spread_m:
        return CalibrationError(
            "people stood still, which does not say how far clocks are apart: walk about for a "
            "minute where all cameras see you"
        )
    longest = max((found[pair].common_s for pair in pairs), default=0.0)
    shares = [found[pair].share for pair in pairs]
    if longest >= acceptance.least_common_s and max(shares) >= acceptance.repeating_share:
        return CalibrationError(
            f"the walk repeats itself, so that the clocks of {placed} and {missing} fit at several "
            "offsets: walk no circle, stop now and then, and turn another way; or, where one "
            "server sets the clocks, say how far they may be apart, such as --clocks-within 0.5"
        )
    for first, second in pairs:
        mirrored = find_pair(tracks[first], [_mirrored(t) for t in tracks[second]], parameters)
        if mirrored is not None and _is_clear(mirrored, parameters):
            return CalibrationError(
                f"{names[first]} and {names[second]} see each other's mirror image: turn the "
                "mirroring of one camera's images off"
            )
    return CalibrationError(
        f"{missing} and {placed} do not see the same person move ({longest:.0f} s agree at the "
        "best): walk where both see you at the same time, from head to foot"
    )


def _mirrored(track: Track) -> Track:
    """The movement as a camera sees it whose images are mirrored."""
    return replace(
        track, positions=track.positions * _MIRROR, velocities=track.velocities * _MIRROR
    )
