"""How far calibrated cameras disagree now, by a board that they see: was one bumped?"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from inhand_runtime.rig_calibration import RigCalibration

from inhand_calibration.culprits import culprits
from inhand_calibration.errors import CalibrationError
from inhand_calibration.from_board.rig import solve_rig
from inhand_calibration.from_board.sights import CameraSights
from inhand_calibration.rigid import angle, inverse, of_pose

MOVED_M, TURNED_RAD, CLOCK_S = 0.005, np.radians(0.3), 0.010
"""What a camera must be off by, at least, to be said to be: places, turns, clocks."""
SURE = 3.0
"""Number of deviations that it must be off by, too."""


@dataclass(frozen=True)
class BoardDisagreement:
    """How far two cameras are from where their calibration has them relative to each other.

    The second one is ``moved_m`` metres elsewhere in the first one's frame, turned by
    ``turned_rad``, and its clock is ``clock_s`` seconds off, None where either is not known.
    ``moved`` and ``clock_changed`` say whether that is more than chance, and matters.
    """

    first: str
    second: str
    moments: int
    moved_m: float
    moved_deviation_m: float
    turned_rad: float
    turned_deviation_rad: float
    clock_s: float | None
    moved: bool
    clock_changed: bool


def find_board_disagreement(
    cameras: Sequence[CameraSights], calibration: RigCalibration
) -> tuple[BoardDisagreement, ...]:
    """Place each two cameras anew by what they see of the board, and compare.

    Pairs that do not see it together often enough are left out. Raises CalibrationError where none
    does.
    """
    known = [one for one in cameras if one.camera in calibration.cameras and one.sights]
    pairs, reasons = [], []
    for first, second in combinations(known, 2):
        try:
            pairs.append(_compared(first, second, calibration))
        except CalibrationError as error:
            reasons.append(str(error))
    if not pairs:
        raise CalibrationError(
            reasons[0] if reasons else "no two calibrated cameras saw the board: show it to them"
        )
    return tuple(pairs)


def bumped(pairs: Sequence[BoardDisagreement]) -> tuple[str, ...]:
    """Return the cameras that disagree with every other, where others agree."""
    return tuple(sorted(culprits((pair.first, pair.second, pair.moved) for pair in pairs)))


def _compared(
    first: CameraSights, second: CameraSights, calibration: RigCalibration
) -> BoardDisagreement:
    solution = solve_rig([first, second])
    one, two = calibration.cameras[first.camera], calibration.cameras[second.camera]
    expected = inverse(of_pose(one.rig_from_camera)) @ of_pose(two.rig_from_camera)
    seen = solution.reference_from_camera[1]
    moved_m = float(np.linalg.norm(seen[:3, 3] - expected[:3, 3]))
    turned = angle(seen[:3, :3] @ expected[:3, :3].T)
    variances = np.diag(solution.covariances[1])
    before = np.array([*two.translation_deviation, *two.rotation_deviation]) ** 2
    before += np.array([*one.translation_deviation, *one.rotation_deviation]) ** 2
    total = variances + before
    place, turn = float(np.sqrt(total[:3].sum())), float(np.sqrt(total[3:].sum()))
    clock_s = None
    deviation_s = float(solution.offset_deviations_s[1])
    if np.isfinite(deviation_s) and None not in (one.clock_offset_ns, two.clock_offset_ns):
        before_ns = (two.clock_offset_ns or 0) - (one.clock_offset_ns or 0)
        clock_s = float(solution.offsets_s[1]) - 1e-9 * before_ns
    return BoardDisagreement(
        first.camera,
        second.camera,
        len(solution.moments),
        moved_m,
        place,
        turned,
        turn,
        clock_s,
        (moved_m > max(MOVED_M, SURE * place)) or (turned > max(TURNED_RAD, SURE * turn)),
        clock_s is not None and abs(clock_s) > max(CLOCK_S, SURE * deviation_s),
    )
