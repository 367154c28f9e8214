"""One frame of a camera from messages to messages, without anybody who sends or receives them."""

from collections.abc import Collection, Iterator, Mapping, Sequence

from inhand_schemas.messages import CameraInfo, ObjectPose, Pose, RgbdFrame, Skeletons

from inhand_tracker.geometry.camera import intrinsics_of
from inhand_tracker.geometry.image import Image
from inhand_tracker.methods.registry import METHODS
from inhand_tracker.people.following import worth_publishing
from inhand_tracker.people.watching import CameraFrame, WatchedObject
from inhand_tracker.settings import TrackerSettings
from inhand_tracker.wire.conversion import Need, image_of
from inhand_tracker.wire.poses import SourceFrame, image_box, object_pose_message


def needs_of(settings: TrackerSettings) -> Collection[Need]:
    """Return what a tracker with these settings needs of a frame's pixels; nothing, of none."""
    method = METHODS[settings.method]
    terms = method.usual_terms if settings.likelihood is None else settings.likelihood
    return method.needs(terms)


def frame_image(
    frame: RgbdFrame | None, info: CameraInfo | None, needs: Collection[Need]
) -> Image | None:
    """Decode what is needed of a frame's pixels; None where they or the camera are not known.

    Raises MessageError for damaged pixels.
    """
    return None if frame is None or info is None else image_of(frame, info, needs)


def camera_frame(
    skeletons: Skeletons, image: Image | None, info: CameraInfo | None, effort: float = 1.0
) -> CameraFrame:
    """Put together what a frame is beside the people in it."""
    camera = None if info is None else intrinsics_of(info)
    return CameraFrame(skeletons.time_ns, image, camera, effort, skeletons.convention)


def source_of(
    skeletons: Skeletons,
    camera: str,
    info: CameraInfo | None,
    rig_from_camera: Pose | None = None,
) -> SourceFrame:
    """Say of which frame of a camera poses are; where it is says its info, if nobody else."""
    if rig_from_camera is None and info is not None:
        rig_from_camera = info.rig_from_camera
    return SourceFrame(skeletons.sequence, skeletons.time_ns, camera, rig_from_camera)


def pose_messages(
    objects: Mapping[int | None, Sequence[WatchedObject]], source: SourceFrame, frame: CameraFrame
) -> Iterator[ObjectPose]:
    """Write what is worth it of people's objects in a frame as messages."""
    for person, thing in worth_publishing(objects):
        yield object_pose_message(
            thing.estimate,
            source,
            name=thing.name,
            person=person,
            box=None if frame.camera is None else image_box(thing.outline, frame.camera),
            class_probabilities=thing.class_probabilities,
        )
