"""Brings the pixels of a recording together with the frames that they are of."""

from collections.abc import Iterator, Sequence
from pathlib import Path

from inhand_schemas.messages import RgbdFrame

from inhand_lab.datasets.recorded_frames import iterate_pixels
from inhand_lab.datasets.recording_times import FrameNumbers, Stamped


class FrameMatcher:
    """Matches pixels to frames, in the order in which they were recorded.

    Pixels are of the frame that has their ``time_ns``, or their ``sequence`` and a time less than
    half a frame away. Pixels of no frame are left out, and so is a second image of one frame.
    """

    def __init__(self, frames: Sequence[Stamped]) -> None:
        self._numbers = FrameNumbers(frames)
        self._by_time = {frame.time_ns: number for number, frame in enumerate(frames)}
        self._last = -1

    def match(self, pixels: Stamped) -> int | None:
        """Return the number of the frame of the next pixels; None where they are left out."""
        number = self._by_time.get(pixels.time_ns)
        if number is None:
            number = self._numbers.nearest(pixels)
        if number is None or number <= self._last:
            return None
        self._last = number
        return number


def pixels_of(
    path: Path, frames: Sequence[Stamped], camera: str | None = None
) -> Iterator[tuple[int, RgbdFrame]]:
    """Yield frames' numbers, in order, with the pixels that one camera took of them, or any did.

    Which these are ``FrameMatcher`` says. Raises RecordingError.
    """
    matcher = FrameMatcher(frames)
    for pixels in iterate_pixels(path, camera):
        number = matcher.match(pixels)
        if number is not None:
            yield number, pixels
