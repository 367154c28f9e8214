"""Which images of two streams belong together, by their times, and the frames that they make."""

from collections.abc import Sequence
from typing import Literal

import numpy as np
from inhand_schemas.messages import ColourImage, DepthImage, RgbdFrame

FARTHEST_NS = 20_000_000
"""Nanoseconds between colour and depth of one frame at the most: that of TUM's ``associate.py``."""
USUAL_RATE = 30.0
"""Rate in hertz that is said of a camera where nothing shows it."""

Times = tuple[int, int]
Stream = Literal["colour", "depth"]


def nearest_partners(times: list[int], others: list[int]) -> list[int]:
    """Return, for each time, its partner of ``others``, which rise, or -1.

    The nearest pairs are made first, and each is in one pair at the most. Nanoseconds.
    """
    pairs = []
    rising = np.array(others, np.int64)
    for place, time_ns in enumerate(times):
        first = int(np.searchsorted(rising, time_ns - FARTHEST_NS))
        last = int(np.searchsorted(rising, time_ns + FARTHEST_NS, side="right"))
        pairs += [(abs(others[n] - time_ns), place, n) for n in range(first, last)]
    partners, taken = [-1] * len(times), set[int]()
    for _, place, number in sorted(pairs):
        if partners[place] < 0 and number not in taken:
            partners[place] = others[number]
            taken.add(number)
    return partners


def paired_frames(colour: list[int], depth: list[int]) -> list[Times]:
    """Return each frame by the times of its colour and depth in nanoseconds, -1 for what it lacks.

    Depth that belongs to no colour is left out where there is any colour. Both lists rise.
    """
    if not colour:
        return [(-1, time_ns) for time_ns in depth]
    return list(zip(colour, nearest_partners(colour, depth), strict=True))


def frame_rate(frames: Sequence[Times]) -> float:
    """Return the usual rate of frames in hertz."""
    steps = np.diff([max(frame) for frame in frames])
    usual = float(np.median(steps)) if len(steps) else 0.0
    return 1e9 / usual if usual > 0.0 else USUAL_RATE


class FrameAssembler:
    """Makes frames of images that come one by one; each frame is made when its last image came."""

    def __init__(self, frames: Sequence[Times]) -> None:
        self._frame_of: dict[tuple[str, int], Times] = {}
        for frame in frames:
            for stream, time_ns in zip(("colour", "depth"), frame, strict=True):
                if time_ns >= 0:
                    self._frame_of[stream, time_ns] = frame
        self._waiting: dict[Times, dict[str, ColourImage | DepthImage | None]] = {}
        self.made = 0

    def wants(self, stream: Stream, time_ns: int) -> bool:
        """Whether an image belongs to a frame."""
        return (stream, time_ns) in self._frame_of

    def put(
        self, stream: Stream, time_ns: int, image: ColourImage | DepthImage | None
    ) -> RgbdFrame | None:
        """Add an image that is wanted, None for one that cannot be read, and return the frame that
        it completes; a frame without any image is none."""
        frame = self._frame_of.pop((stream, time_ns))
        images = self._waiting.setdefault(frame, {})
        images[stream] = image
        if len(images) < sum(time >= 0 for time in frame):
            return None
        del self._waiting[frame]
        colour, depth = images.get("colour"), images.get("depth")
        if colour is None and depth is None:
            return None
        assert not isinstance(colour, DepthImage)
        assert not isinstance(depth, ColourImage)
        self.made += 1
        return RgbdFrame(
            sequence=self.made - 1,
            time_ns=frame[0] if frame[0] >= 0 else frame[1],
            time_uncertainty_ns=abs(frame[0] - frame[1]) if min(frame) >= 0 else 0,
            colour=colour,
            depth=depth,
        )
