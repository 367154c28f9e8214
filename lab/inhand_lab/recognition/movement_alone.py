"""Recognition without objects or images: which action is it, of people that were left out?"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.recognition.movement_classes import MovementClasses
from inhand_tracker.recognition.recogniser import MovementRecogniser, Recogniser

from inhand_lab.datasets.dataset import Dataset, DatasetError
from inhand_lab.people.joint_sequence import JointSequence
from inhand_lab.training.recogniser_training import recogniser_of
from inhand_lab.training.watched_people import UsualPoses, read_bodies, watch
from inhand_lab.workers import in_processes


@dataclass(frozen=True)
class Recognised:
    """One recording: the true action and, of N frames, what each way of recognition says (N,).

    ``probabilities`` (N, K + 1) are those over time, of the actions and, last, of none.
    """

    action: int
    participant: str
    by_pose: Indices
    probabilities: Array

    @property
    def by_movement(self) -> Indices:
        """(N,): the likeliest action up to each frame, none being no answer here."""
        return np.argmax(self.probabilities[:, :-1], axis=1)

    @property
    def sequence(self) -> int:
        """The action of the whole recording: the likeliest on average, none being no answer."""
        actions = self.probabilities[:, :-1]
        return int(np.argmax((actions / actions.sum(axis=1, keepdims=True)).mean(axis=0)))


@dataclass(frozen=True)
class RecognitionAlone:
    """All recordings, each recognised by what the other participants teach."""

    actions: tuple[str, ...]
    recordings: tuple[Recognised, ...]

    def confusion(self, *, sequences: bool) -> Array:
        """(K, K): of each true action (row) the shares that are taken for each, 0 to 1."""
        counts = np.zeros((len(self.actions), len(self.actions)))
        for one in self.recordings:
            answers = np.array([one.sequence]) if sequences else one.by_movement
            counts[one.action] += np.bincount(answers, minlength=len(self.actions))
        return counts / np.maximum(counts.sum(axis=1, keepdims=True), 1.0)

    def summary(self) -> dict[str, float]:
        """Accuracies in percent: of frames by pose, of frames over time, of sequences."""
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
    """Leave one participant out; ``on_progress`` is called once a participant.

    Raises DatasetError or RecordingError.
    """
    people = tuple(watch(dataset, entry) for entry in dataset.entries)
    actions = tuple(dict.fromkeys(one.action for one in people))
    participants = participants_of(people)
    if len(participants) < 3:
        raise DatasetError(
            f"{dataset.folder} has {len(participants)} participants, and three are the least: two "
            "teach what the third is judged by"
        )
    tasks = [(people, participant) for participant in participants]
    done = in_processes(_leave_out, tasks, processes, lambda _: on_progress())
    return RecognitionAlone(actions, tuple(one for found in done for one in found))


def participants_of(people: Sequence[JointSequence]) -> list[str]:
    """Their names, in order."""
    return sorted({one.participant for one in people})


def probabilities_over_time(
    movements: MovementClasses, temper: float, usual: UsualPoses, one: JointSequence
) -> tuple[Array, Array]:
    """Probabilities (N, K + 1) of a recording's frames with a body, and its body poses (N, 60).

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


def _recognise(recogniser: Recogniser, one: JointSequence) -> Recognised:
    usual = UsualPoses(recogniser.body_poses)
    probabilities, poses = probabilities_over_time(
        recogniser.movements, recogniser.temper, usual, one
    )
    by_pose = np.argmax(recogniser.svm.probabilities(poses), axis=1)
    action = recogniser.actions.index(one.action)
    return Recognised(action, one.participant, by_pose, probabilities)


def _leave_out(task: tuple[tuple[JointSequence, ...], str]) -> list[Recognised]:
    people, participant = task
    # In the order of all actions, whoever is left out.
    order = list(dict.fromkeys(one.action for one in people))
    others = sorted(
        (one for one in people if one.participant != participant),
        key=lambda one: order.index(one.action),
    )
    recogniser = recogniser_of(others)
    if recogniser.actions != tuple(order):
        raise DatasetError(f"only {participant} does some of {', '.join(order)}")
    return [_recognise(recogniser, one) for one in people if one.participant == participant]
