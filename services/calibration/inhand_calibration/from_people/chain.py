"""All cameras placed in the reference's frame, from pairs that see the same person."""

from collections.abc import Mapping, Sequence
from itertools import combinations

from inhand_calibration.errors import CalibrationError
from inhand_calibration.from_people.estimate import CameraEstimate, still
from inhand_calibration.from_people.pair import PairFound, find_pair
from inhand_calibration.from_people.parameters import (
    AcceptanceParameters,
    PeopleCalibrationParameters,
)
from inhand_calibration.from_people.tracks import Track


def chain_of_pairs(
    names: Sequence[str],
    tracks: Sequence[Sequence[Track]],
    parameters: PeopleCalibrationParameters,
) -> list[CameraEstimate]:
    """Return each camera's estimate relative to the first, over the pairs that share most.

    Raises CalibrationError where a camera shares nobody, or where a walk repeats itself so that
    clocks cannot be told apart.
    """
    found = {
        (first, second): one
        for first, second in combinations(range(len(names)), 2)
        if (one := find_pair(tracks[first], tracks[second], parameters)) is not None
    }
    sure = {pair: one for pair, one in found.items() if _acceptable(one, parameters.acceptance)}
    clear = {pair: one for pair, one in sure.items() if one.surely >= parameters.search.surely}
    estimates = {0: still()}
    while len(estimates) < len(names):
        reached = [pair for pair in clear if (pair[0] in estimates) != (pair[1] in estimates)]
        if not reached:
            raise _unreached(names, estimates, sure, found)
        longest = max(reached, key=lambda pair: clear[pair].common_s)
        near, far = longest if longest[0] in estimates else longest[::-1]
        second = clear[longest].second
        relative = second if near == longest[0] else second.inverse()
        estimates[far] = relative.after(estimates[near])
    return [estimates[camera] for camera in range(len(names))]


def _acceptable(found: PairFound, acceptance: AcceptanceParameters) -> bool:
    return found.common_s >= acceptance.least_common_s and found.share >= acceptance.least_share


def _unreached(
    names: Sequence[str],
    estimates: Mapping[int, CameraEstimate],
    sure: Mapping[tuple[int, int], PairFound],
    found: Mapping[tuple[int, int], PairFound],
) -> CalibrationError:
    """What is wrong with the cameras that are not placed."""
    placed = ", ".join(names[camera] for camera in sorted(estimates))
    left = [camera for camera in range(len(names)) if camera not in estimates]
    missing = ", ".join(names[camera] for camera in left)
    between = [pair for pair in found if (pair[0] in estimates) != (pair[1] in estimates)]
    if any(pair in sure for pair in between):
        return CalibrationError(
            f"the walk repeats itself, so that the clocks of {placed} and {missing} fit at several "
            "offsets: walk no circle, stop now and then, and turn another way"
        )
    longest = max((found[pair].common_s for pair in between), default=0.0)
    return CalibrationError(
        f"{missing} and {placed} do not see the same person move ({longest:.0f} s agree at the "
        "best): walk where both see you at the same time, from head to foot"
    )
