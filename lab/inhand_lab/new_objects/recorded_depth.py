"""The depth of a recording in which nothing moves, each pixel the median of several frames."""

from pathlib import Path

import numpy as np
from inhand_runtime.pixels import decode_depth
from inhand_runtime.recording import read_recording
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import CameraInfo
from inhand_schemas.topics import INFO
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.camera import Intrinsics, intrinsics_of

from inhand_lab.datasets.recorded_frames import iterate_pixels
from inhand_lab.new_objects.parameters import DEFAULT_MEASURING, MeasuringParameters
from inhand_lab.new_objects.table import MeasuringError


def read_still_depth(
    path: Path, parameters: MeasuringParameters = DEFAULT_MEASURING
) -> tuple[Array, Intrinsics]:
    """Read the depth (H, W) in metres of a recording's first frames, and its camera.

    Raises MeasuringError where there is no depth or no camera, or something moves, and
    RecordingError for a file that cannot be read.
    """
    cameras = _cameras(path)
    if len(cameras) != 1:
        seen = f"{len(cameras)} cameras ({', '.join(sorted(cameras))})" if cameras else "no camera"
        raise MeasuringError(f"{path} describes {seen}: record one, with its info")
    ((name, info),) = cameras.items()
    frames: list[Array] = []
    for pixels in iterate_pixels(path, name):
        if pixels.depth is None:
            continue
        try:
            frames.append(decode_depth(pixels.depth).astype(np.float64) * info.depth_scale)
        except MessageError as error:
            raise MeasuringError(f"{path}: {error}; record again") from None
        if len(frames) == parameters.frames:
            break
    if len(frames) < parameters.fewest_frames:
        raise MeasuringError(
            f"{path} holds {len(frames)} frames of depth: record {parameters.frames} or more, with "
            "depth"
        )
    depth = still_depth(np.stack(frames), parameters)
    return depth, intrinsics_of(info).scaled_to(depth.shape[1], depth.shape[0])


def still_depth(frames: Array, parameters: MeasuringParameters = DEFAULT_MEASURING) -> Array:
    """The median (H, W) of depths (T, H, W) in metres, 0 where too few frames have one.

    Raises MeasuringError where something moves.
    """
    measured = np.where(frames > 0.0, frames, np.nan)
    third = max(len(frames) // 3, 1)
    first, last = _median(measured[:third]), _median(measured[-third:])
    # Depth errs by more the farther away it is; a pixel without depth does not count as moved.
    allowed = parameters.moved_m + parameters.moved_m_per_m2 * first**2
    moved = float((np.abs(first - last) > allowed).mean())
    if moved > parameters.most_moved_share:
        raise MeasuringError(
            f"{moved:.0%} of the image move: keep camera, thing and hands still while it records"
        )
    enough = (frames > 0.0).mean(axis=0) >= parameters.least_frames_share
    return np.where(enough, np.nan_to_num(_median(measured)), 0.0)


def _cameras(path: Path) -> dict[str, CameraInfo]:
    """The cameras of a recording by name."""
    return {
        recorded.name: message
        for recorded in read_recording(path, streams=(INFO.stream,))
        if isinstance(message := recorded.message(), CameraInfo)
    }


def _median(frames: Array) -> Array:
    """The median (H, W) of the numbers among frames (T, H, W), NaN where there are none."""
    ordered = np.sort(frames, axis=0)  # NaN last
    counts = np.isfinite(frames).sum(axis=0)
    middle = np.maximum(counts - 1, 0) // 2
    chosen: Array = np.take_along_axis(ordered, middle[None], axis=0)[0]
    return chosen
