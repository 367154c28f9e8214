"""Moments in which two or more cameras see the board, and the corners that they saw then."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inhand_calibration.arrays import Array
from inhand_calibration.from_board.adjustment import Bundle, Corners3D
from inhand_calibration.from_board.detection import LEAST_CORNERS
from inhand_calibration.from_board.sights import (
    NS,
    Between,
    BoardPose,
    CameraSights,
    Sight,
    board_pose,
)
from inhand_calibration.rigid import inverse, moved


@dataclass(frozen=True)
class MomentParameters:
    """Which moments are taken, and how far their corners are trusted."""

    window_s: float = 0.2
    """Time from which one moment, the best, is taken."""
    still_px_s: float = 12.0
    """Speed of the board in a picture below which it stands still: hands shake."""
    moved_px: float = 3.0
    """Movement in any picture since the last moment, at least, that makes another one: moments of a
    board that stands still become their mean."""
    most_means: int = 2
    """Number of instants, at most, by which a mean is better: corners of a board that stands still
    err alike, too."""
    timing_s: float = 0.008
    """Deviation of when corners were seen, beside the camera's own: shutters that roll down the
    picture."""
    most: int = 240
    """Moments that are taken, at most."""
    wild_px: float = 60.0
    """Error of a camera's corners, at most, where the adjustment begins."""


DEFAULT_MOMENTS = MomentParameters()


@dataclass(frozen=True)
class Moment:
    """What each camera saw of the board at one time of the reference, by the cameras' numbers."""

    time_ns: int
    views: dict[int, Between]
    speed_px_s: float


def common_moments(
    cameras: Sequence[CameraSights],
    offsets_ns: Sequence[int],
    parameters: MomentParameters = DEFAULT_MOMENTS,
) -> list[Moment]:
    """Choose moments by the reference's clock; ``offsets_ns`` are added to the cameras' times."""
    times = sorted(
        sight.time_ns + offset
        for camera, offset in zip(cameras, offsets_ns, strict=True)
        for sight in camera.sights
    )
    chosen: list[Moment] = []
    best: Moment | None = None
    window_ns = round(parameters.window_s / NS)
    end = 0
    for time_ns in times:
        if time_ns >= end:
            _keep(best, chosen, parameters)
            best, end = None, time_ns + window_ns
        moment = _moment(cameras, offsets_ns, time_ns, parameters)
        if moment is not None and (best is None or _rank(moment) > _rank(best)):
            best = moment
    _keep(best, chosen, parameters)
    if len(chosen) <= parameters.most:
        return chosen
    picked = np.linspace(0, len(chosen) - 1, parameters.most).astype(int)
    return [chosen[index] for index in picked]


def _rank(moment: Moment) -> tuple[int, float]:
    return len(moment.views), -moment.speed_px_s


def _moment(
    cameras: Sequence[CameraSights],
    offsets_ns: Sequence[int],
    time_ns: int,
    parameters: MomentParameters,
) -> Moment | None:
    views = {}
    for index, (camera, offset) in enumerate(zip(cameras, offsets_ns, strict=True)):
        if not camera.sights:
            continue
        view = camera.at(time_ns - offset, parameters.still_px_s)
        if view is not None:
            views[index] = view
    if len(views) < 2:
        return None
    speeds = [float(np.median(np.linalg.norm(one.velocities, axis=1))) for one in views.values()]
    return Moment(time_ns, views, max(speeds))


def _keep(moment: Moment | None, chosen: list[Moment], parameters: MomentParameters) -> None:
    """Keep a moment; where the board stands as at the last one, as part of that one's mean, or in
    its place where more cameras see it, or fewer saw it at rest."""
    if moment is None:
        return
    if not chosen or not _stands(chosen[-1], moment, parameters.moved_px):
        chosen.append(moment)
    elif _at_rest(moment, parameters) and _at_rest(chosen[-1], parameters):
        chosen[-1] = _mean(chosen[-1], moment)
    elif _rank(moment) > _rank(chosen[-1]):
        chosen[-1] = moment


