"""All cameras of a rig in one frame, by what they saw of one board."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from inhand_runtime.wording import counted

from inhand_calibration.arrays import Array
from inhand_calibration.errors import CalibrationError
from inhand_calibration.from_board.adjustment import (
    CAMERA_PARAMETERS,
    CLOCK,
    LENS,
    Adjusted,
    adjust,
)
from inhand_calibration.from_board.alignment import DEFAULT_ALIGNMENT, Alignment, align
from inhand_calibration.from_board.moments import (
    DEFAULT_MOMENTS,
    Moment,
    common_moments,
    corners_of,
    started,
)
from inhand_calibration.from_board.sights import NS, CameraSights
from inhand_calibration.rigid import cross_matrices, inverse

LEAST_PLACES = 4
"""Places of the board, at least, that two cameras must see together to be joined by them."""
ENOUGH_MOMENTS = 20
"""Moments of two cameras with which both are well known."""
LEAST_AGREEING = 0.5
"""Share of the moments, at least, in which a board must be where both cameras say it is."""
CLOCK_ROUNDS = 3
"""Rounds in which corners are taken anew where clocks proved to be otherwise."""
SETTLED_CLOCK_S = 0.0005
"""Change of a clock's offset below which they are not."""
KNOWN_CLOCK_S = 0.02
"""Deviation of a clock's offset, at most, with which it counts as estimated."""


CLOCK_FLOOR_S = 0.001
"""Deviation of a clock's offset, at least, beside that boards do not go straight on between two
pictures."""


@dataclass(frozen=True)
class RigSolution:
    """Where the cameras of a rig are in the first one's frame, its reference.

    ``reference_from_camera`` (C, 4, 4); ``covariances`` (C, 6, 6) of each one's translation and
    rotation vector along the reference's axes, metres and radians, 0 of the first. ``offsets_s``
    (C,) are to be added to the cameras' times, with deviations, NaN where nothing says them.
    ``boards`` (M, 4, 4) is where the board was in the reference's frame at ``moments``.
    """

    cameras: tuple[CameraSights, ...]
    reference_from_camera: Array
    covariances: Array
    offsets_s: Array
    offset_deviations_s: Array
    boards: Array
    moments: tuple[Moment, ...]
    errors_px: Array
    """Root mean square error of each camera's corners that count, pixels."""
    left_out: Array
    """Share of each camera's corners that do not count."""
    lens_changes: Array
    """By how much lenses (C, 3) would be other than published if they were adjusted, too: focal
    length, a share of it, and principal point, pixels."""
    lens_deviations: Array
    """Deviations of these."""

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the cameras."""
        return tuple(one.camera for one in self.cameras)

    def together(self) -> dict[tuple[str, str], int]:
        """Return in how many of the moments each two cameras saw the board together."""
        numbers = {name: number for number, name in enumerate(self.names)}
        return {
            (one, two): sum(
                numbers[one] in moment.views and numbers[two] in moment.views
                for moment in self.moments
            )
            for one, two in combinations(sorted(self.names), 2)
        }


def solve_rig(cameras: Sequence[CameraSights]) -> RigSolution:
    """Find where all cameras are, the first one's frame being the reference.

    Raises CalibrationError where they do not see the board together often enough, or what they see
    fits no place of the cameras.
    """
    links = {
        (one, two): align(cameras[one], cameras[two])
        for one, two in combinations(range(len(cameras)), 2)
    }
    from_reference, offsets = _joined(cameras, links)
    adjusted, moments = _adjusted(cameras, from_reference, offsets)
    for _ in range(CLOCK_ROUNDS):
        changes = adjusted.bundle.clocks
        offsets = offsets + changes
        if np.abs(changes).max() < SETTLED_CLOCK_S:
            break
        adjusted, moments = _adjusted(cameras, adjusted.bundle.cameras, offsets)
    return _solution(
        cameras, adjusted, moments, offsets, *_changed_lenses(cameras, adjusted, moments)
    )


def _joined(
    cameras: Sequence[CameraSights], links: dict[tuple[int, int], Alignment | None]
) -> tuple[Array, Array]:
    """Join cameras by the pairs that agree best, from the first one on: the cameras (C, 4, 4) from
    the reference, and their clocks' offsets (C,), seconds."""
    _require_agreement(cameras, links)
    usable = {
        pair: link
        for pair, link in links.items()
        if link is not None and link.places >= LEAST_PLACES
    }
    from_reference: dict[int, Array] = {0: np.eye(4)}
    offsets = {0: 0.0}
    while len(from_reference) < len(cameras):
        open_links = [
            (link.score, one, two, link)
            for (one, two), link in usable.items()
            if (one in from_reference) != (two in from_reference)
        ]
        if not open_links:
            raise CalibrationError(_apart(cameras, set(from_reference)))
        _, one, two, link = max(open_links, key=lambda entry: entry[0])
        if one in from_reference:
            from_reference[two] = inverse(link.first_from_second) @ from_reference[one]
            offsets[two] = offsets[one] + link.offset_s
        else:
            from_reference[one] = link.first_from_second @ from_reference[two]
            offsets[one] = offsets[two] - link.offset_s
    numbers = range(len(cameras))
    return (
        np.array([from_reference[index] for index in numbers]),
        np.array([offsets[index] for index in numbers]),
    )


