"""How often an object is known falsely with images: the whole `cascade`, as a rig runs it."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.methods.object_tracker import ObjectTracker
from inhand_tracker.methods.registry import DEFAULT_METHOD, new_tracker
from inhand_tracker.model.model import Model
from inhand_tracker.recognition.cascade import Cascade
from inhand_tracker.recognition.movement_classes import MovementClasses
from inhand_tracker.recognition.presence import Presence

from inhand_lab.datasets.dataset import Dataset, DatasetEntry
from inhand_lab.datasets.observations import Observation, observe, observe_simulation
from inhand_lab.datasets.recorded_frames import has_images, load_frames
from inhand_lab.people.joint_sequence import JointSequence
from inhand_lab.recognition.false_objects import IDLE_KINDS, IDLE_SEED, FalseObjects
from inhand_lab.recognition.protocol import answers_together, labelled_entries, learn_models
from inhand_lab.recognition.scores import UNKNOWN
from inhand_lab.training.presence_training import NEEDS, Look, look_around, presence_of
from inhand_lab.training.recogniser_training import learn_movements
from inhand_lab.training.watched_people import watch
from inhand_lab.workers import in_processes
from inhand_lab.world.idle_people import simulate_idle

IDLE_PEOPLE = 1
"""Of each kind, for each unseen participant other ones."""


@dataclass(frozen=True)
class _Found:
    """The share of a recording's frames in which an object is known falsely; ``kind`` is a field
    of FalseObjects."""

    kind: str
    name: str
    share: float


def count_with_images(
    dataset: Dataset,
    others: Dataset | None,
    unseen: Sequence[str],
    processes: int,
    on_progress: Callable[[], None] = lambda: None,
) -> FalseObjects:
    """For each of the ``unseen`` learn from the dataset's other participants, and look at people.

    Each action is left out once, and looked at in the unseen one. Idle people and the recordings
    of ``others`` are dealt out among what is learned. ``on_progress`` is called once a
    participant. Raises DatasetError or RecordingError.
    """
    tasks = [(dataset, others, tuple(unseen), number) for number in range(len(unseen))]
    done = in_processes(_leave_person_out, tasks, processes, lambda _: on_progress())
    found = [one for some in done for one in some]
    return FalseObjects(
        _means(found, "idle"),
        _means(found, "others"),
        _means(found, "never_trained"),
        images=True,
        others_images=others is not None and has_images(others),
    )


def _means(found: Sequence[_Found], kind: str) -> dict[str, float]:
    shares: dict[str, list[float]] = {}
    for one in found:
        if one.kind == kind:
            shares.setdefault(one.name, []).append(one.share)
    return {name: float(np.mean(some)) for name, some in shares.items()}


def _leave_person_out(
    task: tuple[Dataset, Dataset | None, tuple[str, ...], int],
) -> list[_Found]:
    dataset, others, unseen, number = task
    entries = labelled_entries(dataset)
    lesson = _learn(dataset, [entry for entry in entries if entry.participant != unseen[number]])
    cascade = lesson.cascades()
    found = list(_idle(cascade, range(number * IDLE_PEOPLE, (number + 1) * IDLE_PEOPLE)))
    if others is not None:
        for entry in others.entries[number :: len(unseen)]:
            share = _known_on(cascade[entry.handedness], others, entry)
            found.append(_Found("others", entry.interaction, share))
    for action in dict.fromkeys(entry.interaction for entry in entries):
        asked = [e for e in entries if (e.interaction, e.participant) == (action, unseen[number])]
        cascade = lesson.cascades(without=action) if asked else {}
        for entry in asked:
            share = _known_on(cascade[entry.handedness], dataset, entry)
            found.append(_Found("never_trained", action, share))
    return found


@dataclass(frozen=True)
class _Learned:
    """What was learned without a support vector machine, which `cascade` does not use."""

    body_poses: Array
    movements: MovementClasses
    temper: float
    presence: Presence


@dataclass(frozen=True)
class _Lesson:
    """What people teach: what is ``seen`` of each object, by action, wherever it is looked for."""

    people: tuple[JointSequence, ...]
    models: dict[str, Model]
    seen: list[Look]
    named: str

    def cascades(self, without: str | None = None) -> Mapping[str, Cascade]:
        """For right- and left-handed people; nothing of the action ``without`` is learned."""
        taught = [one for one in self.people if one.action != without]
        learned = learn_movements(taught, self.named)
        looks = [look for look in self.seen if look.action != without]
        told = _Learned(
            learned.body_poses,
            learned.movements,
            learned.temper,
            presence_of(looks, learned.actions),
        )
        return {
            hand: Cascade(
                told,
                [trackers[action] for action in learned.actions],
                left_handed=hand == "left",
            )
            for hand, trackers in self._trackers.items()
        }

    @cached_property
    def _trackers(self) -> dict[str, dict[str, ObjectTracker]]:
        """By handedness and action; a cascade starts them afresh."""
        return {
            hand: {
                action: new_tracker(model, DEFAULT_METHOD, left_handed=hand == "left")
                for action, model in self.models.items()
            }
            for hand in ("right", "left")
        }


def _learn(dataset: Dataset, entries: Sequence[DatasetEntry]) -> _Lesson:
    people = tuple(watch(dataset, entry) for entry in entries)
    actions = list(dict.fromkeys(one.action for one in people))
    models = learn_models(dataset, entries, actions)
    looks = look_around(dataset, entries, actions, models)
    return _Lesson(people, dict(zip(actions, models, strict=True)), looks, str(dataset.folder))


def _idle(cascades: Mapping[str, Cascade], numbers: Iterable[int]) -> Iterator[_Found]:
    for number in numbers:
        for kind in IDLE_KINDS:
            simulation = simulate_idle(kind, number, IDLE_SEED)
            cascade = cascades[simulation.person.handedness]
            seen = observe_simulation(simulation, NEEDS)
            share = _known_share(cascade, seen, simulation.frames)
            yield _Found("idle", kind, share)


def _known_on(cascade: Cascade, dataset: Dataset, entry: DatasetEntry) -> float:
    path = dataset.path(entry)
    frames = load_frames(path, entry.object)
    return _known_share(cascade, observe(path, frames, NEEDS), len(frames))


def _known_share(cascade: Cascade, observations: Iterable[Observation], frames: int) -> float:
    """Of so many frames the share in which an action is known."""
    cascade.restart()
    (answers,) = answers_together([cascade], observations, frames)
    return float((answers.known != UNKNOWN).mean())
