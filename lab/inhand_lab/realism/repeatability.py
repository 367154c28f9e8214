"""Measures how nearly a body pose comes back, in the same person and in others.

``python -m inhand_lab.realism.repeatability DATASET`` shows the median distance, in body heights
over all joints, from a body pose to the nearest one when the person does the same again, and to
the nearest one of five other people: how exact a skeleton tracker is, and how alike people move.
"""

import argparse
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from inhand_tracker.body.skeleton import (
    body_pose,
    mirror_joints,
    pelvis_basis,
    stature_of,
)
from inhand_tracker.geometry.arrays import Array
from rich.console import Console
from rich.table import Table
from scipy.spatial.distance import cdist

from inhand_lab.datasets.dataset import Dataset, DatasetEntry, load_dataset
from inhand_lab.datasets.labelled_sequence import labelled_sequence
from inhand_lab.datasets.recorded_frames import load_frames
from inhand_lab.datasets.tracks import true_joints
from inhand_lab.realism.parameters import DEFAULT_REALISM


@dataclass(frozen=True)
class BodyPoseSequence:
    """Body poses b (T, 60) of a recording's frames whose joints are all seen, and their times
    (T,) in seconds."""

    participant: str
    seconds: Array
    bodies: Array


def body_pose_sequence(
    participant: str, frame_rate: float, handedness: str, joints: Array
) -> BodyPoseSequence:
    """Measure the body poses of joints (T, 20, 3) in metres; left-handed people are mirrored."""
    whole = np.isfinite(joints).all(axis=(1, 2))
    seen = joints[whole]
    if handedness == "left":
        seen = mirror_joints(seen)
    bodies = body_pose(seen, pelvis_basis(seen), stature_of(seen))
    return BodyPoseSequence(participant, np.flatnonzero(whole) / frame_rate, bodies)


def return_distance(recordings: Sequence[BodyPoseSequence]) -> float:
    """Median distance to the same person's nearest pose, the mean over recordings.

    That is one of another recording, or earlier or later in this one where there is no other.
    """
    return float(np.mean([np.median(np.linalg.norm(one, axis=1)) for one in _returns(recordings)]))


def return_distance_by_joint(recordings: Sequence[BodyPoseSequence]) -> Array:
    """Median distance of each joint (20,) between the poses that are nearest as a whole."""
    medians = []
    for returned in _returns(recordings):
        by_joint = np.linalg.norm(returned.reshape(len(returned), -1, 3), axis=2)
        medians.append(np.median(by_joint, axis=0))
    return np.asarray(np.mean(medians, axis=0))


def _returns(recordings: Sequence[BodyPoseSequence]) -> Iterator[Array]:
    """Yield, for each recording, how its poses (T, 60) differ from the person's nearest other."""
    for one in recordings:
        rest = [r for r in recordings if r.participant == one.participant and r is not one]
        others = np.concatenate([r.bodies for r in rest]) if rest else one.bodies
        distances = cdist(one.bodies, others)
        if not rest:
            distances[np.abs(one.seconds[:, None] - one.seconds) < DEFAULT_REALISM.again_s] = np.inf
        yield one.bodies - others[distances.argmin(axis=1)]


def distance_to_others(recordings: Sequence[BodyPoseSequence]) -> float:
    """Median distance to the nearest pose in first recordings of others, the mean over recordings.

    Five other people are compared with at the most.
    """
    firsts = {r.participant: r for r in reversed(recordings)}
    medians = []
    for one in recordings:
        others = [firsts[name].bodies for name in sorted(firsts) if name != one.participant]
        distances = cdist(one.bodies, np.concatenate(others[: DEFAULT_REALISM.others]))
        medians.append(np.median(distances.min(axis=1)))
    return float(np.mean(medians))


def main() -> None:
    """Show how nearly poses come back, by interaction."""
    parser = argparse.ArgumentParser(
        prog="python -m inhand_lab.realism.repeatability", description=__doc__
    )
    parser.add_argument("dataset", type=Path, metavar="DATASET")
    dataset = load_dataset(parser.parse_args().dataset)
    table = Table("interaction", "joints", "done again", "five others")
    for name in dict.fromkeys(entry.interaction for entry in dataset.entries):
        entries = [entry for entry in dataset.entries if entry.interaction == name]
        sequences = [labelled_sequence(dataset, entry) for entry in entries]
        measured = [sequence.joints for sequence in sequences]
        true = [_true_joints(dataset, entry) for entry in entries]
        for kind, joints in (("measured", measured), ("true", true)):
            if all(np.isfinite(one).all(axis=(1, 2)).any() for one in joints):
                recordings = [
                    body_pose_sequence(
                        entry.participant, sequence.frame_rate, entry.handedness, one
                    )
                    for entry, sequence, one in zip(entries, sequences, joints, strict=True)
                ]
                distances = return_distance(recordings), distance_to_others(recordings)
                table.add_row(name, kind, *(f"{distance:.3f}" for distance in distances))
    Console().print(table)


def _true_joints(dataset: Dataset, entry: DatasetEntry) -> Array:
    return true_joints(load_frames(dataset.path(entry), entry.object, entry.camera))


if __name__ == "__main__":
    main()
