"""Bodies of other skeletons' recordings, from what a file holds to our joints in a dataset."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from inhand_runtime.wording import counted
from inhand_schemas.fields import MOST_PEOPLE
from inhand_schemas.joints import Joint
from inhand_schemas.messages import Message, Person, Skeletons
from inhand_tracker.geometry.arrays import Array, Indices

from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError
from inhand_lab.datasets.dataset_writer import DatasetWriter
from inhand_lab.datasets.parameters import DEFAULT_DATASET
from inhand_lab.importers.body_checks import Mends, check_bodies
from inhand_lab.importers.body_times import frames_at_rate
from inhand_lab.importers.joint_tables import (
    MISSING,
    JointMean,
    JointSets,
    JointTable,
    forward_directions,
    our_joints,
)
from inhand_lab.importers.messages import imagined_camera
from inhand_lab.importers.parameters import DEFAULT_IMPORT
from inhand_lab.importers.sources import NobodyError, ReadFiles, without_zeros
from inhand_lab.world.messages import JOINT_STATES


@dataclass(frozen=True)
class ForeignBody:
    """One body of a file: the index of its frame, its id there, and its joints.

    ``places`` (J, 3) are metres in OpenCV's camera frame; those that are not finite are missing,
    whatever ``states`` (J,) say: 0 missing, 1 inferred, 2 tracked; ``confidences`` (J,).
    """

    frame: int
    id: int
    places: Array
    states: Array
    confidences: Array


@dataclass(frozen=True)
class Bodies:
    """A recording of N bodies in T frames.

    ``times_ns`` (T,), and of each body the index of its frame (N,), the person's id (N,), and
    ``joints`` of N bodies, whose places are those of a ``convention``.
    """

    path: Path
    times_ns: Indices
    frames: Indices
    ids: Indices
    joints: JointSets
    convention: str

    def kept(self, frames: Indices) -> "Bodies":
        """Return the recording of these frames alone."""
        places = np.full(len(self.times_ns), -1)
        places[frames] = np.arange(len(frames))
        chosen = places[self.frames] >= 0
        owners, joints = places[self.frames[chosen]], self.joints.chosen(chosen)
        return replace(
            self,
            times_ns=self.times_ns[frames],
            frames=owners,
            ids=self.ids[chosen],
            joints=joints,
        )


def our_bodies(
    path: Path,
    table: JointTable,
    times_ns: Indices,
    bodies: Sequence[ForeignBody],
    mends: Mends,
) -> Bodies:
    """Turn a file's bodies into ours; people are numbered from 0 as they come into view.

    Bodies without a joint are left out. Raises NobodyError where no frame shows anybody, and
    DatasetError for ids that say nothing and bodies that cannot be meant.
    """
    shown = [body for body in map(_without_far, bodies) if _is_seen(body)]
    if not shown:
        raise NobodyError(f"{path} has no frame with a body")
    _check_ids(path, shown)
    places = without_zeros(np.array([body.places for body in shown]), _origin(table))
    seen = np.isfinite(places).all(axis=2)
    theirs = JointSets(
        places,
        np.where(seen, np.array([body.states for body in shown], np.uint8), MISSING),
        np.array([body.confidences for body in shown]),
    )
    joints = our_joints(table, theirs)
    ours = np.asarray((joints.states != MISSING).any(axis=1))  # a nose alone is no joint of ours
    if not ours.any():
        raise NobodyError(f"{path} has no frame with a body")
    check_bodies(path, table, joints.places, forward_directions(table, theirs), mends)
    frames = np.array([body.frame for body in shown])
    numbers: dict[int, int] = {}
    ids = np.array([numbers.setdefault(body.id, len(numbers)) for body in shown])
    shown_joints = joints.chosen(ours)
    return Bodies(path, times_ns, frames[ours], ids[ours], shown_joints, table.convention)


def write_bodies(
    files: ReadFiles[Bodies], folder: Path, rate: float, generator: Mapping[str, str]
) -> Dataset:
    """Write recordings whose frames tell their times as a dataset, about ``rate`` frames a second.

    They are named by their files, and so are their participants and interactions. Raises
    DatasetError or InhandError.
    """
    writer = DatasetWriter(folder)
    for bodies in files.recordings:
        stem = bodies.path.stem
        entry = DatasetEntry(file=recording_file(bodies), interaction=stem, participant=stem)
        kept = bodies.kept(frames_at_rate(bodies.path, bodies.times_ns, rate))
        writer.add_recording(entry, body_messages(kept))
    files.report()
    return writer.finish(generator)


def recording_file(bodies: Bodies) -> str:
    """Return the path in a dataset of what was a file of bodies."""
    return f"recordings/{bodies.path.stem}.mcap"


def body_messages(bodies: Bodies) -> Iterator[Message]:
    """Give the messages of a recording of bodies: a camera that is imagined, and skeletons."""
    where = f"imagined: {bodies.path.name} does not say how its camera sees"
    yield imagined_camera(int(bodies.times_ns[0]), where, _frame_rate(bodies.times_ns))
    people: list[list[Person]] = [[] for _ in bodies.times_ns]
    for body, frame in enumerate(bodies.frames):
        people[frame].append(_person(bodies, body))
    for sequence, time_ns in enumerate(bodies.times_ns.tolist()):
        yield Skeletons(
            sequence=sequence,
            time_ns=time_ns,
            people=tuple(people[sequence]),
            convention=bodies.convention,
        )


def _frame_rate(times_ns: Indices) -> float | None:
    """Return the usual rate of frames in Hz; None where their times show none that can be."""
    if len(times_ns) < 2:
        return None
    rate = 1e9 / float(np.median(np.diff(times_ns)))
    return rate if rate <= DEFAULT_DATASET.fastest_hz else None


def _person(bodies: Bodies, body: int) -> Person:
    states = bodies.joints.states[body]
    seen = states != MISSING
    places = np.where(seen[:, None], bodies.joints.places[body], 0.0)
    confidences = np.where(seen, bodies.joints.confidences[body], 0.0)
    return Person(
        id=int(bodies.ids[body]),
        joints=tuple((x, y, z) for x, y, z in places.tolist()),
        states=tuple(JOINT_STATES[state] for state in states),
        confidences=tuple(confidences.tolist()),
    )


def _origin(table: JointTable) -> int:
    """Return the place in a convention of the joint that others may be relative to."""
    (first, *_) = table.candidates[Joint.HIP_CENTER]
    if not isinstance(first, JointMean):
        raise TypeError(f"{table.name}: HipCenter is no mean of joints")
    return table.joints.index(max(first.weights, key=first.weights.__getitem__))


def _without_far(body: ForeignBody) -> ForeignBody:
    """Take joints that are farther away than any unit explains, or no numbers, as missing."""
    near = np.asarray((np.abs(body.places) <= DEFAULT_IMPORT.farthest_m).all(axis=1))
    places = np.where(near[:, None], body.places, np.nan)
    return replace(body, places=places, states=np.where(near, body.states, MISSING))


def _is_seen(body: ForeignBody) -> bool:
    """Whether a body has a joint; trackers write zeros of nobody."""
    return bool((body.states != MISSING).any()) and bool(body.places.any())


def _check_ids(path: Path, bodies: Sequence[ForeignBody]) -> None:
    ids_by_frame: dict[int, set[int]] = {}
    for body in bodies:
        ids = ids_by_frame.setdefault(body.frame, set())
        if body.id in ids:
            raise DatasetError(
                f"{path}: two bodies in frame {body.frame} have the id {body.id}: record it with "
                "tracking on, so that ids tell people apart"
            )
        ids.add(body.id)
        if len(ids) > MOST_PEOPLE:
            raise DatasetError(
                f"{path}: frame {body.frame} has more than {counted(MOST_PEOPLE, 'body', 'bodies')}"
                ": split it by people"
            )
