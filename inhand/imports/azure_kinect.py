"""Recordings of an Azure Kinect: Matroska files of the Azure Kinect SDK's recorder and viewer.

As the SDK's ``record.cpp`` writes them: tracks ``COLOR`` (MJPG, NV12, YUY2 or BGRA), ``DEPTH`` and
``IR`` (``b16g``, 16 bits big-endian, depth in millimetres), and the factory's calibration as the
attachment ``calibration.json``. Depth is in the depth camera's own view; it is aligned to colour.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import Any

import av
import cv2
import numpy as np
from inhand_lab.datasets.dataset import START_NS
from inhand_runtime.errors import InhandError
from inhand_runtime.pixels import decode_colour, encode_colour, encode_depth
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import CameraInfo, ColourImage, DepthImage
from inhand_schemas.topics import INFO, RGBD

from inhand.imports.alignment import DepthAlignment
from inhand.imports.foreign import ForeignMessage, LeftOut, explaining
from inhand.imports.kinect_calibration import aligned_views
from inhand.imports.pairing import FrameAssembler, Stream, Times, frame_rate, paired_frames
from inhand.progress import progress_bar

CALIBRATION_FILE = "calibration.json"
PERCENT = 100
_TRACKS: dict[str, Stream] = {"COLOR": "colour", "DEPTH": "depth"}
_COLOURS = {
    "NV12": cv2.COLOR_YUV2RGB_NV12,
    "YUY2": cv2.COLOR_YUV2RGB_YUY2,
    "BGRA": cv2.COLOR_BGRA2RGB,
}
"""Formats of colour that are not JPEG, and what makes RGB of them."""
_SHAPES = {"NV12": (1.5, 1), "YUY2": (1, 2), "BGRA": (1, 4)}
"""Rows of bytes a row of pixels, and bytes a pixel in them."""
_DEPTH_FORMAT = "b16g"


@dataclass
class KinectRecording:
    """An open recording: its tracks, the frames by the times of their images in nanoseconds, and
    how the camera sees. ``align`` makes the depth camera's images the colour camera's, None where
    one of them is alone; ``clock`` says whether the file says when it was begun."""

    container: Any
    tracks: dict[Stream, Any]
    frames: list[Times]
    begin_ns: int
    clock: bool
    info: CameraInfo
    align: DepthAlignment | None
    left_out: LeftOut = field(default_factory=LeftOut)

    @property
    def about(self) -> dict[str, str]:
        """What the file says of the device and its recorder."""
        tags = {name.lower(): value for name, value in self.container.metadata.items()}
        kept = ("encoder", "creation_time", "k4a_color_firmware_version")
        return {name: tags[name] for name in kept if name in tags}

    def messages(self, camera: str) -> Iterator[ForeignMessage]:
        """Yield the camera's info and its frames, each when its last image was taken.

        Raises InhandError where no frame can be read.
        """
        assembler, latest_ns = FrameAssembler(self.frames), self.info.time_ns
        yield ForeignMessage(INFO, camera, self.info, latest_ns)
        for stream, time_ns, data, _ in _images(self.container, self.tracks, self.begin_ns):
            latest_ns = max(latest_ns, time_ns)
            if not assembler.wants(stream, time_ns):
                continue
            frame = assembler.put(stream, time_ns, self._image(stream, data))
            if frame is not None:
                yield ForeignMessage(RGBD, camera, frame, latest_ns)
        if not assembler.made:
            raise InhandError(f"no frame of it can be read: {self.left_out.reason}")

    def _image(self, stream: Stream, data: bytes) -> ColourImage | DepthImage | None:
        track = self.tracks[stream]
        size = track.width, track.height
        try:
            if stream == "colour":
                return _colour(data, track.codec_context.codec_tag, *size)
            depth = _depth(data, *size)
            return encode_depth(depth if self.align is None else self.align(depth))
        except InhandError as error:
            self.left_out.add(f"{stream}: {error}")
            return None


@contextmanager
def open_kinect(path: Path) -> Iterator[KinectRecording]:
    """Open a recording and read the times of its images; raises InhandError for what is none."""
    with explaining(f"{path} is no Matroska file that can be read"):
        container = av.open(str(path), metadata_errors="replace")
    with container:
        yield _plan(path, container)


def _plan(path: Path, container: Any) -> KinectRecording:
    named = {track.metadata.get("title"): track for track in container.streams.video}
    tracks = {stream: named[name] for name, stream in _TRACKS.items() if name in named}
    if not tracks:
        raise InhandError(
            f"{path} is no recording of an Azure Kinect: it has no track COLOR or DEPTH"
        )
    _check_formats(path, tracks)
    calibration = _calibration(path, container)
    sizes = {stream: (track.width, track.height) for stream, track in tracks.items()}
    begin_ns = _begin_ns(container.metadata.get("creation_time"))
    times: dict[Stream, set[int]] = {"colour": set(), "depth": set()}
    begin = START_NS if begin_ns is None else begin_ns
    with progress_bar("percent of the file's times", PERCENT) as advance:
        done = 0
        for stream, time_ns, data, place in _images(container, tracks, begin):
            times[stream].add(time_ns)
            while done < PERCENT and (place + len(data)) * PERCENT > done * container.size:
                done += 1
                advance()
    frames = paired_frames(sorted(times["colour"]), sorted(times["depth"]))
    if not frames:
        raise InhandError(f"{path} has no image")
    try:
        info, align = aligned_views(
            calibration, sizes.get("colour"), sizes.get("depth"), max(frames[0]), frame_rate(frames)
        )
    except InhandError as error:
        raise InhandError(f"{path}, {CALIBRATION_FILE}: {error}") from None
    return KinectRecording(container, tracks, frames, begin, begin_ns is not None, info, align)


def _check_formats(path: Path, tracks: dict[Stream, Any]) -> None:
    for stream, track in tracks.items():
        known = (_DEPTH_FORMAT,) if stream == "depth" else ("MJPG", *_COLOURS)
        codec = track.codec_context
        if (found := "an unknown format" if codec is None else codec.codec_tag) not in known:
            raise InhandError(f"{path}: {stream} in {found!r} is not read, only {', '.join(known)}")


def _calibration(path: Path, container: Any) -> bytes:
    for attached in container.streams.attachments:
        if attached.name == CALIBRATION_FILE and attached.data:
            return bytes(attached.data)
    raise InhandError(
        f"{path} has no {CALIBRATION_FILE} attached, without which nothing can be measured"
    )


def _begin_ns(text: str | None) -> int | None:
    """Return when a recording was begun, in nanoseconds since the epoch."""
    if text is None:
        return None
    try:
        return round(datetime.fromisoformat(text).timestamp()) * 1_000_000_000
    except ValueError:
        return None


def _images(
    container: Any, tracks: dict[Stream, Any], begin_ns: int
) -> Iterator[tuple[Stream, int, bytes, int]]:
    """Yield what track an image is of, when it was taken, its bytes, and where they are in the
    file, from its begin.

    A file that was cut off ends with its last whole image; raises InhandError for a damaged one.
    """
    of_track = {track.index: stream for stream, track in tracks.items()}
    with explaining("the file is damaged"):
        container.seek(0)
        packets = container.demux(list(tracks.values()))
    while True:
        with explaining("the file is damaged"):
            packet = next(packets, None)
        if packet is None:
            return
        if packet.pts is not None and packet.size > 0:
            time_ns = begin_ns + int(packet.pts * packet.time_base * 1_000_000_000)
            yield of_track[packet.stream.index], time_ns, bytes(packet), packet.pos or 0


def _colour(data: bytes, code: str, width: int, height: int) -> ColourImage:
    """Return an image; a JPEG stays as it is."""
    if code == "MJPG":
        try:
            image = ColourImage("jpeg", width, height, data)
            decode_colour(image)
        except (ValueError, MessageError) as error:
            raise InhandError(str(error)) from None
        return image
    rows, deep = _SHAPES[code]
    shape = int(rows * height), width, deep
    if len(data) != np.prod(shape):
        raise InhandError(f"{len(data):,} bytes are no image in {code} of {width} × {height}")
    pixels = np.frombuffer(data, np.uint8).reshape(shape if deep > 1 else shape[:2])
    return encode_colour(np.asarray(cv2.cvtColor(pixels, _COLOURS[code]), np.uint8))


def _depth(data: bytes, width: int, height: int) -> "np.ndarray[Any, np.dtype[np.uint16]]":
    if len(data) != 2 * width * height:
        raise InhandError(f"{len(data):,} bytes are no depth of {width} × {height}")
    return np.frombuffer(data, ">u2").reshape(height, width).astype(np.uint16)
