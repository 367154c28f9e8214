"""Brings labels together with the frames that they are of."""

from collections.abc import Collection, Sequence
from pathlib import Path

import numpy as np
from inhand_schemas.messages import ObjectPose, Skeletons

from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.datasets.recording_times import FrameNumbers


def join_labels(
    path: Path, labels: Sequence[ObjectPose], frames: Sequence[Skeletons]
) -> list[ObjectPose | None]:
    """Return the label of each frame, None where it has none.

    A label is of the frame that has its ``sequence``, and a time less than half a frame away: other
    programs round times. Raises DatasetError where most frames have none, and most labels no frame.
    """
    joined: list[ObjectPose | None] = [None] * len(frames)
    numbers = FrameNumbers(frames)
    strangers = []
    for label in labels:
        index = numbers.nearest(label)
        if index is None:
            strangers.append(label)
            continue
        other = joined[index]
        if other is None or numbers.apart_ns(index, other) >= numbers.apart_ns(index, label):
            joined[index] = label
    unlabelled = sum(label is None for label in joined)
    if 2 * len(strangers) > len(labels) and 2 * unlabelled > len(frames):
        raise DatasetError(
            f"{path}: {len(strangers)} of {len(labels)} labels of {labels[0].object!r} are of no "
            f"frame: {_difference(strangers, frames)}; write sequence and time_ns of the skeletons "
            "into their labels"
        )
    return joined


def check_objects(path: Path, object_name: str | None, labelled: Collection[str]) -> None:
    """Raise DatasetError where a recording's labels are all of other objects than its own."""
    if object_name is not None and labelled and object_name not in labelled:
        raise DatasetError(
            f"{path} holds labels of {', '.join(map(repr, sorted(labelled)))}, and "
            f"dataset.toml says object = {object_name!r}: give both the same name"
        )


def check_people(path: Path, labels: Sequence[ObjectPose], frames: Sequence[Skeletons]) -> None:
    """Raise DatasetError where a label names a person whom no frame shows."""
    shown = {person.id for frame in frames for person in frame.people}
    named = {label.person for label in labels if label.person is not None}
    if shown and named - shown:
        raise DatasetError(
            f"{path}: labels name person {min(named - shown)}, and the skeletons have "
            f"{', '.join(map(str, sorted(shown)))}: write the id of whoever uses the object"
        )


def _difference(labels: Sequence[ObjectPose], frames: Sequence[Skeletons]) -> str:
    """Say how labels differ from the frames that are nearest in time."""
    if not frames:
        return "there are no skeletons"
    times = np.array([frame.time_ns for frame in frames])
    nearest = [int(np.argmin(np.abs(times - label.time_ns))) for label in labels]
    later_ns = np.median(
        [label.time_ns - times[i] for label, i in zip(labels, nearest, strict=True)]
    )
    further = np.median(
        [label.sequence - frames[i].sequence for label, i in zip(labels, nearest, strict=True)]
    )
    time = "at its time" if later_ns == 0 else f"{abs(later_ns) / 1e6:g} ms away"
    number = "has the same sequence" if further == 0 else f"differs by {further:+g} in sequence"
    return f"the nearest frame is {time} and {number}, in the median"
