"""Evaluation of tracking without being told the object, by the protocol of Darby et al. 2012.

For each unseen participant the recogniser and all models are learned from the others. The methods
get bodies and images; the labels meet their answers only in ``recognition_scores``.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace

from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.methods.darby2014.likelihood import DEFAULT_TERMS
from inhand_tracker.methods.registry import DEFAULT_METHOD, METHODS, MethodName, new_tracker
from inhand_tracker.model.model import Model
from inhand_tracker.recognition.cascade import Cascade
from inhand_tracker.recognition.darby2012.cascade import Cascade2012
from inhand_tracker.recognition.recogniser import Recogniser
from inhand_tracker.wire.conversion import Need

from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError
from inhand_lab.datasets.observations import Observation, observe
from inhand_lab.datasets.recorded_frames import load_camera, load_frames
from inhand_lab.evaluation.fold_model import learn_fold_model
from inhand_lab.evaluation.folds import Fold
from inhand_lab.evaluation.pose_errors import ErrorGauge
from inhand_lab.recognition.adaptive_comparison import follow_adaptively
from inhand_lab.recognition.scores import Answers, RecognitionScore, score_answers, score_boxes
from inhand_lab.recognition.true_boxes import person_pixels, true_boxes
from inhand_lab.training.presence_training import learn_presence
from inhand_lab.training.recogniser_training import train_recogniser
from inhand_lab.workers import in_processes

AnyCascade = Cascade2012 | Cascade

CASCADES = ("cascade-2012", "cascade")
TRACKING = DEFAULT_METHOD
"""The method of the trackers under `cascade`."""


@dataclass(frozen=True)
class RecognitionProtocol:
    """``unseen`` participants of a dataset, one after the other; ``pythons`` as in Environments."""

    dataset: Dataset
    unseen: tuple[str, ...]
    methods: tuple[str, ...]
    tracking: MethodName
    pythons: dict[str, str]
    seed: int = 0

    def needs(self) -> set[Need]:
        """What of a frame must be decoded for all methods."""
        needs: set[Need] = set()
        if "cascade-2012" in self.methods:
            needs.update(DEFAULT_TERMS)
        if "cascade" in self.methods:
            needs.update(METHODS[self.tracking].needs(METHODS[self.tracking].usual_terms))
        return needs


@dataclass(frozen=True)
class RecognitionTrial:
    """A method's, or an adaptive tracker's, score on one recording."""

    method: str
    interaction: str
    participant: str
    person_pixels: float
    score: RecognitionScore


def evaluate_recognition(
    protocol: RecognitionProtocol, processes: int, on_progress: Callable[[], None]
) -> list[RecognitionTrial]:
    """Try every method on every recording of the unseen; ``on_progress`` is called once a person.

    Raises DatasetError, InhandError or RecordingError.
    """
    tasks = [(protocol, participant) for participant in protocol.unseen]
    done = in_processes(_try_person, tasks, processes, lambda _: on_progress())
    return [trial for trials in done for trial in trials]


def labelled_entries(dataset: Dataset) -> list[DatasetEntry]:
    """The recordings with a labelled object; raises DatasetError where there are none."""
    entries = [entry for entry in dataset.entries if entry.object is not None]
    if not entries:
        raise DatasetError(
            f"{dataset.folder} has no labelled recording: only recognition alone can be measured "
            "on it (--alone)"
        )
    return entries


def learn_from(
    dataset: Dataset, entries: Sequence[DatasetEntry], *, images: bool = True
) -> tuple[Recogniser, list[Model]]:
    """A recogniser, and a model for each of its actions, in their order.

    Without ``images`` no boundaries and no colours are learned. Raises DatasetError or
    RecordingError.
    """
    recogniser = train_recogniser(dataset, entries)
    models = learn_models(dataset, entries, recogniser.actions, images=images)
    if images:
        presence = learn_presence(dataset, entries, recogniser.actions, models)
        recogniser = replace(recogniser, presence=presence)
    return recogniser, models


def learn_models(
    dataset: Dataset,
    entries: Sequence[DatasetEntry],
    actions: Sequence[str],
    *,
    images: bool = True,
) -> list[Model]:
    """A model for each of the actions; raises DatasetError or RecordingError."""
    folds = [
        Fold(action, (), tuple(entry for entry in entries if entry.interaction == action))
        for action in actions
    ]
    return [learn_fold_model(dataset, fold, images=images, fused=True) for fold in folds]


def _try_person(task: tuple[RecognitionProtocol, str]) -> list[RecognitionTrial]:
    protocol, participant = task
    entries = labelled_entries(protocol.dataset)
    recogniser, models = learn_from(
        protocol.dataset, [entry for entry in entries if entry.participant != participant]
    )
    trials = []
    for entry in entries:
        if entry.participant == participant:
            if entry.interaction not in recogniser.actions:
                raise DatasetError(
                    f"only {participant} does {entry.interaction}: nobody teaches it"
                )
            trials += _try_recording(protocol, recogniser, models, entry)
    return trials


def _try_recording(
    protocol: RecognitionProtocol,
    recogniser: Recogniser,
    models: Sequence[Model],
    entry: DatasetEntry,
) -> list[RecognitionTrial]:
    path = protocol.dataset.path(entry)
    frames = load_frames(path, entry.object)
    camera = load_camera(path)
    if camera is None:
        raise DatasetError(f"{entry.file} does not say how its camera sees: record it again")
    action = recogniser.actions.index(entry.interaction)
    shape = models[action].shape
    truth = true_boxes(frames, shape, camera)
    tall = person_pixels(frames, camera)
    trackers = [_tracker(protocol, name, recogniser, models, entry) for name in protocol.methods]
    gauge = ErrorGauge(shape)

    def trial(name: str, score: RecognitionScore) -> RecognitionTrial:
        return RecognitionTrial(name, entry.interaction, entry.participant, tall, score)

    observations = observe(path, frames, protocol.needs())
    answers = answers_together(trackers, observations, len(frames), camera)
    trials = [
        trial(name, score_answers(answer, action, frames, truth, gauge))
        for name, answer in zip(protocol.methods, answers, strict=True)
    ]
    followed = follow_adaptively(path, frames, truth, protocol.pythons) if protocol.pythons else {}
    return trials + [trial(name, score_boxes(boxes, truth)) for name, boxes in followed.items()]


def answers_together(
    trackers: Sequence[AnyCascade],
    observations: Iterable[Observation],
    frames: int,
    camera: Intrinsics | None = None,
) -> list[Answers]:
    """What several methods answer to the same frames; ``camera`` is for boxes without an image."""
    answers = [Answers.empty(frames) for _ in trackers]
    for index, seen in enumerate(observations):
        for tracker, answer in zip(trackers, answers, strict=True):
            if seen.somebody_else:
                tracker.restart()
            answer.put(index, tracker.step(seen.joints, seen.time_ns, seen.image, camera))
    return answers


def _tracker(
    protocol: RecognitionProtocol,
    name: str,
    recogniser: Recogniser,
    models: Sequence[Model],
    entry: DatasetEntry,
) -> AnyCascade:
    left_handed = entry.handedness == "left"
    if name == "cascade-2012":
        return Cascade2012(recogniser, models, left_handed=left_handed, seed=protocol.seed)
    trackers = [
        new_tracker(model, protocol.tracking, left_handed=left_handed, seed=protocol.seed)
        for model in models
    ]
    return Cascade(recogniser, trackers, left_handed=left_handed)