def _at_rest(moment: Moment, parameters: MomentParameters) -> bool:
    return moment.speed_px_s <= parameters.still_px_s


def _mean(before: Moment, after: Moment) -> Moment:
    """Join two moments of a board at rest; what few saw alone is left to the one that has it."""
    if before.views.keys() != after.views.keys():
        return after if _rank(after) > _rank(before) else before
    views = {
        camera: view.with_another(after.views[camera]) for camera, view in before.views.items()
    }
    if any(len(view.numbers) < LEAST_CORNERS for view in views.values()):
        return before
    return Moment(before.time_ns, views, max(before.speed_px_s, after.speed_px_s))


def _stands(before: Moment, after: Moment, moved_px: float) -> bool:
    shared = before.views.keys() & after.views.keys()
    if not shared:
        return False
    for camera in shared:
        one, two = before.views[camera], after.views[camera]
        _, first, second = np.intersect1d(
            one.numbers, two.numbers, assume_unique=True, return_indices=True
        )
        if len(first) == 0:
            return False
        steps = np.linalg.norm(two.pixels[second] - one.pixels[first], axis=1)
        if float(np.median(steps)) > moved_px:
            return False
    return True


def corners_of(
    moments: Sequence[Moment],
    cameras: Sequence[CameraSights],
    uncertainties_s: Sequence[float],
    parameters: MomentParameters = DEFAULT_MOMENTS,
) -> Corners3D:
    """Join the corners of all moments; ``uncertainties_s`` are of the cameras' times."""
    parts = []
    for number, moment in enumerate(moments):
        for index, view in moment.views.items():
            count = len(view.numbers)
            timing = float(np.hypot(uncertainties_s[index], parameters.timing_s))
            parts.append(
                (
                    np.full(count, index),
                    np.full(count, number),
                    cameras[index].board.corners[view.numbers],
                    view.pixels,
                    view.velocities,
                    np.hypot(np.linalg.norm(view.velocities, axis=1) * timing, view.bend_px),
                    np.full(count, min(view.instants, parameters.most_means) ** -0.5),
                )
            )
    return Corners3D(*(np.concatenate(column) for column in zip(*parts, strict=True)))


def started(
    moments: Sequence[Moment],
    cameras: Sequence[CameraSights],
    from_reference: Array,
    parameters: MomentParameters = DEFAULT_MOMENTS,
) -> tuple[list[Moment], Bundle]:
    """Guess where the board is at each moment by the camera that explains best what all saw.

    Moments that none explains are left out.
    """
    kept, boards = [], []
    for moment in moments:
        guesses = [
            inverse(from_reference[index]) @ pose
            for index, view in moment.views.items()
            for pose in _poses(cameras[index], view)
        ]
        errors = [_worst_error(moment, cameras, from_reference, board) for board in guesses]
        if guesses and min(errors) < parameters.wild_px:
            kept.append(moment)
            boards.append(guesses[int(np.argmin(errors))])
    count = len(cameras)
    poses = np.array(boards).reshape(-1, 4, 4)
    return kept, Bundle(from_reference, poses, np.zeros(count), np.zeros((count, 3)))


def _poses(camera: CameraSights, view: Between) -> list[Array]:
    sight = Sight(0, view.numbers, view.pixels)
    pose: BoardPose | None = board_pose(camera.lens, camera.board, sight)
    if pose is None:
        return []
    return [pose.camera_from_board, *([] if pose.other is None else [pose.other])]


def _worst_error(
    moment: Moment, cameras: Sequence[CameraSights], from_reference: Array, board: Array
) -> float:
    """The median error of the corners of the camera that sees them worst, pixels."""
    worst = 0.0
    for index, view in moment.views.items():
        camera = cameras[index]
        points = moved(from_reference[index] @ board, camera.board.corners[view.numbers])
        if (points[:, 2] < 0.05).any():
            return float("inf")
        errors = np.linalg.norm(camera.lens.project(points) - view.pixels, axis=1)
        worst = max(worst, float(np.median(errors)))
    return worst
