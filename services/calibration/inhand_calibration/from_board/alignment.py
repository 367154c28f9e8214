"""Where two cameras are to each other, roughly, and how far their clocks are apart.

The board's own points make a track in each camera. At the right clock offset one rigid transform
lays one track on the other; at a wrong one it does so only where the board stands still.
"""

from dataclasses import dataclass, replace

import numpy as np

from inhand_calibration.arrays import Array
from inhand_calibration.from_board.sights import CameraSights, board_pose
from inhand_calibration.rigid import moved, rigid_fit


@dataclass(frozen=True)
class AlignmentParameters:
    """How tracks are laid on each other."""

    longest_offset_s: float = 10.0
    """Clock offset, at most, that is looked for."""
    step_s: float = 0.04
    """Step of the offsets that are tried."""
    fine_step_s: float = 0.005
    """Step of those tried around the best one."""
    sights: int = 120
    """Sights of a camera that are compared, at most."""
    near_m: float = 0.03
    """Distance of two points, at most, and this share of their depth, that are laid on each
    other: what one small board says of its own distance errs."""
    apart_s: float = 0.12
    """Time between two sights, at most, that are compared."""
    first_rounds: int = 3
    """Rounds of weighing where many offsets are tried."""
    rounds: int = 8
    """Rounds around the best of them."""
    elsewhere_m: float = 0.1
    """Movement of a corner of the board, at least, that makes another place of it."""
    preference: float = 0.02
    """Share of the score by which an offset must be better than none at all."""


DEFAULT_ALIGNMENT = AlignmentParameters()


@dataclass(frozen=True)
class Alignment:
    """Where a second camera is in the frame of a first (4, 4), ``first_from_second``.

    ``offset_s`` is what to add to the second camera's times to have the first's. ``moments`` are
    the sights of both that were compared, and ``agreeing`` how many of them agree; these show the
    board in so many ``places``. Any one place can be laid on any other.
    """

    first_from_second: Array
    offset_s: float
    moments: int
    agreeing: int
    places: int
    score: float


@dataclass(frozen=True)
class _Track:
    """The board's outline (S, 4, 3) in a camera's frame at times (S,), seconds."""

    times: Array
    points: Array


def align(
    first: CameraSights,
    second: CameraSights,
    parameters: AlignmentParameters = DEFAULT_ALIGNMENT,
) -> Alignment | None:
    """Lay what one camera saw on what another did; None where they share too little."""
    one, two = _track(first, parameters.sights), _track(second, 4 * parameters.sights)
    if min(len(one.times), len(two.times)) < 2:
        return None
    # The tracks' times are each since the first sight of its own camera.
    shift = (second.start_ns - first.start_ns) * 1e-9
    steps = np.arange(0.0, parameters.longest_offset_s, parameters.step_s)
    offsets = np.concatenate([-steps[:0:-1], steps])
    quick = replace(parameters, rounds=parameters.first_rounds)
    tried = [_try(one, two, float(offset), shift, quick) for offset in offsets]
    known = [alignment for alignment in tried if alignment is not None]
    if not known:
        return None
    best = max(known, key=lambda one: one.score)
    fine = np.arange(-parameters.step_s, parameters.step_s, parameters.fine_step_s)
    for offset in best.offset_s + fine:
        alignment = _try(one, two, float(offset), shift, parameters)
        if alignment is not None and alignment.score > best.score:
            best = alignment
    unshifted = _try(one, two, 0.0, shift, parameters)
    if unshifted is not None and unshifted.score > (1.0 - parameters.preference) * best.score:
        best = unshifted
    return best


def _track(sights: CameraSights, most: int) -> _Track:
    """The board's way by its poses that are sure, of as many sights as are wanted."""
    count = len(sights.sights)
    looked_at = np.unique(np.linspace(0, count - 1, min(count, most)).astype(int))
    poses = [board_pose(sights.lens, sights.board, sights.sights[one]) for one in looked_at]
    sure = [
        (index, pose.camera_from_board)
        for index, pose in zip(looked_at, poses, strict=True)
        if pose is not None and not pose.ambiguous
    ]
    matrices = np.array([matrix for _, matrix in sure]).reshape(-1, 4, 4)
    points = moved(matrices, sights.board.outline)
    return _Track(sights.times_s[[index for index, _ in sure]], points)


def _try(
    one: _Track, two: _Track, offset: float, shift: float, parameters: AlignmentParameters
) -> Alignment | None:
    """Lay tracks on each other at one clock offset."""
    times = two.times + shift + offset
    after = np.clip(np.searchsorted(times, one.times), 1, len(times) - 1)
    before = after - 1
    span = times[after] - times[before]
    share = np.clip((one.times - times[before]) / np.maximum(span, 1e-9), 0.0, 1.0)
    nearest = np.where(share > 0.5, after, before)
    joined = span <= parameters.apart_s
    ends = two.points[nearest]
    between = (1.0 - share)[:, None, None] * two.points[before] + share[:, None, None] * two.points[
        after
    ]
    places = np.where(joined[:, None, None], between, ends)
    near = np.abs(times[nearest] - one.times) <= parameters.apart_s / 2.0
    if near.sum() < 2:
        return None
    target, source = one.points[near], places[near]
    limits = parameters.near_m * np.maximum(
        1.0, np.maximum(target[..., 2], source[..., 2]).mean(axis=1)
    )
    weights = np.ones(len(target))
    transform = np.eye(4)
    errors = np.zeros(len(target))
    for _ in range(parameters.rounds):
        transform = rigid_fit(
            source.reshape(-1, 3), target.reshape(-1, 3), np.repeat(weights, target.shape[1])
        )
        laid = moved(transform, source.reshape(-1, 3)).reshape(source.shape)
        errors = np.sqrt(np.mean(np.sum((laid - target) ** 2, axis=2), axis=1)) / limits
        weights = 1.0 / np.maximum(errors, 0.1) / limits
    gains = np.maximum(0.0, 1.0 - errors**2)
    agreeing = target[errors < 1.0]
    seen = _places(agreeing, parameters.elsewhere_m)
    return Alignment(transform, offset, len(target), len(agreeing), seen, float(gains.sum()))


def _places(points: Array, elsewhere_m: float) -> int:
    """In how many places a board's points (S, 4, 3) are, one after the other."""
    if len(points) == 0:
        return 0
    kept = points[:1]
    for one in points[1:]:
        if np.abs(one - kept[-1]).max() < elsewhere_m:
            continue
        if np.abs(kept - one).max(axis=(1, 2)).min() > elsewhere_m:
            kept = np.concatenate([kept, one[None]])
    return len(kept)
