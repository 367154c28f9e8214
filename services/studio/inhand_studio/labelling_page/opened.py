"""A recording as the labelling page looks at it: any frame of one camera, without a scan.

Frames are the camera's skeletons, by which keyframes are counted. Where a recording has none, they
are its pictures: these can be looked at, and not labelled.
"""

from collections.abc import Sequence
from contextlib import ExitStack, suppress
from functools import lru_cache
from pathlib import Path

import numpy as np
from inhand_lab.datasets.frame_index import FrameIndex, cameras_of
from inhand_lab.labelling.equal_poses import Pose
from inhand_lab.labelling.keyframes import LabellingError
from inhand_lab.labelling.scene import joints_between
from inhand_runtime.recording.message_index import open_index
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import ObjectPose, Person, RgbdFrame
from inhand_schemas.topics import LABEL, RGBD
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.image import Image
from inhand_tracker.wire.conversion import image_of, joints_of

IMAGES_KEPT = 4
"""Decoded images that stay in memory: a person goes to and fro."""


class OpenedRecording:
    """One camera of a recording; ``notes`` say what it lacks, ``times_ns`` (T,) when its frames
    were taken."""

    def __init__(self, path: Path, camera: str | None = None) -> None:
        """Open the camera of that name, or the first; raises RecordingError, LabellingError, and
        DatasetError for times that are none."""
        self.path = path
        self._files = ExitStack()
        try:
            self._index = self._files.enter_context(open_index(path))
            self.cameras = cameras_of(self._index)
            self._open_camera(camera)
        except BaseException:
            self._files.close()
            raise

    def _open_camera(self, camera: str | None) -> None:
        if not self.cameras:
            raise LabellingError(f"{self.path} holds no skeletons and no pictures: choose another")
        if camera is not None and camera not in self.cameras:
            raise LabellingError(
                f"{self.path} has no camera {camera!r}: choose one of {', '.join(self.cameras)}"
            )
        self.camera = camera or self.cameras[0]
        self.frames = FrameIndex(self._index, self.camera)
        self._pixels = self._index.messages(RGBD.stream, self.camera)
        self.info = self.frames.camera_info()
        alone = not len(self.frames)
        self.times_ns = self._pixels.stamps.captured_ns if alone else self.frames.times_ns
        self.image = lru_cache(IMAGES_KEPT)(self._read_image)
        self._all_joints: Array | None = None
        self.notes = tuple(self._find_notes())

    def __len__(self) -> int:
        """Return the number of frames."""
        return len(self.times_ns)

    @property
    def unlabelled_because(self) -> str | None:
        """Why its frames cannot be labelled; None where they can."""
        if self._index.note is not None:
            return f"{self._index.note}. It can be looked at, and labelled when it is whole."
        if not len(self.frames):
            return (
                "It has no skeletons, by which labels are counted: `inhand recording skeletons "
                f"{self.path}` adds them from its pictures."
            )
        if self.info is None:
            return f"It lacks the info of camera {self.camera}: `inhand recording repair` adds it."
        return None

    @property
    def several_cameras(self) -> bool:
        return len(self.cameras) > 1

    def has_labels(self, object_name: str) -> bool:
        """Whether the recording holds labels of an object already."""
        return self._index.counts(LABEL.stream).get(object_name, 0) > 0

    def label(self, object_name: str, frame: int) -> Pose | None:
        """Return the pose of a label that the recording holds already; None without one.

        Raises RecordingError.
        """
        labels = self._index.messages(LABEL.stream, object_name)
        number = labels.captured_at(int(self.times_ns[frame]))
        label = None if number is None else labels[number].message()
        if not isinstance(label, ObjectPose) or label.camera_from_object is None:
            return None
        if label.time_ns != self.times_ns[frame] or label.camera != self.camera:
            return None
        pose = label.camera_from_object
        return np.array(pose.translation), np.array(pose.rotation)

    def people(self, frame: int) -> tuple[Person, ...]:
        """Return everybody whom the camera saw in a frame; raises RecordingError."""
        return self.frames.skeletons(frame).people if len(self.frames) else ()

    def joints(self, frames: Sequence[int]) -> Array:
        """Return the joints (T, 20, 3) of whom labels are about in some frames, NaN where missing.

        Where several people are seen, who that is depends on all frames before. Raises
        RecordingError, and DatasetError for bodies that are not in metres.
        """
        if self._all_joints is None:
            seen = [self.people(frame) for frame in frames]
            if any(len(people) > 1 for people in seen):
                self._all_joints = joints_between(self.frames, 0, len(self) - 1)
        if self._all_joints is not None:
            return np.asarray(self._all_joints[list(frames)])
        nobody = np.full((20, 3), np.nan)
        return np.array([joints_of(people[0]) if people else nobody for people in seen])

    def close(self) -> None:
        """Close the file."""
        self._files.close()

    def _read_image(self, frame: int) -> Image | None:
        """Return a frame's image, grey and coloured, and its depth; None where it has none, or a
        damaged one. Raises RecordingError."""
        if self.info is None:
            return None
        with suppress(MessageError):
            pixels = self._pixels_of(frame)
            if pixels is not None:
                return image_of(pixels, self.info, ("edges", "colour", "depth"))
        return None

    def _pixels_of(self, frame: int) -> RgbdFrame | None:
        if len(self.frames):
            return self.frames.pixels(frame)
        return self._pixels[frame].frame()

    def _find_notes(self) -> list[str]:
        notes = [] if self.unlabelled_because is None else [self.unlabelled_because]
        if not self._pixels:
            notes.append("It has no pictures: the object is placed against the skeleton alone.")
        elif self.info is not None and not self._has_depth():
            notes.append(
                "It has no depth: nothing is placed by clicks, brought to the image or assisted; "
                "the rest works."
            )
        return notes

    def _has_depth(self) -> bool:
        """Whether the first picture has depth."""
        return RGBD.decode(self._pixels[0].payload).depth is not None
