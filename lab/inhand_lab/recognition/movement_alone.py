"""Evaluates recognition by movement alone, without objects or images, on people left out."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.recognition.movement_classes import MovementClasses
from inhand_tracker.recognition.recogniser import MovementRecogniser, Recogniser

from inhand_lab.datasets.dataset import Dataset, DatasetError
from inhand_lab.people.joint_sequence import JointSequence
from inhand_lab.training.recogniser_training import learn_recogniser
from inhand_lab.training.recorded_movements import UsualPoses, read_bodies, read_joints
from inhand_lab.workers import in_processes


@dataclass(frozen=True)
class RecognisedRecording:
    """What is recognised in N frames of a recording, beside the true ``action``.

    ``by_pose`` (N,) are the actions by the body pose alone; ``probabilities`` (N, K + 1) are those
    over time, of the actions and, last, of none.
    """

    action: int
    participant: str
    by_pose: Indices
    probabilities: Array

    @property
    def by_movement(self) -> Indices:
        """The likeliest action (N,) up to each frame; none is no answer here."""
        return np.argmax(self.probabilities[:, :-1], axis=1)

    @property
    def sequence(self) -> int:
        """The likeliest action of the whole recording on average; none is no answer here."""
        actions = self.probabilities[:, :-1]
        return int(np.argmax((actions / actions.sum(axis=1, keepdims=True)).mean(axis=0)))


@dataclass(frozen=True)
class RecognitionAlone:
    """All recordings, each recognised by what the other participants teach."""

    actions: tuple[str, ...]
    recordings: tuple[RecognisedRecording, ...]

    def confusion(self, *, sequences: bool) -> Array:
        """Shares (K, K) of each true action (row) that are taken for each action, 0 to 1."""
        counts = np.zeros((len(self.actions), len(self.actions)))
        for one in self.recordings:
            answers = np.array([one.sequence]) if sequences else one.by_movement
            counts[one.action] += np.bincount(answers, minlength=len(self.actions))
        return counts / np.maximum(counts.sum(axis=1, keepdims=True), 1.0)

    def summary(self) -> dict[str, float]:
        """Shares in percent that are right: frames by pose, frames over time, sequences."""
        poses = np.concatenate([one.by_pose == one.action for one in self.recordings])
        movements = np.concatenate([one.by_movement == one.action for one in self.recordings])
        whole = [one.sequence == one.action for one in self.recordings]
        return {
            "frames_by_pose_percent": 100.0 * float(poses.mean()),
            "frames_percent": 100.0 * float(movements.mean()),
            "sequences_percent": 100.0 * float(np.mean(whole)),
        }


def recognise_alone(
    dataset: Dataset, processes: int, on_progress: Callable[[], None] = lambda: None
) -> RecognitionAlone:
    """Leave each participant out once; ``on_progress`` is called once a participant.

    Raises DatasetError or RecordingError.
    """
    people = tuple(read_joints(dataset, entry) for entry in dataset.entries)
    actions = tuple(dict.fromkeys(one.action for one in people))
    participants = participants_of(people)
    if len(participants) < 3:
        raise DatasetError(
            f"{dataset.folder} has {len(participants)} participants, and three are the least: two "
            "teach what the third is judged by"
        )
    tasks = [(people, participant) for participant in participants]
    done = in_processes(_leave_out, tasks, processes, lambda _: on_progress())
    return RecognitionAlone(actions, tuple(one for recordings in done for one in recordings))


def participants_of(people: Sequence[JointSequence]) -> list[str]:
    """Return the names of the participants, in order."""
    return sorted({one.participant for one in people})


def probabilities_over_time(
    movements: MovementClasses, temper: float, usual: UsualPoses, one: JointSequence
) -> tuple[Array, Array]:
    """Return probabilities (N, K + 1) of the frames with a body, and these bodies' poses (N, 60).

    Raises DatasetError where no body is seen.
    """
    running = MovementRecogniser(movements, temper)
    probabilities, poses = [], []
    for time_ns, body in zip(one.times_ns, read_bodies(one, usual), strict=True):
        if body is not None:
            probabilities.append(running.step(int(time_ns), body))
            poses.append(body.pose)
    if not poses:
        raise DatasetError(f"a recording of {one.participant} ({one.action}) shows no body")
    return np.array(probabilities), np.array(poses)


def _recognise(recogniser: Recogniser, one: JointSequence) -> RecognisedRecording:
    usual = UsualPoses(recogniser.body_poses)
    probabilities, poses = probabilities_over_time(
        recogniser.movements, recogniser.temper, usual, one
    )
    by_pose = np.argmax(recogniser.svm.probabilities(poses), axis=1)
    action = recogniser.actions.index(one.action)
    return RecognisedRecording(action, one.participant, by_pose, probabilities)


def _leave_out(task: tuple[tuple[JointSequence, ...], str]) -> list[RecognisedRecording]:
    people, participant = task
    # In the order of all actions, whoever is left out.
    order = list(dict.fromkeys(one.action for one in people))
    others = sorted(
        (one for one in people if one.participant != participant),
        key=lambda one: order.index(one.action),
    )
    recogniser = learn_recogniser(others)
    if recogniser.actions != tuple(order):
        raise DatasetError(f"only {participant} does some of {', '.join(order)}")
    return [_recognise(recogniser, one) for one in people if one.participant == participant]
