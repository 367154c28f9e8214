"""How often an object is known falsely without images: recognition by movement, no trackers."""

from collections.abc import Callable, Sequence

import numpy as np
from inhand_tracker.recognition.parameters import DEFAULT_RECOGNITION

from inhand_lab.datasets.dataset import Dataset, DatasetError
from inhand_lab.people.joint_sequence import JointSequence
from inhand_lab.recognition.false_objects import IDLE_KINDS, IDLE_SEED, FalseObjects
from inhand_lab.recognition.movement_alone import participants_of, probabilities_over_time
from inhand_lab.training.recogniser_training import LearnedMovements, learn_movements
from inhand_lab.training.watched_people import UsualPoses, watch
from inhand_lab.workers import in_processes
from inhand_lab.world.idle_people import watch_idle

IDLE_PEOPLE = 10


def count_by_movement(
    dataset: Dataset,
    others: Dataset | None,
    unseen: Sequence[str],
    processes: int,
    on_progress: Callable[[], None] = lambda: None,
) -> FalseObjects:
    """Learn from a dataset's skeletons, and look at those of who does nothing of it.

    Each action of the dataset is left out once, and looked at in the ``unseen`` participants, who
    are left out too. ``on_progress`` is called once an action, and once before. Raises DatasetError
    or RecordingError.
    """
    people = [watch(dataset, entry) for entry in dataset.entries]
    actions = list(dict.fromkeys(one.action for one in people))
    unknown = set(unseen) - set(participants_of(people))
    if unknown:
        raise DatasetError(f"{dataset.folder} has no participant {min(unknown)!r}")
    learned = learn_movements(people, str(dataset.folder))
    idle: dict[str, float] = {
        kind: _mean_share(
            learned, [watch_idle(kind, number, IDLE_SEED) for number in range(IDLE_PEOPLE)]
        )
        for kind in IDLE_KINDS
    }
    strangers: dict[str, list[JointSequence]] = {}
    for entry in () if others is None else others.entries:
        if others is not None:
            strangers.setdefault(entry.interaction, []).append(watch(others, entry))
    elsewhere = {name: _mean_share(learned, some) for name, some in strangers.items()}
    on_progress()
    tasks = [(tuple(people), action, tuple(unseen)) for action in actions]
    shares = in_processes(_leave_action_out, tasks, processes, lambda _: on_progress())
    never_trained = dict(zip(actions, shares, strict=True))
    return FalseObjects(idle, elsewhere, never_trained, images=False, others_images=False)


def _leave_action_out(task: tuple[tuple[JointSequence, ...], str, tuple[str, ...]]) -> float:
    people, action, unseen = task
    taught = [one for one in people if one.action != action and one.participant not in unseen]
    learned = learn_movements(taught)
    return _mean_share(
        learned, [one for one in people if one.action == action and one.participant in unseen]
    )


def _mean_share(learned: LearnedMovements, people: Sequence[JointSequence]) -> float:
    """The mean share of frames in which an action is known."""
    usual = UsualPoses(learned.poses)
    shares = []
    for one in people:
        told, _ = probabilities_over_time(learned.movements, learned.temper, usual, one)
        likeliest = told[:, :-1].max(axis=1)
        shares.append((likeliest >= DEFAULT_RECOGNITION.recognised_probability).mean())
    return float(np.mean(shares))
