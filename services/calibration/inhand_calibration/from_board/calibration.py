"""A rig calibrated by a board: the file's content, how sure it is, and what is wrong."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import datetime

import numpy as np
from inhand_runtime.rig_calibration import CameraCalibration, RigCalibration
from scipy.linalg import block_diag

from inhand_calibration.arrays import Array
from inhand_calibration.errors import CalibrationError
from inhand_calibration.from_board.intrinsics import IntrinsicsCheck, check_intrinsics
from inhand_calibration.from_board.rig import ENOUGH_MOMENTS, RigSolution, solve_rig
from inhand_calibration.from_board.rig_frame import BOARD, RigFrame, choose_frame
from inhand_calibration.from_board.sights import NS, CameraSights
from inhand_calibration.rigid import to_pose

SURE = 4.5
"""Number of deviations from which on a lens is other than its camera says."""
MATTERS = 0.002
"""What that must move a corner by, at least, at the edge of the picture, to matter: a share of the
picture's width."""
LARGE_ERROR_PX = 1.0
"""Error of a camera's corners from which on its picture or the board is not as it should be."""


@dataclass(frozen=True)
class LensFinding:
    """A camera whose lens is other than it says, as all cameras together show: what to use."""

    camera: str
    focal_share: float
    focal_deviation: float
    centre_px: tuple[float, float]
    sentence: str


@dataclass(frozen=True)
class BoardCalibration:
    """What a board told of a rig.

    ``intrinsics`` by camera are what each alone shows, ``lenses`` what all together show to be
    wrong. ``warnings`` are sentences.
    """

    rig: RigCalibration
    solution: RigSolution
    frame: RigFrame
    covariances: Mapping[str, Array]
    intrinsics: Mapping[str, IntrinsicsCheck]
    lenses: tuple[LensFinding, ...]
    warnings: tuple[str, ...]


def calibrate_from_board(
    cameras: Sequence[CameraSights],
    made: datetime,
    points: Mapping[str, Array] | None = None,
    origin: str | None = None,
    *,
    board_on_floor: bool = False,
) -> BoardCalibration:
    """Find where the cameras of a rig are; ``points`` (N, 3) of their depth may show the floor.

    See ``choose_frame`` for the others. Raises CalibrationError, with what to do.
    """
    solution = solve_rig(_ordered(cameras, origin))
    known = points or {}
    clouds = [known.get(name, np.empty((0, 3))) for name in solution.names]
    frame = choose_frame(solution, clouds if known else [], origin, board_on_floor=board_on_floor)
    poses = frame.rig_from_reference @ solution.reference_from_camera
    turn = block_diag(*[frame.rig_from_reference[:3, :3]] * 2)
    covariances = {
        name: turn @ covariance @ turn.T
        for name, covariance in zip(solution.names, solution.covariances, strict=True)
    }
    calibrated = {
        name: _for_file(poses[index], covariances[name], solution, index, made)
        for index, name in enumerate(solution.names)
    }
    ordered = {camera.camera: calibrated[camera.camera] for camera in cameras}
    intrinsics = {camera.camera: check_intrinsics(camera) for camera in cameras}
    lenses = _lens_findings(solution)
    return BoardCalibration(
        RigCalibration(ordered, frame.words),
        solution,
        frame,
        covariances,
        intrinsics,
        lenses,
        (*_warnings(solution, intrinsics, lenses), *(one.sentence for one in lenses)),
    )


def _ordered(cameras: Sequence[CameraSights], origin: str | None) -> list[CameraSights]:
    """The cameras with a sight, the reference first: the origin, or who saw the board most."""
    names = [camera.camera for camera in cameras]
    blind = [camera.camera for camera in cameras if not camera.sights]
    if blind:
        raise CalibrationError(
            f"{' and '.join(blind)} never saw the board: bring it nearer, a third of the picture "
            "wide, into more light, or take a larger one"
        )
    if len(cameras) < 2:
        raise CalibrationError(
            "only " + (names[0] if names else "no camera") + " was heard: a rig is calibrated by "
            "two cameras or more that see the board at the same time"
        )
    if origin is not None and origin != BOARD and origin not in names:
        raise CalibrationError(f"there is no camera {origin}; there are: {', '.join(names)}")
    return sorted(cameras, key=lambda one: (one.camera != origin, -len(one.sights)))


