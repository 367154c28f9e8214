"""Evaluation of tracking objects that are not given, by the protocol of Darby et al. 2012.

For each unseen participant the recogniser and all models are learned from the others. The methods
get bodies and images; the labels meet their answers only in ``recognition_scores``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.methods.darby2014.terms import DEFAULT_TERMS
from inhand_tracker.methods.registry import DEFAULT_METHOD, METHODS, MethodName, new_tracker
from inhand_tracker.recognition.cascade import Cascade
from inhand_tracker.recognition.darby2012.cascade import Cascade2012
from inhand_tracker.recognition.object_recogniser import ObjectRecogniser
from inhand_tracker.wire.conversion import Need

from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError
from inhand_lab.datasets.observations import observe
from inhand_lab.datasets.other_light import RECORDED, Light, in_light
from inhand_lab.datasets.recorded_frames import RecordedFrame, load_camera
from inhand_lab.datasets.stretches import entry_frames
from inhand_lab.evaluation.pose_errors import ErrorGauge
from inhand_lab.recognition.adaptive_comparison import follow_adaptively
from inhand_lab.recognition.cascade_learning import (
    TaughtCascade,
    labelled_entries,
    learn_cascade,
)
from inhand_lab.recognition.recognition_scores import (
    Answers,
    RecognitionScore,
    answer_together,
    score_answers,
    score_boxes,
)
from inhand_lab.recognition.true_boxes import person_pixels, true_boxes
from inhand_lab.workers import in_processes

CASCADES = ("cascade-2012", "cascade")
TRACKING = DEFAULT_METHOD
"""The method of the trackers under `cascade`."""


@dataclass(frozen=True)
class RecognitionProtocol:
    """Methods that are compared on participants of a dataset, who are ``unseen`` one by one.

    ``tracking`` is the method of the trackers under `cascade`; ``pythons`` run adaptive trackers,
    by name, as ``Environments`` gives them. What is tested is shown in each of ``lights``; all is
    learned, and adaptive trackers are compared, in the light in which it was recorded.
    """

    dataset: Dataset
    unseen: tuple[str, ...]
    methods: tuple[str, ...]
    tracking: MethodName
    pythons: dict[str, str]
    lights: tuple[Light, ...] = (RECORDED,)
    seed: int = 0

    def needs(self) -> set[Need]:
        """Return the parts of a frame that must be decoded for all methods."""
        needs: set[Need] = set()
        if "cascade-2012" in self.methods:
            needs.update(DEFAULT_TERMS)
        if "cascade" in self.methods:
            needs.update(METHODS[self.tracking].needs(METHODS[self.tracking].usual_terms))
        return needs

    def new_recogniser(
        self, name: str, taught: TaughtCascade, *, left_handed: bool
    ) -> ObjectRecogniser:
        """Make the method of a name for one recording."""
        recogniser, models = taught
        if name == "cascade-2012":
            return Cascade2012(recogniser, models, left_handed=left_handed, seed=self.seed)
        trackers = [
            new_tracker(model, self.tracking, left_handed=left_handed, seed=self.seed)
            for model in models
        ]
        return Cascade(recogniser, trackers, left_handed=left_handed)


@dataclass(frozen=True)
class RecognitionTrial:
    """A method's, or an adaptive tracker's, score on one recording in a light."""

    method: str
    interaction: str
    participant: str
    person_pixels: float
    score: RecognitionScore
    light: Light = RECORDED


def evaluate_recognition(
    protocol: RecognitionProtocol, processes: int, on_progress: Callable[[], None]
) -> list[RecognitionTrial]:
    """Try every method on every recording of the unseen; ``on_progress`` is called once a person.

    Raises DatasetError, InhandError or RecordingError.
    """
    tasks = [(protocol, participant) for participant in protocol.unseen]
    done = in_processes(_try_person, tasks, processes, lambda _: on_progress())
    return [trial for trials in done for trial in trials]


def _try_person(task: tuple[RecognitionProtocol, str]) -> list[RecognitionTrial]:
    """Learn from the other participants, and try every method on the unseen one's recordings."""
    protocol, participant = task
    entries = labelled_entries(protocol.dataset)
    taught = learn_cascade(
        protocol.dataset, [entry for entry in entries if entry.participant != participant]
    )
    trials = []
    for entry in entries:
        if entry.participant == participant:
            trials += _try_recording(protocol, taught, entry)
    return trials


def _try_recording(
    protocol: RecognitionProtocol, taught: TaughtCascade, entry: DatasetEntry
) -> list[RecognitionTrial]:
    path = protocol.dataset.path(entry)
    test = _prepare(protocol.dataset, taught, entry)
    pixels = person_pixels(test.frames, test.camera)
    about = entry.interaction, entry.participant, pixels
    trials = []
    for light in protocol.lights:
        recognisers = [
            protocol.new_recogniser(name, taught, left_handed=entry.handedness == "left")
            for name in protocol.methods
        ]
        observations = in_light(observe(path, test.frames, protocol.needs()), light)
        answers = answer_together(recognisers, observations, len(test.frames), test.camera)
        for name, one in zip(protocol.methods, answers, strict=True):
            trials.append(RecognitionTrial(name, *about, test.score(one), light))
    followed = follow_adaptively(path, test.frames, test.truth, protocol.pythons)
    for name, boxes in followed.items():
        trials.append(RecognitionTrial(name, *about, score_boxes(boxes, test.truth)))
    return trials


@dataclass(frozen=True)
class _Test:
    """A recording that recognition is tried on: its frames, camera, action, true boxes (T, 4)."""

    frames: Sequence[RecordedFrame]
    camera: Intrinsics
    action: int
    truth: Array
    gauge: ErrorGauge

    def score(self, answers: Answers) -> RecognitionScore:
        return score_answers(answers, self.action, self.frames, self.truth, self.gauge)


def _prepare(dataset: Dataset, taught: TaughtCascade, entry: DatasetEntry) -> _Test:
    """Read a recording; raises DatasetError where recognition cannot be tried on it."""
    if entry.interaction not in taught.recogniser.actions:
        raise DatasetError(f"only {entry.participant} does {entry.interaction}: nobody teaches it")
    frames = entry_frames(dataset, entry)
    camera = load_camera(dataset.path(entry))
    if camera is None:
        raise DatasetError(f"{entry.file} does not say how its camera sees: record it again")
    action = taught.recogniser.actions.index(entry.interaction)
    shape = taught.models[action].shape
    truth = true_boxes(frames, shape, camera)
    return _Test(frames, camera, action, truth, ErrorGauge(shape))
