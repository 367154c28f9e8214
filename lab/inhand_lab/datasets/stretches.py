"""Stretches: parts of one long recording that stand for recordings where there is no other.

Learning compares recordings, and a test needs frames that nothing was learned from. Where there is
one recording only, it is cut into stretches of like numbers of labelled frames, with gaps between
them, as neighbouring frames are nearly the same.
"""

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np

from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError
from inhand_lab.datasets.parameters import DEFAULT_DATASET, DatasetParameters
from inhand_lab.datasets.recorded_frames import RecordedFrame, load_frames
from inhand_lab.datasets.recording_times import frame_rate_of


class RecordingStretch(DatasetEntry, frozen=True, kw_only=True):
    """The frames from ``first`` up to, and without, ``end`` of a recording."""

    first: int
    end: int

    def whole(self) -> DatasetEntry:
        """Return the entry of the whole recording."""
        return DatasetEntry(**_fields(self))


def entry_name(entry: DatasetEntry) -> str:
    """Name a recording by its file, and a stretch of one by its frames as well."""
    if isinstance(entry, RecordingStretch):
        return f"{entry.file}, frames {entry.first} to {entry.end - 1}"
    return entry.file


def entry_frames(dataset: Dataset, entry: DatasetEntry) -> list[RecordedFrame]:
    """Read the frames of a recording, or of a stretch of one, as ``load_frames`` does.

    They have the convention that the dataset names, if it names one.
    """
    frames = load_frames(dataset.path(entry), entry.object, entry.camera)
    if entry.convention is not None:
        frames = [replace(frame, convention=entry.convention) for frame in frames]
    if isinstance(entry, RecordingStretch):
        return frames[entry.first : entry.end]
    return frames


def stretches_of(
    dataset: Dataset,
    entry: DatasetEntry,
    least: int,
    parameters: DatasetParameters = DEFAULT_DATASET,
) -> tuple[RecordingStretch, ...]:
    """Cut a labelled recording into ``least`` stretches or more, with gaps between them.

    Raises DatasetError where it is too short.
    """
    frames = load_frames(dataset.path(entry), entry.object, entry.camera)
    if not frames:
        raise DatasetError(
            f"{entry.file} holds no skeletons: record it again with a body tracker, or take it "
            "out of dataset.toml"
        )
    usable = [index for index, frame in enumerate(frames) if frame.label and frame.people]
    rate = frame_rate_of(entry, np.array([frame.time_ns for frame in frames], np.int64))
    gap_s, shortest_s = parameters.stretch_gap_s, parameters.shortest_stretch_s
    fitting = int((len(usable) / rate + gap_s) / (shortest_s + gap_s))
    count = min(max(fitting, 0), parameters.most_stretches)
    if count < least:
        needed = least * shortest_s + (least - 1) * gap_s
        raise DatasetError(
            f"{entry.file} is the only recording, and {len(usable) / rate:.1f} s of it have label "
            f"and body: it would be cut into {least} stretches, which takes {needed:.0f} s; record "
            "longer, or add a recording"
        )
    margin = round(0.5 * gap_s * rate)
    edges = [len(usable) * number // count for number in range(count + 1)]
    return tuple(
        RecordingStretch(
            **_fields(entry),
            first=usable[edges[number]] + (margin if number else 0),
            end=usable[edges[number + 1] - 1] + 1 - (margin if number < count - 1 else 0),
        )
        for number in range(count)
    )


def _fields(entry: DatasetEntry) -> dict[str, Any]:
    return {name: getattr(entry, name) for name in DatasetEntry.__struct_fields__}


def stretches_note(entries: Iterable[DatasetEntry]) -> str:
    """Say that entries are stretches of one recording; empty where none is."""
    stretches = [entry for entry in entries if isinstance(entry, RecordingStretch)]
    if not stretches:
        return ""
    one = stretches[0]
    return (
        f"{one.file} is the only recording to learn from, and was cut into stretches: all that is "
        f"known is of one person ({one.participant}) in one take, and others are followed less well"
    )