def _for_file(
    rig_from_camera: Array, covariance: Array, solution: RigSolution, index: int, made: datetime
) -> CameraCalibration:
    deviations = [float(one) for one in np.sqrt(np.diag(covariance))]
    offset_s = float(solution.offsets_s[index])
    deviation_s = float(solution.offset_deviations_s[index])
    known = np.isfinite(deviation_s)
    return CameraCalibration(
        to_pose(rig_from_camera),
        (deviations[0], deviations[1], deviations[2]),
        (deviations[3], deviations[4], deviations[5]),
        "board",
        made,
        round(offset_s / NS) if known else None,
        round(deviation_s / NS) if known else None,
    )


def _lens_findings(solution: RigSolution) -> tuple[LensFinding, ...]:
    """The cameras whose lens all moments together show to be another one."""
    findings = []
    for camera, change, deviation in zip(
        solution.cameras, solution.lens_changes, solution.lens_deviations, strict=True
    ):
        lens = camera.lens
        moves = np.abs([change[0] * lens.width / 2.0, change[1], change[2]])
        sure = (np.abs(change) > SURE * deviation) & (moves > MATTERS * lens.width)
        if not sure.any():
            continue
        better = lens.changed(*(float(one) for one in np.where(sure, change, 0.0)))
        findings.append(
            LensFinding(
                camera.camera,
                float(change[0]),
                float(deviation[0]),
                (float(change[1]), float(change[2])),
                f"the intrinsics of {camera.camera} are wrong: with fx = {better.fx:.1f}, "
                f"fy = {better.fy:.1f}, cx = {better.cx:.1f}, cy = {better.cy:.1f} (published: "
                f"{lens.fx:.1f}, {lens.fy:.1f}, {lens.cx:.1f}, {lens.cy:.1f}) it would agree with "
                "the others: correct them, and calibrate again",
            )
        )
    return tuple(findings)


def _warnings(
    solution: RigSolution,
    intrinsics: Mapping[str, IntrinsicsCheck],
    lenses: Sequence[LensFinding],
) -> list[str]:
    warnings = []
    together = solution.together()
    for name in solution.names:
        most = max(count for pair, count in together.items() if name in pair)
        if most < ENOUGH_MOMENTS:
            warnings.append(
                f"{name} saw the board with another camera in {most} places only: "
                f"{ENOUGH_MOMENTS} are enough"
            )
    for name, error, left_out in zip(
        solution.names, solution.errors_px, solution.left_out, strict=True
    ):
        if error > LARGE_ERROR_PX:
            warnings.append(
                f"corners of {name} are {error:.1f} px off: the board may be bent, or the picture "
                "blurred"
            )
        if left_out > 0.1:
            warnings.append(
                f"{left_out:.0%} of the corners of {name} fit nothing: they are left out"
            )
    named = {one.camera for one in lenses}
    for name, check in intrinsics.items():
        if check.verdict == "wrong" and check.best is not None and name not in named:
            best = check.best
            numbers = ", ".join(f"{one:.4f}" for one in best.distortion)
            warnings.append(
                f"the intrinsics of {name} do not explain what it sees: corners err by "
                f"{check.published_px:.2f} px, and by {check.best_px:.2f} px with "
                f"fx = {best.fx:.1f}, fy = {best.fy:.1f}, cx = {best.cx:.1f}, cy = {best.cy:.1f}"
                + (f", distortion = [{numbers}]" if numbers else "")
            )
    return warnings


def scaled(cameras: Sequence[CameraSights], share: float) -> list[CameraSights]:
    """Return sights of a board that is larger than it should be by a share."""
    return [replace(camera, board=camera.board.scaled(share)) for camera in cameras]
