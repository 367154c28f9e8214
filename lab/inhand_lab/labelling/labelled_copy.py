"""Writes the labels of an object into a recording beside the original."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from inhand_runtime.recording import RecordedMessage, RecordingError, read_recording
from inhand_runtime.recording.copying import (
    copy_message,
    copy_metadata,
    write_beside,
    written_or_gone,
)
from inhand_runtime.recording.message_index import open_index
from inhand_schemas.keys import parse_key
from inhand_schemas.messages import ObjectPose
from inhand_schemas.topics import LABEL, SKELETONS
from inhand_tracker.geometry.arrays import Array, Flags
from inhand_tracker.geometry.estimate import LOST, Estimate
from inhand_tracker.wire.poses import SourceFrame, object_pose_message

from inhand_lab.labelling.scene import Scene

LABELLED_SUFFIX = ".labelled.mcap"


@dataclass(frozen=True)
class Labels:
    """Poses camera_from_object of T frames, (T, 3) and (T, 4), NaN where there is none.

    ``absent`` (T,) flags frames without the object. ``covariances`` (T, 6, 6) are of a translation
    and of a rotation vector on the left, NaN where unknown; None where they are nowhere known.
    """

    translations: Array
    rotations: Array
    absent: Flags
    covariances: Array | None = None

    @property
    def given(self) -> Flags:
        """Flags (T,) of the frames that have a pose."""
        return np.isfinite(self.translations[:, 0])


def labelled_path(path: Path) -> Path:
    """Return the name of the copy of a recording that holds its labels."""
    return path.with_name(path.name.removesuffix(".mcap") + LABELLED_SUFFIX)


def require_labels_wanted(
    scene: Scene, object_name: str, output: Path, *, replace: bool = False
) -> None:
    """Raise RecordingError where an object has labels already that are not to be replaced, the copy
    is there, or its folder is not: before the work that makes others."""
    if not output.parent.is_dir():
        raise RecordingError(f"{output.parent} is no folder: make it, or choose another one")
    if output.exists():
        raise RecordingError(f"{output} exists already: choose another name, or move it away")
    if not replace and _has_labels(scene.path, object_name):
        raise RecordingError(
            f"{scene.path} has labels of {object_name} already: add --replace to write others "
            "instead"
        )


def write_labels(
    scene: Scene, object_name: str, labels: Labels, output: Path, about: Mapping[str, str]
) -> None:
    """Write a scene's recording with labels of an object to the new file ``output``.

    Labels that the object has are left out. ``about`` says where the others are from. Raises
    RecordingError.
    """
    messages = _messages(scene, object_name, labels)
    with written_or_gone(output) as writer:
        number = 0
        for recorded in read_recording(scene.path, apart=True):
            copied = recorded.topic is not LABEL or recorded.name != object_name
            if copied or recorded.apart:
                copy_message(writer, recorded)
            if recorded.apart:
                continue
            if recorded.topic is SKELETONS and recorded.name == scene.camera:
                label, number = messages[number], number + 1
                if label is not None:
                    write_beside(writer, _key(recorded, object_name), recorded, LABEL.encode(label))
        copy_metadata(writer, scene.path, "labels", {"source": scene.path.name, **about})


def _has_labels(path: Path, object_name: str) -> bool:
    with open_index(path) as index:
        return index.counts(LABEL.stream).get(object_name, 0) > 0


def _key(of: RecordedMessage, object_name: str) -> str:
    return LABEL.key(parse_key(of.key).site, object_name)


def _messages(scene: Scene, object_name: str, labels: Labels) -> list[ObjectPose | None]:
    """Return the label of each frame; None where nothing is known."""
    given = labels.given
    messages: list[ObjectPose | None] = []
    for index, frame in enumerate(scene.frames):
        if not given[index] and not labels.absent[index]:
            messages.append(None)
            continue
        source = SourceFrame(
            frame.sequence, frame.time_ns, scene.camera, scene.info.rig_from_camera
        )
        estimate = _estimate(labels, index) if given[index] else LOST
        messages.append(
            object_pose_message(estimate, source, name=object_name, person=scene.people[index])
        )
    return messages


def _estimate(labels: Labels, index: int) -> Estimate:
    covariance = None if labels.covariances is None else labels.covariances[index]
    if covariance is not None and not np.isfinite(covariance).all():
        covariance = None
    return Estimate("tracked", 1.0, labels.translations[index], labels.rotations[index], covariance)
