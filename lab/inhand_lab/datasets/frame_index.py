"""Random access to the frames of one camera of a recording: its skeletons and its pixels.

A frame is a message of skeletons, as in ``recorded_frames``, and has the same number here. Nothing
but the recording's index is read until a frame is asked for.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

import numpy as np
from inhand_runtime.recording.message_index import IndexedMessages, RecordingIndex, open_index
from inhand_schemas.messages import CameraInfo, RgbdFrame, Skeletons
from inhand_schemas.topics import INFO, RGBD, SKELETONS, AnyTopic
from inhand_tracker.geometry.arrays import Indices

from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.datasets.frame_pixels import FrameMatcher
from inhand_lab.datasets.recording_times import check_times


class FrameStamp(NamedTuple):
    """The number and the time of a frame."""

    sequence: int
    time_ns: int


class FrameIndex:
    """The T frames of a camera of an open recording, at ``times_ns`` (T,).

    ``note`` says that the file was cut off, and the mend; it is None of a whole one.
    Several threads may read at a time. Reading raises RecordingError for damaged bytes.
    """

    def __init__(self, index: RecordingIndex, camera: str) -> None:
        """Index the frames; raises RecordingError, and DatasetError for times that are none."""
        self.path, self.camera, self.note = index.path, camera, index.note
        self._index = index
        self._skeletons = index.messages(SKELETONS.stream, camera)
        self._pixels = index.messages(RGBD.stream, camera)
        self.times_ns: Indices = self._skeletons.stamps.captured_ns
        check_times(index.path, self.times_ns)

    def __len__(self) -> int:
        return len(self.times_ns)

    @cached_property
    def stamps(self) -> list[FrameStamp]:
        """The number, its lowest 32 bits, and the time of each frame."""
        sequences = self._skeletons.stamps.sequences
        return [
            FrameStamp(*one) for one in zip(sequences.tolist(), self.times_ns.tolist(), strict=True)
        ]

    def skeletons(self, frame: int) -> Skeletons:
        """Read who is in a frame; raises MessageError too."""
        return SKELETONS.decode(self._skeletons[frame].payload)

    def pixels(self, frame: int) -> RgbdFrame | None:
        """Read the pixels of a frame, which ``pixels_of`` would yield with it; None without any."""
        number = int(self._pixel_numbers[frame])
        return None if number < 0 else self._pixels[number].frame()

    def camera_info(self) -> CameraInfo | None:
        """Read the first description of the camera; None without any."""
        infos = self._index.messages(INFO.stream, self.camera)
        return INFO.decode(infos[0].payload) if len(infos) else None

    def nearest(self, time_ns: int) -> int:
        """Return the number of the frame whose time is nearest; raises ValueError without any."""
        return int(np.argmin(np.abs(self.times_ns - time_ns)))

    def messages(self, stream: str, name: str) -> IndexedMessages:
        """Return the messages of another stream: labels or poses of an object, say."""
        return self._index.messages(stream, name)

    @cached_property
    def _pixel_numbers(self) -> Indices:
        """The number (T,) of the message with each frame's pixels; -1 where there is none."""
        numbers = np.full(len(self), -1, np.int64)
        stamps = self._pixels.stamps
        frames = _same(self.times_ns, stamps.captured_ns)
        if frames is not None:
            numbers[frames] = np.arange(len(frames))
            return numbers
        matcher = FrameMatcher(self.stamps)
        given = zip(stamps.sequences.tolist(), stamps.captured_ns.tolist(), strict=True)
        for number, stamp in enumerate(given):
            frame = matcher.match(FrameStamp(*stamp))
            if frame is not None:
                numbers[frame] = number
        return numbers


def _same(times_ns: Indices, captured_ns: Indices) -> Indices | None:
    """Return the frames (N,), of times (T,), of the same times as N pixels; None where one has none
    or either is not in order."""
    if not len(captured_ns) or (np.diff(times_ns) <= 0).any() or (np.diff(captured_ns) <= 0).any():
        return None
    frames = np.minimum(np.searchsorted(times_ns, captured_ns), len(times_ns) - 1)
    return frames if (times_ns[frames] == captured_ns).all() else None


def cameras_of(index: RecordingIndex) -> tuple[str, ...]:
    """Return the cameras of a recording with skeletons, or else those with pictures."""
    for topic in (SKELETONS, RGBD):
        if names := _named(index, topic):
            return names
    return ()


def _named(index: RecordingIndex, topic: AnyTopic) -> tuple[str, ...]:
    return tuple(sorted(name for name, count in index.counts(topic.stream).items() if count))


@contextmanager
def open_frames(path: Path, camera: str | None = None) -> Iterator[FrameIndex]:
    """Open a recording for random access to the frames of one camera while a block runs.

    The ``camera`` need not be named where one alone has skeletons. Raises RecordingError, and
    DatasetError where the camera is not to be had.
    """
    with open_index(path) as index:
        tracked = _named(index, SKELETONS)
        if not tracked and index.note is not None:
            raise DatasetError(f"{index.note}; it holds no skeletons")
        if not tracked:
            raise DatasetError(
                f"{path} holds no skeletons: `inhand recording skeletons` adds them from its "
                "pictures"
            )
        if camera is None and len(tracked) > 1:
            raise DatasetError(
                f"{path} has skeletons of {len(tracked)} cameras ({', '.join(tracked)}): choose one"
            )
        if camera is not None and camera not in tracked:
            raise DatasetError(
                f"{path} has no skeletons of camera {camera!r}: choose one of {', '.join(tracked)}"
            )
        yield FrameIndex(index, camera or tracked[0])
