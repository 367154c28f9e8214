"""How far calibrated cameras disagree now: somebody may have bumped one, or set a clock.

Each two cameras that see the same person are placed anew relative to each other by a short piece of
recording, and what that changes is compared with how sure it is. A camera has moved if it disagrees
with others that agree among themselves.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from inhand_runtime.rig_calibration import CameraCalibration, RigCalibration

from inhand_calibration.arrays import Array
from inhand_calibration.culprits import culprits
from inhand_calibration.from_people.agreement import Agreement
from inhand_calibration.from_people.estimate import CameraEstimate, estimate_of, still
from inhand_calibration.from_people.pair import find_pair
from inhand_calibration.from_people.parameters import (
    DEFAULT_PEOPLE_CALIBRATION,
    DisagreementParameters,
    PeopleCalibrationParameters,
)
from inhand_calibration.from_people.refinement import Refined, refine
from inhand_calibration.from_people.skeletons import CameraSkeletons
from inhand_calibration.from_people.tracks import Track, find_tracks
from inhand_calibration.rigid import cross_matrices

_OFFSET = 6


@dataclass(frozen=True)
class PairDisagreement:
    """How far two cameras are from where their calibration has them relative to each other.

    People whom both see for ``common_s`` seconds are ``moved_m`` metres elsewhere in the second
    than the calibration says, and turned by ``turned_rad`` radians; its clock is ``clock_s``
    seconds from it, None where the calibration has no clock. The deviations are standard ones.
    ``moved`` and ``clock_changed`` say whether that is more than can be by chance, and matters.
    """

    first: str
    second: str
    common_s: float
    moved_m: float
    moved_deviation_m: float
    turned_rad: float
    turned_deviation_rad: float
    clock_s: float | None
    clock_deviation_s: float
    moved: bool
    clock_changed: bool


@dataclass(frozen=True)
class Disagreement:
    """What each two cameras that see the same person say, and the cameras that were ``bumped`` or
    whose clocks were ``reset``, as far as others show which of the two it is."""

    pairs: tuple[PairDisagreement, ...]
    bumped: tuple[str, ...]
    reset: tuple[str, ...]

    @property
    def sentences(self) -> tuple[str, ...]:
        """What is wrong, a sentence each; none where all agree."""
        found = []
        for pair in self.pairs:
            both = f"{pair.first} and {pair.second}"
            if pair.moved:
                found.append(
                    f"{_blamed(pair, self.bumped, both, 'was moved')}: people are "
                    f"{100 * pair.moved_m:.0f} cm and {np.degrees(pair.turned_rad):.1f}° off "
                    f"between {both}: run `inhand calibrate` again"
                )
            if pair.clock_changed and pair.clock_s is not None:
                found.append(
                    f"{_blamed(pair, self.reset, both, 'has another time')}: {both} are "
                    f"{abs(pair.clock_s):.3f} s off: run `inhand calibrate` again"
                )
        return tuple(found)


def find_disagreement(
    cameras: Sequence[CameraSkeletons],
    calibration: RigCalibration,
    parameters: PeopleCalibrationParameters = DEFAULT_PEOPLE_CALIBRATION,
) -> Disagreement:
    """Find how far cameras disagree with their calibration, in any frame of it.

    Cameras that it does not name are left out, and so are pairs that do not see the same person
    for long enough to say anything.
    """
    known = [one for one in cameras if one.name in calibration.cameras and len(one.times_ns)]
    tracks = [find_tracks(one, parameters.movement) for one in known]
    pairs = []
    for first, second in combinations(range(len(known)), 2):
        if not tracks[first] or not tracks[second]:
            continue
        both = (known[first], known[second])
        calibrated = (calibration.cameras[both[0].name], calibration.cameras[both[1].name])
        compared = _compared(both, calibrated, (tracks[first], tracks[second]), parameters)
        if compared is not None:
            pairs.append(compared)
    moved = culprits((pair.first, pair.second, pair.moved) for pair in pairs)
    changed = culprits(
        (pair.first, pair.second, pair.clock_changed) for pair in pairs if pair.clock_s is not None
    )
    return Disagreement(
        tuple(pairs),
        tuple(one.name for one in known if one.name in moved),
        tuple(one.name for one in known if one.name in changed),
    )


def _blamed(pair: PairDisagreement, culprits: Sequence[str], both: str, what: str) -> str:
    one = [name for name in (pair.first, pair.second) if name in culprits]
    return f"{one[0]} {what}" if one else f"one of {both} {what}"


def _compared(
    cameras: tuple[CameraSkeletons, CameraSkeletons],
    calibrated: tuple[CameraCalibration, CameraCalibration],
    tracks: tuple[Sequence[Track], Sequence[Track]],
    parameters: PeopleCalibrationParameters,
) -> PairDisagreement | None:
    """One pair as it is now; None where it does not see the same person for long enough."""
    expected = _expected(cameras, calibrated)
    limits = parameters.disagreement
    now = refine(tracks, [still(), expected], parameters)
    if not _explains(now, expected, limits, parameters):
        anew = find_pair(*tracks, parameters)
        if anew is None or anew.surely < parameters.search.surely:
            return None
        now = refine(tracks, [still(), anew.second], parameters)
    agreement = now.agreements[0, 1]
    common = len(np.unique(agreement.moments)) * parameters.agreement.step_s
    if common < limits.least_s:
        return None
    clocks_known = all(one.clock_offset_ns is not None for one in calibrated)
    return _judged(cameras, calibrated, (expected, now), common, clocks_known, limits)


def _expected(
    cameras: tuple[CameraSkeletons, CameraSkeletons],
    calibrated: tuple[CameraCalibration, CameraCalibration],
) -> CameraEstimate:
    """The second camera relative to the first as the calibration has it."""
    first, second = (estimate_of(one.rig_from_camera) for one in calibrated)
    begins = [
        int(camera.times_ns[0]) + (one.clock_offset_ns or 0)
        for camera, one in zip(cameras, calibrated, strict=True)
    ]
    relative = second.after(first.inverse())
    return replace(relative, offset=1e-9 * (begins[1] - begins[0]))


def _explains(
    now: Refined,
    expected: CameraEstimate,
    limits: DisagreementParameters,
    parameters: PeopleCalibrationParameters,
) -> bool:
    """Whether what was refined from the calibration is still it, but for little, and holds for most
    of the time in which both see people: else all is sought anew."""
    agreement = now.agreements[0, 1]
    if len(now.times) == 0 or len(np.unique(agreement.moments)) < limits.explained * len(now.times):
        return False
    near = float(np.median(agreement.distances)) < limits.explained_m
    return near and expected.angle_to(now.estimates[1]) < parameters.search.apart_rad


def _judged(
    cameras: tuple[CameraSkeletons, CameraSkeletons],
    calibrated: tuple[CameraCalibration, CameraCalibration],
    estimates: tuple[CameraEstimate, Refined],
    common: float,
    clocks_known: bool,
    limits: DisagreementParameters,
) -> PairDisagreement:
    expected, refined = estimates
    now, covariance = refined.estimates[1], refined.covariance_of(1)
    place = _place_of_people(refined.agreements[0, 1])
    arm = now.rotation @ place
    by_pose = np.hstack([np.eye(3), -cross_matrices(arm)])
    before_place = _norm_of([value for one in calibrated for value in one.translation_deviation])
    before_turn = _norm_of([value for one in calibrated for value in one.rotation_deviation])
    spread = float(np.linalg.eigvalsh(by_pose @ covariance[:6, :6] @ by_pose.T)[-1])
    turn_spread = float(np.linalg.eigvalsh(covariance[3:6, 3:6])[-1])
    before_clock = _norm_of([1e-9 * (one.clock_deviation_ns or 0) for one in calibrated])
    moved = float(np.linalg.norm(now.apply(place) - expected.apply(place)))
    turned = now.angle_to(expected)
    clock = now.offset - expected.offset
    moved_deviation = float(np.hypot(np.sqrt(spread), before_place))
    turned_deviation = float(np.hypot(np.sqrt(turn_spread), before_turn))
    clock_deviation = float(np.hypot(np.sqrt(covariance[_OFFSET, _OFFSET]), before_clock))
    return PairDisagreement(
        cameras[0].name,
        cameras[1].name,
        common,
        moved,
        moved_deviation,
        turned,
        turned_deviation,
        clock if clocks_known else None,
        clock_deviation,
        moved > max(limits.moved_m, limits.surely * moved_deviation)
        or turned > max(limits.turned_rad, limits.surely * turned_deviation),
        clocks_known and abs(clock) > max(limits.clock_s, limits.surely * clock_deviation),
    )


def _place_of_people(agreement: Agreement) -> Array:
    """The mean place (3,) of the people's joints in the second camera's frame."""
    seen = agreement.second.support > 0.0
    return np.asarray(agreement.second.positions[seen].mean(axis=0))


def _norm_of(values: Sequence[float]) -> float:
    return float(np.linalg.norm(values))
