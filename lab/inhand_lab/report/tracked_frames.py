"""Draws tracked frames with the true and the tracked object, as in the paper's figure 13."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from inhand_runtime.pixels import decode_colour
from inhand_schemas.messages import Pose
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array, Bytes, Indices
from inhand_tracker.geometry.camera import Intrinsics, intrinsics_of
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.wire.poses import pose_message
from matplotlib.figure import Figure

from inhand_lab.datasets.frame_pixels import pixels_of
from inhand_lab.datasets.recorded_frames import (
    RecordedFrame,
    labelled_camera,
    load_camera_info,
)
from inhand_lab.datasets.tracks import Track, true_track
from inhand_lab.evaluation.vertex_error import vertex_error
from inhand_lab.report.parameters import DEFAULT_REPORT
from inhand_lab.report.picture import TRACKED, TRUE, Picture, picture_of

LAYOUT = DEFAULT_REPORT


@dataclass(frozen=True)
class TrackedRecording:
    """A recording, the joints (T, 20, 3) that were seen in it, and its object's track."""

    path: Path
    frames: Sequence[RecordedFrame]
    joints: Array
    track: Track


def draw_tracked_frames(
    recording: TrackedRecording, shape: ObjectShape, title: str, file: Path
) -> bool:
    """Draw the true and the tracked object on frames spread over a recording, as a JPEG file.

    Returns False where the recording describes no camera, or no label has a pose.
    """
    frames, tracked = recording.frames, recording.track.held()
    true = true_track(frames)
    drawable = np.flatnonzero(true.given & tracked.given)
    name = labelled_camera(frames)
    info = load_camera_info(recording.path, name)
    if info is None or len(drawable) == 0:
        return False
    camera = intrinsics_of(info)
    chosen = _spread(drawable)
    points = [
        rotations.rotate(poses.rotations[index], shape.vertices) + poses.translations[index]
        for poses in (true, tracked)
        for index in chosen
    ]
    rows, columns = _window(np.concatenate([*recording.joints[chosen], *points]), camera)
    figure = _figure(rows, columns)
    figure.suptitle(f"{title}\ntrue green, tracked red; time and vertex error", fontsize=10)
    tiles = figure.subplots(LAYOUT.tile_rows, LAYOUT.tile_columns).flat
    colours = {
        index: decode_colour(pixels.colour)
        for index, pixels in pixels_of(recording.path, frames, name)
        if index in chosen and pixels.colour is not None
    }
    for axes, index in zip(tiles, chosen, strict=True):
        picture = _picture(colours.get(index), camera)
        picture.draw_skeleton(recording.joints[index])
        picture.draw_object(shape, _pose(true, index), TRUE)
        picture.draw_object(shape, _pose(tracked, index), TRACKED)
        scale = picture.camera.width / camera.width
        area = tuple(slice(int(scale * s.start), int(scale * s.stop)) for s in (rows, columns))
        axes.imshow(picture.pixels[area])
        seconds = (frames[index].time_ns - frames[0].time_ns) / 1e9
        error = vertex_error(_at(tracked, index), _at(true, index), shape.marked_vertices)
        axes.set_title(f"{seconds:.1f} s: {100.0 * float(error):.1f} cm", fontsize=10)
        axes.set_axis_off()
    figure.savefig(file, dpi=LAYOUT.dots_per_inch, pil_kwargs={"quality": LAYOUT.jpeg_quality})
    return True


def _spread(drawable: Indices) -> Indices:
    """Choose as many frames as there are tiles, evenly among those that can be drawn."""
    tiles = LAYOUT.tile_columns * LAYOUT.tile_rows
    steps = np.linspace(0, len(drawable) - 1, tiles + 2)[1:-1]
    return drawable[np.rint(steps).astype(int)]


def _figure(rows: slice, columns: slice) -> Figure:
    """Make a figure in which every tile shows that part of an image."""
    size = np.array([columns.stop - columns.start, rows.stop - rows.start], float)
    width, height = LAYOUT.tile_inches * size / size.max()
    return Figure(
        figsize=(
            LAYOUT.tile_columns * width,
            LAYOUT.tile_rows * (height + LAYOUT.heading_inches) + 2 * LAYOUT.heading_inches,
        ),
        layout="constrained",
    )


def _picture(colour: Bytes | None, camera: Intrinsics) -> Picture:
    if colour is None:
        colour = np.full((camera.height, camera.width, 3), LAYOUT.paper_grey, np.uint8)
    height, width = colour.shape[:2]
    return picture_of(colour, camera.scaled_to(width, height))


def _window(points: Array, camera: Intrinsics) -> tuple[slice, slice]:
    """Return the rows and columns of the image around points (N, 3) in the camera frame."""
    pixels = camera.project(points)
    pixels = pixels[np.isfinite(pixels).all(axis=1)]
    size = np.array([camera.width, camera.height])
    if len(pixels) == 0:
        return slice(0, camera.height), slice(0, camera.width)
    low = np.clip(pixels.min(axis=0) - LAYOUT.margin_pixels, 0, size - 1).astype(int)
    high = np.clip(pixels.max(axis=0) + LAYOUT.margin_pixels, low + 1, size).astype(int)
    return slice(low[1], high[1]), slice(low[0], high[0])


def _pose(track: Track, index: int) -> Pose:
    return pose_message(*_at(track, index))


def _at(track: Track, index: int) -> tuple[Array, Array]:
    return track.translations[index], track.rotations[index]
