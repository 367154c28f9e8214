"""Brings the pixels of a recording together with the frames that they are of."""

from collections.abc import Iterator, Sequence
from pathlib import Path

from inhand_schemas.messages import RgbdFrame

from inhand_lab.datasets.recorded_frames import RecordedFrame, iterate_pixels
from inhand_lab.datasets.recording_times import FrameNumbers


def pixels_of(
    path: Path, frames: Sequence[RecordedFrame], camera: str | None = None
) -> Iterator[tuple[int, RgbdFrame]]:
    """Yield frames' numbers, in order, with the pixels that one camera took of them, or any did.

    Pixels are of the frame that has their ``time_ns``, or their ``sequence`` and a time less than
    half a frame away. Pixels of no frame are left out, and so is a second image of one frame.
    Raises RecordingError.
    """
    numbers = FrameNumbers(frames)
    by_time = {frame.time_ns: number for number, frame in enumerate(frames)}
    last = -1
    for pixels in iterate_pixels(path, camera):
        number = by_time.get(pixels.time_ns, numbers.nearest(pixels))
        if number is not None and number > last:
            last = number
            yield number, pixels
