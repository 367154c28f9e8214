"""Evaluates recognition by movement alone on the people of another dataset, as of another sensor.

Beside frames in which the right action is known, and those with a wrong one, it counts false
objects: before anybody has moved, of idle people, of the actions that were left out of training,
and of people who do what nobody taught.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from inhand_schemas.joints import Joint
from inhand_tracker.geometry.arrays import Array, Flags, Indices
from inhand_tracker.recognition.recogniser import MovementRecogniser
from inhand_tracker.recognition.recognition import recognised_action

from inhand_lab.datasets.dataset import Dataset, DatasetError
from inhand_lab.people.joint_sequence import JointSequence
from inhand_lab.recognition.movement_alone import participants_of
from inhand_lab.recognition.parameters import (
    DEFAULT_RECOGNITION_EVALUATION,
    RecognitionEvaluationParameters,
)
from inhand_lab.training.recogniser_training import LearnedMovements, learn_movements
from inhand_lab.training.recorded_movements import UsualPoses, read_bodies, read_joints
from inhand_lab.workers import in_processes
from inhand_lab.world.idle_people import watch_idle

IDLE, LEFT_OUT, OTHERS, MIMED = "idle", "left out of training", "never trained", "taught"
UNKNOWN = -1
"""The number that stands for no action."""
FEWEST_ACTIONS = 3
"""Number of actions from which on one can be left out: recognition compares two at the least."""
_ARMS = (Joint.ELBOW_LEFT, Joint.WRIST_LEFT, Joint.ELBOW_RIGHT, Joint.WRIST_RIGHT)


@dataclass(frozen=True)
class TransferTask:
    """Who teaches, and who is tested, of which ``kind``; an action ``without`` is not taught."""

    kind: str
    taught: tuple[JointSequence, ...]
    tested: tuple[JointSequence, ...]
    without: str | None = None


@dataclass(frozen=True)
class KnownFrames:
    """Numbers of frames of recordings of one kind and action: all, those with the right action
    known and with a wrong one, those before somebody moved, and of these those with any known."""

    kind: str
    action: str
    frames: int
    right: int
    wrong: int
    still: int
    known_still: int

    @property
    def percent(self) -> tuple[float, float, float]:
        """Percent of frames with the right action, and a wrong one, and of still ones with any."""
        return (
            100.0 * self.right / max(self.frames, 1),
            100.0 * self.wrong / max(self.frames, 1),
            100.0 * self.known_still / max(self.still, 1),
        )


def together(counts: Sequence[KnownFrames]) -> KnownFrames:
    """Add up counts of one kind."""
    numbers = np.array([(c.frames, c.right, c.wrong, c.still, c.known_still) for c in counts])
    return KnownFrames(counts[0].kind, "all", *map(int, numbers.sum(axis=0)))


def recognise_others(
    dataset: Dataset,
    others: Dataset,
    taught_by: Sequence[str],
    never_trained: Dataset | None,
    processes: int,
    on_progress: Callable[[], None] = lambda: None,
) -> list[KnownFrames]:
    """Learn from a dataset, and from the participants ``taught_by`` of another one, whose other
    participants are tested.

    ``on_progress`` is called once for each of ``transfer_steps``. Raises DatasetError or
    RecordingError.
    """
    people = [read_joints(dataset, entry) for entry in dataset.entries]
    unlike = [read_joints(others, entry) for entry in others.entries]
    if unknown := set(taught_by) - set(participants_of(unlike)):
        raise DatasetError(f"{others.folder} has no participant {min(unknown)!r}")
    # Participants of both datasets may have the same names.
    people += [
        replace(one, participant=f"other {one.participant}")
        for one in unlike
        if one.participant in taught_by
    ]
    actions = {one.action for one in people}
    tested = [one for one in unlike if one.participant not in taught_by and one.action in actions]
    if not tested:
        raise DatasetError(f"nobody in {others.folder} does what {dataset.folder} teaches")
    strangers = (
        []
        if never_trained is None
        else [read_joints(never_trained, entry) for entry in never_trained.entries]
    )
    tasks = _tasks(tuple(people), tested, strangers)
    done = in_processes(_count_in_task, tasks, processes, lambda _: on_progress())
    return [count for counts in done for count in counts]


def transfer_steps(dataset: Dataset, others: Dataset) -> int:
    """Number of times that something is learned."""
    taught = set(dataset.interactions())
    return 1 if len(taught) < FEWEST_ACTIONS else 1 + len(taught & set(others.interactions()))


def _tasks(
    people: tuple[JointSequence, ...],
    tested: Sequence[JointSequence],
    strangers: Sequence[JointSequence],
) -> list[tuple[TransferTask, ...]]:
    """What is tested together, because it is learned together."""
    parameters = DEFAULT_RECOGNITION_EVALUATION
    actions = {one.action for one in people}
    untaught = tuple(one for one in strangers if one.action not in actions)
    tasks: list[tuple[TransferTask, ...]] = [
        (
            TransferTask(MIMED, people, tuple(tested)),
            TransferTask(IDLE, people, _idle_people(parameters)),
            TransferTask(OTHERS, people, untaught),
        )
    ]
    if len(actions) < FEWEST_ACTIONS:
        return tasks
    for action in dict.fromkeys(one.action for one in tested):
        theirs = tuple(one for one in [*tested, *strangers] if one.action == action)
        tasks.append((TransferTask(LEFT_OUT, people, theirs, without=action),))
    return tasks


def _idle_people(parameters: RecognitionEvaluationParameters) -> tuple[JointSequence, ...]:
    return tuple(
        watch_idle(kind, number, parameters.idle_seed)
        for kind in parameters.idle_kinds
        for number in range(parameters.idle_people_by_movement)
    )


def _count_in_task(tasks: tuple[TransferTask, ...]) -> list[KnownFrames]:
    first = tasks[0]
    learned = learn_movements([one for one in first.taught if one.action != first.without])
    return [count for task in tasks for count in _count_by_action(learned, task)]


def _count_by_action(learned: LearnedMovements, task: TransferTask) -> list[KnownFrames]:
    usual = UsualPoses(learned.poses)
    counts = []
    for action in dict.fromkeys(one.action for one in task.tested):
        number = learned.actions.index(action) if action in learned.actions else UNKNOWN - 1
        ours = [one for one in task.tested if one.action == action]
        answers = [(_answers(learned, usual, one), still_frames(one.joints)) for one in ours]
        known = np.concatenate([some for some, _ in answers])
        still = np.concatenate([flags for _, flags in answers])
        counts.append(
            KnownFrames(
                task.kind,
                action,
                len(known),
                int((known == number).sum()),
                int(((known != number) & (known != UNKNOWN)).sum()),
                int(still.sum()),
                int((still & (known != UNKNOWN)).sum()),
            )
        )
    return counts


def _answers(learned: LearnedMovements, usual: UsualPoses, one: JointSequence) -> Indices:
    """The known action (T,) of each frame, or UNKNOWN, also where no body is seen."""
    running = MovementRecogniser(learned.movements, learned.temper)
    answers = np.full(len(one.joints), UNKNOWN, np.int64)
    for frame, body in enumerate(read_bodies(one, usual)):
        if body is not None:
            known = recognised_action(running.step(int(one.times_ns[frame]), body)[:-1])
            answers[frame] = UNKNOWN if known is None else known
    return answers


def still_frames(joints: Array, moved_m: float = DEFAULT_RECOGNITION_EVALUATION.moved_m) -> Flags:
    """Frames (T,) of joints (T, 20, 3) before an elbow or wrist has moved against the hips."""
    arms = joints[:, list(_ARMS)] - joints[:, None, Joint.HIP_CENTER]
    seen = np.flatnonzero(np.isfinite(arms).all(axis=(1, 2)))
    if not len(seen):
        return np.ones(len(joints), bool)
    moved = np.linalg.norm(arms - arms[seen[0]], axis=2) > moved_m
    return np.asarray(~np.logical_or.accumulate(moved.any(axis=1)))