def _require_agreement(
    cameras: Sequence[CameraSights], links: dict[tuple[int, int], Alignment | None]
) -> None:
    """Raise CalibrationError where two cameras see boards that cannot be one."""
    for (one, two), link in links.items():
        if link is None or link.moments < 2 * LEAST_PLACES:
            continue
        if link.agreeing < LEAST_AGREEING * link.moments:
            raise CalibrationError(
                f"{cameras[one].camera} and {cameras[two].camera} do not see one board that stands "
                f"still to them: only {link.agreeing} of {link.moments} moments agree. Is there a "
                "second board of this kind, was a camera moved meanwhile, or are its intrinsics "
                "wrong?"
            )


def _apart(cameras: Sequence[CameraSights], joined: set[int]) -> str:
    """Say which cameras nothing joins with the others."""
    names = [one.camera for one in cameras]
    others = [name for index, name in enumerate(names) if index not in joined]
    return (
        f"{' and '.join(others)} never saw the board together with "
        f"{' or '.join(names[index] for index in sorted(joined))} often enough "
        f"({counted(LEAST_PLACES, 'place')} at least): hold it where two of them see it, "
        "standing still, in as many places as you can. Clocks that are more than "
        f"{DEFAULT_ALIGNMENT.longest_offset_s:.0f} s apart look the same: set those of all hosts "
        "by one time"
    )


def _adjusted(
    cameras: Sequence[CameraSights], from_reference: Array, offsets: Array
) -> tuple[Adjusted, list[Moment]]:
    """Adjust all by the moments that the clocks' offsets (C,), seconds, make common."""
    offsets_ns = [round(offset / NS) for offset in offsets]
    moments = common_moments(cameras, offsets_ns)
    moments, bundle = started(moments, cameras, from_reference)
    if not moments:
        raise CalibrationError(_apart(cameras, {0}))
    uncertainties = [
        max((one.uncertainty_ns for one in camera.sights), default=0) * NS for camera in cameras
    ]
    corners = corners_of(moments, cameras, uncertainties)
    return adjust(corners, tuple(one.lens for one in cameras), bundle), moments


def _solution(
    cameras: Sequence[CameraSights],
    adjusted: Adjusted,
    moments: Sequence[Moment],
    offsets: Array,
    lens_changes: Array,
    lens_deviations: Array,
) -> RigSolution:
    bundle = adjusted.bundle
    count = len(cameras)
    corners = corners_of(moments, cameras, [0.0] * count)
    errors, left_out = np.full(count, np.nan), np.zeros(count)
    for index in range(count):
        own = corners.camera == index
        good = own & adjusted.counted
        if good.any():
            errors[index] = np.sqrt(np.mean(adjusted.errors[good] ** 2))
        left_out[index] = 1.0 - good.sum() / max(own.sum(), 1)
    covariances, clock_deviations = np.zeros((count, 6, 6)), np.zeros(count)
    for index in range(1, count):
        start = CAMERA_PARAMETERS * index
        own = slice(start, start + 6)
        covariances[index] = _of_camera(bundle.cameras[index], adjusted.covariance[own, own])
        clock_deviations[index] = np.sqrt(adjusted.covariance[start + CLOCK, start + CLOCK])
    doubts = np.array([_timing_doubt(moments, index) for index in range(count)])
    floor = np.sqrt(CLOCK_FLOOR_S**2 + doubts[0] ** 2 + doubts[1:] ** 2)
    clock_deviations[1:] = np.hypot(clock_deviations[1:], floor)
    clock_deviations[clock_deviations > KNOWN_CLOCK_S] = np.nan
    return RigSolution(
        tuple(cameras),
        inverse(bundle.cameras),
        covariances,
        offsets,
        clock_deviations,
        bundle.boards,
        tuple(moments),
        errors,
        left_out,
        lens_changes,
        lens_deviations,
    )


def _timing_doubt(moments: Sequence[Moment], camera: int) -> float:
    """By how many seconds a camera may misplace a board that moves, since it goes round bends
    between two pictures, and alike again and again: the median of its moments."""
    doubts = [
        moment.views[camera].bend_px / moment.speed_px_s
        for moment in moments
        if camera in moment.views
        and moment.speed_px_s > DEFAULT_MOMENTS.still_px_s
        and moment.views[camera].bend_px > 0.0
    ]
    return float(np.median(doubts)) if doubts else 0.0


def _changed_lenses(
    cameras: Sequence[CameraSights], adjusted: Adjusted, moments: Sequence[Moment]
) -> tuple[Array, Array]:
    """Adjust lenses, too: their changes (C, 3) and the deviations of these."""
    corners = corners_of(moments, cameras, [0.0] * len(cameras))
    lenses = tuple(one.lens for one in cameras)
    free = adjust(corners, lenses, adjusted.bundle, with_lenses=True)
    variances = np.diag(free.covariance).reshape(-1, CAMERA_PARAMETERS)[:, LENS]
    return free.bundle.lenses, np.sqrt(variances)


def _of_camera(camera_from_reference: Array, covariance: Array) -> Array:
    """Covariance (6, 6) of translation and rotation of ``reference_from_camera``, of that of the
    other way round, whose rotation comes first and is on the left."""
    back = camera_from_reference[:3, :3].T
    change = np.zeros((6, 6))
    change[:3, :3] = -back @ cross_matrices(camera_from_reference[None, :3, 3])[0]
    change[:3, 3:] = -back
    change[3:, :3] = -back
    return change @ covariance @ change.T
