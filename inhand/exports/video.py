"""A camera's pictures as a video, with the outlines of objects at their poses drawn in."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

import av
import cv2
import numpy as np
from inhand_recorder.attachments import meshes_in
from inhand_runtime.recording import RecordingError
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import CameraInfo
from inhand_schemas.topics import LABEL, POSE
from numpy.typing import NDArray

from inhand.exports.placed_objects import Meshes, draw_placed, lens_of
from inhand.exports.request import ExportRequest, FramePoses
from inhand.exports.unfinished import unfinished

Rgb = tuple[int, int, int]


@dataclass(frozen=True)
class VideoParameters:
    """How pictures are coded and outlines look.

    ``quality`` is x264's constant rate factor, where 18 is hardly told from the original and 23 its
    default; colours are red, green and blue.
    """

    codec: str = "libx264"
    quality: int = 20
    preset: str = "veryfast"
    ticks_a_second: int = 90_000
    label_colour: Rgb = (40, 220, 60)
    pose_colour: Rgb = (240, 50, 40)
    line_px: int = 2


PARAMETERS = VideoParameters()


def export_video(request: ExportRequest, output: Path) -> dict[str, int]:
    """Write the pictures of one camera, each at the time of its capture, as MP4 (H.264).

    Labelled poses are outlined in green, others in red. Returns the numbers of frames, outlines
    and images that are damaged; raises RecordingError where the camera is not one, the pictures
    change their size or go back in time, and InhandError for a mesh that is missing.
    """
    camera, info, frames = request.frames_of_one_camera()
    outlines = _Outlines(request, camera, info)
    counts = {"frames": 0, "outlines": 0, "damaged images": 0}
    with unfinished(output) as path, av.open(str(path), "w", format="mp4") as container:
        video: _Video | None = None
        for frame in frames:
            try:
                colour = frame.colour
            except MessageError:
                counts["damaged images"] += 1
                continue
            if colour is None:
                continue
            if video is None:
                video = _Video(container, info, colour.shape, frame.time_ns)
            picture = colour.copy()
            counts["outlines"] += outlines.draw(picture, frame.time_ns)
            video.write(picture, frame.time_ns)
            counts["frames"] += 1
        if video is None:
            raise RecordingError(f"there is no picture of {camera} in this time")
        video.finish()
    return counts


class _Outlines:
    """Draws the outlines of objects into pictures of a camera."""

    def __init__(self, request: ExportRequest, camera: str, info: CameraInfo) -> None:
        self._camera, self._info = camera, info
        self._meshes = Meshes(request.objects, meshes_in(request.recording.attachments()))
        self._poses = [
            (FramePoses(request.recording[key]), colour)
            for topic, colour in (
                (LABEL, PARAMETERS.label_colour),
                (POSE, PARAMETERS.pose_colour),
            )
            for key in request.of(topic)
            if request.object in (None, key.rpartition("/")[2])
        ]

    def draw(self, picture: NDArray[np.uint8], time_ns: int) -> int:
        """Draw into a picture (H, W, 3) and return the number of outlines."""
        lens = lens_of(self._info, picture.shape[1], picture.shape[0])
        drawn = 0
        for poses, colour in self._poses:
            pose = poses.transform(self._camera, time_ns)
            if pose is None:
                continue
            mask = draw_placed(self._meshes.mesh(poses.object), pose, lens).labels
            lines, _ = cv2.findContours(mask, cv2.RETR_LIST, cv2.CHAIN_APPROX_NONE)
            cv2.drawContours(picture, lines, -1, colour, PARAMETERS.line_px, cv2.LINE_AA)
            drawn += bool(lines)
        return drawn


class _Video:
    """Codes pictures of one size, each with the time since the first one."""

    def __init__(
        self, container: Any, info: CameraInfo, shape: tuple[int, ...], begin_ns: int
    ) -> None:
        self._container, self._shape, self._begin_ns = container, shape, begin_ns
        self._latest = -1
        container.metadata["comment"] = f"the first frame was captured at {begin_ns} ns"
        rate = Fraction(info.frame_rate).limit_denominator(1000)
        self._stream = container.add_stream(PARAMETERS.codec, rate=rate)
        height, width = shape[:2]
        # H.264 halves the resolution of colour.
        self._stream.width, self._stream.height = width + width % 2, height + height % 2
        self._stream.pix_fmt = "yuv420p"
        self._stream.time_base = Fraction(1, PARAMETERS.ticks_a_second)
        self._stream.codec_context.time_base = self._stream.time_base
        self._stream.options = {"crf": str(PARAMETERS.quality), "preset": PARAMETERS.preset}

    def write(self, picture: NDArray[np.uint8], time_ns: int) -> None:
        """Add a picture; raises RecordingError for one of another size, or of an earlier time."""
        if picture.shape != self._shape:
            raise RecordingError("the pictures change their size: cut before that with --end")
        ticks = round((time_ns - self._begin_ns) * PARAMETERS.ticks_a_second / 1e9)
        if ticks <= self._latest:
            raise RecordingError(
                f"the frames go back in time at {time_ns}, where the clock was set: cut there with "
                "--start and --end"
            )
        self._latest = ticks
        height, width = picture.shape[:2]
        even = np.pad(picture, ((0, height % 2), (0, width % 2), (0, 0)), mode="edge")
        frame = av.VideoFrame.from_ndarray(np.ascontiguousarray(even), format="rgb24")
        frame.pts, frame.time_base = ticks, self._stream.time_base
        for packet in self._stream.encode(frame):
            self._container.mux(packet)

    def finish(self) -> None:
        """Write what the coder still holds."""
        for packet in self._stream.encode():
            self._container.mux(packet)
