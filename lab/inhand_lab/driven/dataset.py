"""Datasets whose people moved before a real sensor and whose objects are simulated."""

import logging
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from inhand_tracker.geometry.arrays import Flags
from inhand_tracker.wire.conversion import joints_of

from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError
from inhand_lab.datasets.followed_people import follow_people
from inhand_lab.datasets.generation import Take, write_takes
from inhand_lab.datasets.joint_names import named_joints
from inhand_lab.datasets.recorded_frames import convention_of
from inhand_lab.datasets.recording_times import frame_rate_of
from inhand_lab.datasets.stretches import entry_frames
from inhand_lab.driven.recorded_body import RecordedBody, drive
from inhand_lab.sensing.cameras import KINECT, Camera
from inhand_lab.world.interactions import INTERACTIONS
from inhand_lab.world.messages import JOINT_STATES

FITTING = {
    "drawX": "paintWall",
    "baseballSwing": "hitGolfBall",
    "tennisSwing": "hitTennisBall",
    "tennisServe": "hitTennisBall",
    "armCurl": "liftWeights",
    "knock": "hammerNail",
}
"""The interaction whose object people may hold who mime an action of UTD-MHAD, by its name."""

LONGEST_GAP_S = 0.5
"""Time out of sight for which a body is made up, seconds; a longer gap ends the stretch."""

_NEEDED = "a body with all twenty joints is needed to hold things"

log = logging.getLogger(__name__)


class NobodyInSightError(DatasetError):
    """A recording shows nobody in any frame, or nobody whole."""


@dataclass(frozen=True)
class DrivenSettings:
    """Settings of a dataset of recorded movements with simulated objects.

    Without ``interactions`` each recording gets the objects that fit it. ``images`` leaves nothing
    out but pictures if it is false.
    """

    interactions: Collection[str] | None
    seed: int
    images: bool = True
    camera: Camera = KINECT


def generate_driven(
    folder: Path, bodies: Dataset, settings: DrivenSettings, on_progress: Callable[[], None]
) -> Dataset:
    """Write a dataset of every recorded movement with the object of every chosen interaction.

    ``on_progress`` is called once a recording. Raises DatasetError or RecordingError.
    """
    pairs = pairs_for(bodies, settings.interactions)
    return write_takes(
        folder,
        _takes(bodies, pairs, settings.seed, settings.camera),
        {
            "bodies": str(bodies.folder),
            "seed": settings.seed,
            "camera": settings.camera.name,
            "images": settings.images,
        },
        images=settings.images,
        on_progress=on_progress,
    )


def pairs_for(
    bodies: Dataset, interactions: Collection[str] | None
) -> Sequence[tuple[DatasetEntry, str]]:
    """Every recording with each interaction it is to drive; raises DatasetError without any."""
    pairs = [
        (entry, interaction)
        for entry in bodies.entries
        for interaction in (interactions or _fitting(entry))
    ]
    if not pairs:
        raise DatasetError(
            f"nothing fits what the people of {bodies.folder} do: choose with --interactions: "
            f"{', '.join(INTERACTIONS)}"
        )
    return pairs


def _fitting(entry: DatasetEntry) -> tuple[str, ...]:
    name = FITTING.get(entry.interaction, entry.interaction)
    return (name,) if name in INTERACTIONS else ()


def _takes(
    bodies: Dataset, pairs: Sequence[tuple[DatasetEntry, str]], seed: int, camera: Camera
) -> Iterator[Take]:
    """Yield a simulation of each pair; a recording that shows nobody is named and left out.

    Raises DatasetError where all of them do.
    """
    participants = sorted({entry.participant for entry in bodies.entries})
    nobody = None
    taken = False
    for entry, interaction in pairs:
        try:
            recorded = recorded_body(
                bodies,
                entry,
                participant=participants.index(entry.participant),
                recording=bodies.entries.index(entry),
            )
        except NobodyInSightError as error:
            log.warning("%s; it is left out", error)
            nobody = error
            continue
        taken = True
        name = f"{interaction}_{Path(entry.file).stem}"
        simulation = drive(recorded, interaction, seed, camera)
        yield Take(name, entry.participant, simulation, recorded.convention)
    if nobody is not None and not taken:
        raise nobody


def recorded_body(
    dataset: Dataset, entry: DatasetEntry, *, participant: int, recording: int
) -> RecordedBody:
    """Return the longest stretch of a recording in which somebody is in sight.

    Raises NobodyInSightError where nobody, or some joint, never is.
    """
    frames = entry_frames(dataset, entry)
    joints = np.full((len(frames), 20, 3), np.nan)
    states = np.zeros((len(frames), 20), np.uint8)
    confidences = np.zeros((len(frames), 20))
    for index, followed in enumerate(follow_people(frames)):
        person = followed.person
        if person is not None:
            joints[index] = joints_of(person)
            states[index] = [JOINT_STATES.index(state) for state in person.states]
            confidences[index] = person.confidences
    seen = np.asarray(np.isfinite(joints).all(axis=2))
    states[~seen] = JOINT_STATES.index("missing")
    confidences[~seen] = 0.0
    frame_rate = frame_rate_of(entry, np.array([frame.time_ns for frame in frames], np.int64))
    if not seen.any():
        raise NobodyInSightError(f"{entry.file} shows nobody: {_NEEDED}")
    stretch = _in_sight(seen, frame_rate)
    unseen = np.flatnonzero(~seen[stretch].any(axis=0)).tolist()
    if unseen:
        raise NobodyInSightError(f"{entry.file} never shows {named_joints(unseen)}: {_NEEDED}")
    return RecordedBody(
        joints[stretch],
        states[stretch],
        confidences[stretch],
        frame_rate,
        entry.handedness,
        participant,
        recording,
        convention_of(frames),
    )


def _in_sight(seen: Flags, frame_rate: float) -> slice:
    """The longest stretch of joints seen (T, 20) without a long gap; empty where none is."""
    there = np.flatnonzero(seen.any(axis=1))
    if len(there) == 0:
        return slice(0, 0)
    breaks = np.flatnonzero(np.diff(there) > LONGEST_GAP_S * frame_rate + 1)
    longest = max(np.split(there, breaks + 1), key=len)
    return slice(int(longest[0]), int(longest[-1]) + 1)
