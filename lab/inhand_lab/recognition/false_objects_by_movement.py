"""Counts false objects without images: recognition by movement, no trackers."""

from collections.abc import Callable, Sequence

import numpy as np
from inhand_tracker.recognition.parameters import DEFAULT_RECOGNITION

from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.people.joint_sequence import JointSequence
from inhand_lab.recognition.false_objects import FalseObjectProtocol, FalseObjects
from inhand_lab.recognition.movement_alone import participants_of, probabilities_over_time
from inhand_lab.recognition.parameters import RecognitionEvaluationParameters
from inhand_lab.training.recogniser_training import LearnedMovements, learn_movements
from inhand_lab.training.recorded_movements import UsualPoses, read_joints
from inhand_lab.workers import in_processes
from inhand_lab.world.idle_people import watch_idle


def count_by_movement(
    protocol: FalseObjectProtocol, processes: int, on_progress: Callable[[], None] = lambda: None
) -> FalseObjects:
    """Learn from the dataset's skeletons, and count on those of who does nothing of it.

    ``on_progress`` is called once an action, and once before. Raises DatasetError or
    RecordingError.
    """
    people = [read_joints(protocol.dataset, entry) for entry in protocol.dataset.entries]
    _check_unseen(protocol, people)
    learned = learn_movements(people, str(protocol.dataset.folder))
    idle = _on_idle(learned, protocol.parameters)
    others = _on_others(learned, protocol)
    on_progress()
    actions = list(dict.fromkeys(one.action for one in people))
    tasks = [(tuple(people), action, protocol.unseen) for action in actions]
    shares = in_processes(_leave_action_out, tasks, processes, lambda _: on_progress())
    never_trained = dict(zip(actions, shares, strict=True))
    return FalseObjects(idle, others, never_trained, images=False, others_images=False)


def _check_unseen(protocol: FalseObjectProtocol, people: Sequence[JointSequence]) -> None:
    unknown = set(protocol.unseen) - set(participants_of(people))
    if unknown:
        raise DatasetError(f"{protocol.dataset.folder} has no participant {min(unknown)!r}")


def _on_idle(
    learned: LearnedMovements, parameters: RecognitionEvaluationParameters
) -> dict[str, float]:
    """Count on idle people, by what they do."""
    numbers = range(parameters.idle_people_by_movement)
    return {
        kind: _mean_share(
            learned, [watch_idle(kind, number, parameters.idle_seed) for number in numbers]
        )
        for kind in parameters.idle_kinds
    }


def _on_others(learned: LearnedMovements, protocol: FalseObjectProtocol) -> dict[str, float]:
    """Count on the people of another dataset, by their interaction."""
    if protocol.others is None:
        return {}
    strangers: dict[str, list[JointSequence]] = {}
    for entry in protocol.others.entries:
        strangers.setdefault(entry.interaction, []).append(read_joints(protocol.others, entry))
    return {name: _mean_share(learned, people) for name, people in strangers.items()}


def _leave_action_out(task: tuple[tuple[JointSequence, ...], str, tuple[str, ...]]) -> float:
    """Count on the unseen participants whose action nobody taught."""
    people, action, unseen = task
    taught = [one for one in people if one.action != action and one.participant not in unseen]
    tested = [one for one in people if one.action == action and one.participant in unseen]
    return _mean_share(learn_movements(taught), tested)


def _mean_share(learned: LearnedMovements, people: Sequence[JointSequence]) -> float:
    """Mean share of frames in which an action is recognised."""
    usual = UsualPoses(learned.poses)
    shares = []
    for one in people:
        over_time, _ = probabilities_over_time(learned.movements, learned.temper, usual, one)
        likeliest = over_time[:, :-1].max(axis=1)
        shares.append((likeliest >= DEFAULT_RECOGNITION.recognised_probability).mean())
    return float(np.mean(shares))
