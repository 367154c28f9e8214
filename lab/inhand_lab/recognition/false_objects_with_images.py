"""Counts false objects with images: the whole `cascade`, as a rig runs it."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from inhand_tracker.methods.object_tracker import ObjectTracker
from inhand_tracker.methods.registry import DEFAULT_METHOD, new_tracker
from inhand_tracker.model.model import Model
from inhand_tracker.recognition.cascade import Cascade
from inhand_tracker.recognition.recogniser import LearnedCascade

from inhand_lab.datasets.dataset import Dataset, DatasetEntry
from inhand_lab.datasets.observations import Observation, observe, observe_simulation
from inhand_lab.datasets.recorded_frames import has_images
from inhand_lab.datasets.stretches import entry_frames
from inhand_lab.people.joint_sequence import JointSequence
from inhand_lab.recognition.cascade_learning import labelled_entries, learn_models
from inhand_lab.recognition.false_objects import FalseObjectProtocol, FalseObjects
from inhand_lab.recognition.recognition_scores import UNKNOWN, answer_together
from inhand_lab.training.presence_training import (
    NEEDS,
    SupportSample,
    look_around,
    presence_of,
)
from inhand_lab.training.recogniser_training import learn_movements
from inhand_lab.training.recorded_movements import read_joints
from inhand_lab.workers import in_processes
from inhand_lab.world.idle_people import simulate_idle


@dataclass(frozen=True)
class _FalseShare:
    """Share of a recording's frames with a false object; ``kind`` is a field of FalseObjects."""

    kind: str
    name: str
    share: float


def count_with_images(
    protocol: FalseObjectProtocol, processes: int, on_progress: Callable[[], None] = lambda: None
) -> FalseObjects:
    """For each unseen participant learn from the dataset's other ones, and count on people.

    Idle people and the recordings of others are dealt out among what is learned. ``on_progress`` is
    called once a participant. Raises DatasetError or RecordingError.
    """
    tasks = [(protocol, number) for number in range(len(protocol.unseen))]
    done = in_processes(_leave_person_out, tasks, processes, lambda _: on_progress())
    shares = [one for some in done for one in some]
    return FalseObjects(
        _means(shares, "idle"),
        _means(shares, "others"),
        _means(shares, "never_trained"),
        images=True,
        others_images=protocol.others is not None and has_images(protocol.others),
    )


def _means(shares: Sequence[_FalseShare], kind: str) -> dict[str, float]:
    by_name: dict[str, list[float]] = {}
    for one in shares:
        if one.kind == kind:
            by_name.setdefault(one.name, []).append(one.share)
    return {name: float(np.mean(some)) for name, some in by_name.items()}


def _leave_person_out(task: tuple[FalseObjectProtocol, int]) -> list[_FalseShare]:
    """Count everything that the unseen participant of a number stands for."""
    protocol, number = task
    unseen = protocol.unseen[number]
    entries = labelled_entries(protocol.dataset)
    lesson = _learn(protocol.dataset, [one for one in entries if one.participant != unseen])
    tested = [one for one in entries if one.participant == unseen]
    cascades = lesson.cascades()
    return [
        *_on_idle(cascades, protocol, number),
        *_on_others(cascades, protocol, number),
        *_on_never_trained(lesson, protocol.dataset, tested),
    ]


@dataclass(frozen=True)
class _Lesson:
    """What people teach: how they move, and ``samples`` of what is seen of each object."""

    people: tuple[JointSequence, ...]
    models: dict[str, Model]
    samples: list[SupportSample]
    origin: str

    def cascades(self, without: str | None = None) -> Mapping[str, Cascade]:
        """Make cascades by handedness that learn nothing of the action ``without``.

        They have no support vector machine, which `cascade` does not use.
        """
        learned = learn_movements(
            [one for one in self.people if one.action != without], self.origin
        )
        samples = [sample for sample in self.samples if sample.action != without]
        presence = presence_of(samples, learned.actions)
        taught = LearnedCascade(learned.body_poses, learned.movements, learned.temper, presence)
        return {
            hand: Cascade(
                taught,
                [trackers[action] for action in learned.actions],
                left_handed=hand == "left",
            )
            for hand, trackers in self._trackers.items()
        }

    @cached_property
    def _trackers(self) -> dict[str, dict[str, ObjectTracker]]:
        """Trackers by handedness and action; a cascade starts them afresh."""
        return {
            hand: {
                action: new_tracker(model, DEFAULT_METHOD, left_handed=hand == "left")
                for action, model in self.models.items()
            }
            for hand in ("right", "left")
        }


def _learn(dataset: Dataset, entries: Sequence[DatasetEntry]) -> _Lesson:
    people = tuple(read_joints(dataset, entry) for entry in entries)
    actions = list(dict.fromkeys(one.action for one in people))
    models = learn_models(dataset, entries, actions)
    samples = look_around(dataset, entries, actions, models)
    return _Lesson(people, dict(zip(actions, models, strict=True)), samples, str(dataset.folder))


def _on_idle(
    cascades: Mapping[str, Cascade], protocol: FalseObjectProtocol, number: int
) -> Iterator[_FalseShare]:
    """Count on the idle people who fall to the unseen participant of a number."""
    parameters = protocol.parameters
    count = parameters.idle_people_with_images
    for person in range(number * count, (number + 1) * count):
        for kind in parameters.idle_kinds:
            simulation = simulate_idle(kind, person, parameters.idle_seed)
            cascade = cascades[simulation.person.handedness]
            seen = observe_simulation(simulation, NEEDS)
            yield _FalseShare("idle", kind, _recognised_share(cascade, seen, simulation.frames))


def _on_others(
    cascades: Mapping[str, Cascade], protocol: FalseObjectProtocol, number: int
) -> Iterator[_FalseShare]:
    """Count on the recordings of others that fall to the unseen participant of a number."""
    if protocol.others is None:
        return
    for entry in protocol.others.entries[number :: len(protocol.unseen)]:
        share = _share_in(cascades[entry.handedness], protocol.others, entry)
        yield _FalseShare("others", entry.interaction, share)


def _on_never_trained(
    lesson: _Lesson, dataset: Dataset, tested: Sequence[DatasetEntry]
) -> Iterator[_FalseShare]:
    """Count on an unseen participant's recordings, whose action is left out of training."""
    for action in dict.fromkeys(entry.interaction for entry in tested):
        cascades = lesson.cascades(without=action)
        for entry in tested:
            if entry.interaction == action:
                share = _share_in(cascades[entry.handedness], dataset, entry)
                yield _FalseShare("never_trained", action, share)


def _share_in(cascade: Cascade, dataset: Dataset, entry: DatasetEntry) -> float:
    path = dataset.path(entry)
    frames = entry_frames(dataset, entry)
    return _recognised_share(cascade, observe(path, frames, NEEDS), len(frames))


def _recognised_share(cascade: Cascade, observations: Iterable[Observation], frames: int) -> float:
    """Share of the frames in which an action is recognised."""
    cascade.restart()
    (answers,) = answer_together([cascade], observations, frames)
    return float((answers.actions != UNKNOWN).mean())
