"""What is to be exported, and what all formats ask of a recording."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from inhand_recorder.conversion import Selection
from inhand_recorder.recorded import Recorded, RecordedImages
from inhand_recorder.recording_reader import Recording
from inhand_recorder.recording_series import Series
from inhand_runtime.recording import RecordingError
from inhand_schemas.errors import MessageError
from inhand_schemas.keys import Site, parse_key
from inhand_schemas.messages import CameraInfo, ObjectPose, Pose
from inhand_schemas.topics import LABEL, POSE, RGBD, AnyTopic


@dataclass(frozen=True)
class ExportRequest:
    """What of an open recording is exported, by whole ``keys`` and the selection's times.

    ``camera`` and ``object`` choose one of several; ``objects`` is a folder with a folder for each
    object, in which its mesh is. ``on_message`` is called for each message that was read.
    """

    recording: Recording
    keys: tuple[str, ...]
    selection: Selection
    camera: str | None = None
    object: str | None = None
    objects: Path | None = None
    on_message: Callable[[], None] = lambda: None

    def read(self, keys: tuple[str, ...] | None = None) -> Iterator[Recorded]:
        """Yield the messages of some keys, or all, in the order of reception."""
        chosen = self.keys if keys is None else keys
        times = {"start_ns": self.selection.start_ns, "end_ns": self.selection.end_ns}
        for one in self.recording.read(*chosen, **times) if chosen else ():
            yield one
            self.on_message()

    def of(self, *topics: AnyTopic) -> tuple[str, ...]:
        """Return the keys of some streams."""
        return tuple(key for key in self.keys if self.recording.keys[key] in topics)

    def require_one_rig(self) -> Site:
        """Return the rig whose messages these are; raises RecordingError where they are several."""
        sites = {parse_key(key).site for key in self.keys}
        if len(sites) > 1:
            shown = " and ".join(sorted(f"{one.realm}/@v1/{one.rig}" for one in sites))
            raise RecordingError(f"these are of several rigs, {shown}: --include 'REALM/@v1/RIG/*'")
        return sites.pop()

    def frames_of_one_camera(self) -> tuple[str, CameraInfo, Iterator[RecordedImages]]:
        """Return a camera with its info and frames; raises RecordingError where that is not one,
        or its info is missing."""
        self.require_one_rig()
        cameras = {parse_key(key).name: key for key in self.of(RGBD)}
        name = _chosen("camera", cameras, self.camera)
        info = self.recording.info_of(cameras[name])
        if info is None:
            raise RecordingError(
                f"there is no info of {name}: `inhand recording repair` adds it from another file"
            )
        frames = (one for one in self.read((cameras[name],)) if isinstance(one, RecordedImages))
        return name, info, frames

    def poses_of_one_object(self) -> "FramePoses | None":
        """Return the poses of an object, of its labels where there are any; None without both.

        Raises RecordingError where there are several objects.
        """
        labels, poses = self.of(LABEL), self.of(POSE)
        keys = {parse_key(key).name: key for key in (*poses, *labels)}
        if not keys and self.object is None:
            return None
        return FramePoses(self.recording[keys[_chosen("object", keys, self.object)]])

    def poses_of_objects(self) -> list["FramePoses"]:
        """Return the poses of all objects, or the chosen one, of labels where there are any."""
        keys = {parse_key(key).name: key for key in (*self.of(POSE), *self.of(LABEL))}
        if self.object is not None:
            keys = {self.object: keys[_chosen("object", keys, self.object)]}
        return [FramePoses(self.recording[key]) for key in keys.values()]


class FramePoses:
    """Poses of an object by the frames that they are of."""

    def __init__(self, series: Series) -> None:
        self._series = series
        self.key = series.key
        self.object = series.key.rpartition("/")[2]

    @property
    def source(self) -> str:
        """The topic that they come from, ``label/mug`` or ``pose/mug``."""
        return self._series.topic

    def of_frame(self, camera: str, time_ns: int) -> ObjectPose | None:
        """Return the pose that was measured in a frame of a camera; None where there is none, it is
        damaged, or of another camera."""
        try:
            found = self._series.nearest(time_ns, within_ns=0)
        except (RecordingError, MessageError):
            return None
        if found is None or not isinstance(found.message, ObjectPose):
            return None
        return found.message if found.message.camera == camera else None

    def transform(self, camera: str, time_ns: int) -> Pose | None:
        """Return camera_from_object in a frame of a camera; None where the object is lost too."""
        message = self.of_frame(camera, time_ns)
        return None if message is None else message.camera_from_object


def _chosen(what: str, names: "dict[str, str]", wish: str | None) -> str:
    there = ", ".join(sorted(names)) or "none"
    if wish is not None and wish not in names:
        raise RecordingError(f"there is no {what} {wish!r}; there are: {there}")
    if wish is None and len(names) != 1:
        raise RecordingError(f"choose one {what} with --{what}; there are: {there}")
    return wish if wish is not None else next(iter(names))
