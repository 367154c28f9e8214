"""Tracked frames with the object drawn, as in the paper's figure 13."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from inhand_runtime.pixels import decode_colour
from inhand_schemas.messages import Pose
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array, Bytes
from inhand_tracker.geometry.camera import Intrinsics, intrinsics_of
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.wire.poses import pose_message
from matplotlib.figure import Figure

from inhand_lab.datasets.recorded_frames import (
    RecordedFrame,
    iterate_pixels,
    labelled_camera,
    load_camera_info,
)
from inhand_lab.datasets.tracks import Track, true_track
from inhand_lab.evaluation.vertex_error import vertex_error
from inhand_lab.report.picture import TRACKED, TRUE, Picture, picture_of

COLUMNS, ROWS = 4, 2
MARGIN_PIXELS = 25
TILE_INCHES = 4.5
"""A frame's longer side."""
HEADING_INCHES = 0.25
PAPER = 40
"""The grey that is drawn on where a recording has no pixels."""
DOTS_PER_INCH = 120
JPEG_QUALITY = 85


@dataclass(frozen=True)
class TrackedRecording:
    """A recording at ``path``, the joints (T, 20, 3) and the track of its object."""

    path: Path
    frames: Sequence[RecordedFrame]
    joints: Array
    track: Track


def draw_tracked_frames(seen: TrackedRecording, shape: ObjectShape, title: str, file: Path) -> bool:
    """Draw the true and the tracked object on frames spread over a recording, as a JPEG file.

    False where the recording does not tell its camera, or no label has a pose.
    """
    frames = seen.frames
    true, tracked = true_track(frames), seen.track.held()
    drawable = np.flatnonzero(true.given & tracked.given)
    name = labelled_camera(frames)
    info = load_camera_info(seen.path, name)
    if info is None or len(drawable) == 0:
        return False
    camera = intrinsics_of(info)
    spread = np.linspace(0, len(drawable) - 1, COLUMNS * ROWS + 2)[1:-1]
    chosen = drawable[np.rint(spread).astype(int)]
    colours = _colours(seen.path, name, {frames[index].time_ns for index in chosen})
    points = [
        rotations.rotate(poses.rotations[index], shape.vertices) + poses.translations[index]
        for poses in (true, tracked)
        for index in chosen
    ]
    rows, columns = _window(np.concatenate([*seen.joints[chosen], *points]), camera)
    figure = _figure(rows, columns)
    figure.suptitle(f"{title}\ntrue green, tracked red; time and vertex error", fontsize=10)
    for axes, index in zip(figure.subplots(ROWS, COLUMNS).flat, chosen, strict=True):
        frame = frames[index]
        picture = _picture(colours.get(frame.time_ns), camera)
        picture.draw_skeleton(seen.joints[index])
        picture.draw_object(shape, _pose(true, index), TRUE)
        picture.draw_object(shape, _pose(tracked, index), TRACKED)
        scale = picture.camera.width / camera.width
        area = tuple(slice(int(scale * s.start), int(scale * s.stop)) for s in (rows, columns))
        error = vertex_error(
            (tracked.translations[index], tracked.rotations[index]),
            (true.translations[index], true.rotations[index]),
            shape.marked_vertices,
        )
        axes.imshow(picture.pixels[area])
        seconds = (frame.time_ns - frames[0].time_ns) / 1e9
        axes.set_title(f"{seconds:.1f} s: {100.0 * float(error):.1f} cm", fontsize=10)
        axes.set_axis_off()
    figure.savefig(file, dpi=DOTS_PER_INCH, pil_kwargs={"quality": JPEG_QUALITY})
    return True


def _figure(rows: slice, columns: slice) -> Figure:
    """One in which all tiles of that part of an image fit."""
    size = np.array([columns.stop - columns.start, rows.stop - rows.start], float)
    width, height = TILE_INCHES * size / size.max()
    return Figure(
        figsize=(COLUMNS * width, ROWS * (height + HEADING_INCHES) + 2 * HEADING_INCHES),
        layout="constrained",
    )


def _colours(path: Path, camera: str | None, times_ns: set[int]) -> Mapping[int, Bytes]:
    return {
        frame.time_ns: decode_colour(frame.colour)
        for frame in iterate_pixels(path, camera)
        if frame.time_ns in times_ns and frame.colour is not None
    }


def _picture(colour: Bytes | None, camera: Intrinsics) -> Picture:
    if colour is None:
        colour = np.full((camera.height, camera.width, 3), PAPER, np.uint8)
    height, width = colour.shape[:2]
    return picture_of(colour, camera.scaled_to(width, height))


def _window(points: Array, camera: Intrinsics) -> tuple[slice, slice]:
    """The rows and columns of the image around points (N, 3) in the camera frame."""
    pixels = camera.project(points)
    pixels = pixels[np.isfinite(pixels).all(axis=1)]
    size = np.array([camera.width, camera.height])
    if len(pixels) == 0:
        return slice(0, camera.height), slice(0, camera.width)
    low = np.clip(pixels.min(axis=0) - MARGIN_PIXELS, 0, size - 1).astype(int)
    high = np.clip(pixels.max(axis=0) + MARGIN_PIXELS, low + 1, size).astype(int)
    return slice(low[1], high[1]), slice(low[0], high[0])


def _pose(track: Track, index: int) -> Pose:
    return pose_message(track.translations[index], track.rotations[index])
