"""A recording that is opened to be looked at: any frame of it, and all poses of its objects."""

from collections.abc import Callable, Mapping
from contextlib import ExitStack
from pathlib import Path

import numpy as np
from inhand_lab.datasets.frame_index import FrameIndex, cameras_of
from inhand_lab.datasets.tracks import Track
from inhand_runtime.recording import RecordingError
from inhand_runtime.recording.message_index import IndexedMessages, open_index
from inhand_schemas.messages import ObjectPose, Person
from inhand_schemas.topics import LABEL, POSE, RGBD, Topic
from inhand_tracker.geometry.arrays import Indices

from inhand_studio.picture import Picture

OnProgress = Callable[[float], bool]
"""Takes the share that is done, and returns whether to go on."""

_CLOCKS: tuple[Topic[ObjectPose], ...] = (LABEL, POSE)


class ReviewedRecording:
    """One camera of a recording, whose T frames were taken at ``times_ns`` (T,).

    Frames are those of its skeletons, or else of its pictures, labels or poses. Several threads may
    read at a time; everything raises RecordingError for damaged bytes.
    """

    def __init__(self, path: Path, camera: str | None = None) -> None:
        """Open the camera of that name, or the first.

        Raises RecordingError, and DatasetError for times that are no clock's.
        """
        self.path = path
        self._files = ExitStack()
        try:
            self._index = self._files.enter_context(open_index(path))
            self.note = self._index.note
            self.cameras = cameras_of(self._index)
            self.camera = camera or (self.cameras[0] if self.cameras else "")
            self._frames = FrameIndex(self._index, self.camera)
            self._pixels = self._index.messages(RGBD.stream, self.camera)
            self.times_ns = self._find_times()
            self.info = self._frames.camera_info()
            self.labels = self._poses_by_time(LABEL.stream)
            self.poses = self._poses_by_time(POSE.stream)
        except BaseException:
            self._files.close()
            raise

    def __len__(self) -> int:
        return len(self.times_ns)

    @property
    def objects(self) -> tuple[str, ...]:
        """The names of the objects that are labelled, or were tracked."""
        return tuple(sorted({*self.labels, *self.poses}))

    def picture(self, frame: int) -> Picture | None:
        """Read a frame's picture; None where it has none."""
        if len(self._frames):
            pixels = self._frames.pixels(frame)
        else:
            number = _numbers(self._pixels.stamps.captured_ns, int(self.times_ns[frame]))
            pixels = self._pixels[int(number[0])].frame() if len(number) else None
        return None if pixels is None else Picture(pixels, 0.0)

    def people(self, frame: int) -> tuple[Person, ...]:
        """Read who is in a frame."""
        return self._frames.skeletons(frame).people if len(self._frames) else ()

    def close(self) -> None:
        """Close the file."""
        self._files.close()

    def _find_times(self) -> Indices:
        if len(self._frames):
            return self._frames.times_ns
        if len(self._pixels):
            return self._pixels.stamps.captured_ns
        for topic in _CLOCKS:
            for name in sorted(self._index.counts(topic.stream)):
                times = self._index.messages(topic.stream, name).stamps.captured_ns
                if len(times):
                    return np.unique(times)
        raise RecordingError(
            f"{self.path} holds no skeletons, pictures, labels or poses: there is nothing to show"
        )

    def _poses_by_time(self, stream: str) -> dict[str, "PosesByTime"]:
        return {
            name: PosesByTime(self._index.messages(stream, name), self.camera)
            for name, count in self._index.counts(stream).items()
            if count
        }


class PosesByTime:
    """The poses, or labels, of one object in one camera of a recording."""

    def __init__(self, messages: IndexedMessages, camera: str) -> None:
        self._messages, self._camera = messages, camera

    def at(self, time_ns: int) -> list[ObjectPose]:
        """Read the poses in the frame of a time: of several people there may be several."""
        numbers = _numbers(self._messages.stamps.captured_ns, time_ns)
        read = [self._read(int(number)) for number in numbers]
        return [one for one in read if one is not None]

    def track(
        self, times_ns: Indices, people: Mapping[int, int], on_progress: OnProgress
    ) -> tuple[Track, dict[int, int]] | None:
        """Read the poses in the frames at ``times_ns`` (T,), and of whom they are, by frames.

        Of several in a frame it is that of the person who is in ``people``, or the first. None
        where ``on_progress`` stops it.
        """
        track, users = empty_poses(len(times_ns)), dict[int, int]()
        captured_ns = self._messages.stamps.captured_ns
        order = np.argsort(times_ns, kind="stable")
        places = np.searchsorted(times_ns, captured_ns, sorter=order)
        frames = order[np.minimum(places, len(times_ns) - 1)]
        known = times_ns[frames] == captured_ns
        for number in np.flatnonzero(known).tolist():
            if number % 256 == 0 and not on_progress(number / len(self._messages)):
                return None
            frame, pose = int(frames[number]), self._read(number)
            if pose is None or pose.camera_from_object is None:
                continue
            if frame in users and pose.person != people.get(frame, -1):
                continue
            track.translations[frame] = pose.camera_from_object.translation
            track.rotations[frame] = pose.camera_from_object.rotation
            users[frame] = -1 if pose.person is None else pose.person
        return track, users

    def _read(self, number: int) -> ObjectPose | None:
        """Read a pose; None where it is of another camera."""
        pose = self._messages[number].message()
        if not isinstance(pose, ObjectPose) or self._camera not in ("", pose.camera):
            return None
        return pose


def empty_poses(frames: int) -> Track:
    """Return a track without any pose, nor room for covariances, which take most of a track's."""
    return Track(np.full((frames, 3), np.nan), np.full((frames, 4), np.nan))


def _numbers(captured_ns: Indices, time_ns: int) -> Indices:
    """Return the numbers of the messages of a time."""
    return np.flatnonzero(captured_ns == time_ns)
