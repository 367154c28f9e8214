"""Trains the model of one object and its interaction from a dataset."""

from collections.abc import Callable, Collection, Sequence
from functools import lru_cache, partial

from inhand_runtime.recording import RecordingError
from inhand_schemas.errors import MessageError
from inhand_tracker.mapping.labelled_sequence import LabelledSequence
from inhand_tracker.mapping.learning import STAGES, UnusableSequenceError, learn
from inhand_tracker.mapping.mapping import Mapping
from inhand_tracker.methods.registry import DEFAULT_METHOD, new_tracker
from inhand_tracker.model.model import Model
from inhand_tracker.model.taught import TaughtRecordings
from inhand_tracker.prior.learning import learn_prior
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.shape.viewpoints import count_views, find_viewpoints
from inhand_tracker.sight.appearance import learn_appearance

from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError
from inhand_lab.datasets.labelled_sequence import labelled_sequence
from inhand_lab.datasets.stretches import RecordingStretch, stretches_of
from inhand_lab.training.absent_joints import absent_joints
from inhand_lab.training.appearance_samples import appearance_samples
from inhand_lab.training.recording_checks import check_hands, check_sequence
from inhand_lab.training.rotation_checks import check_rotations
from inhand_lab.training.shape_checks import check_shape
from inhand_lab.workers import in_processes

FEWEST_LEARNED = 2
"""Number of recordings, or of stretches of one, that learning compares at the least."""
OnRefused = Callable[[DatasetEntry, DatasetError | RecordingError], None]
"""What is called with a recording that is passed over, and its error."""
READING, VIEWPOINTS, APPEARANCE, PRIOR = "recordings", "viewpoints", "appearance", "prior"


def model_stages(recordings: int, start: Model | None = None) -> dict[str, int]:
    """Name the stages of training a model, or of adapting one, each with its number of steps."""
    taught = 0 if start is None else len(start.mapping.participants)
    viewpoints = {VIEWPOINTS: count_views()} if start is None else {}
    return {
        READING: recordings,
        **dict.fromkeys(STAGES, taught + recordings),
        **viewpoints,
        APPEARANCE: 1,
        PRIOR: 1,
    }


def entries_for(
    dataset: Dataset, object_name: str | None = None, without: Collection[str] = ()
) -> list[DatasetEntry]:
    """Choose the labelled recordings of one object, as ``recordings_of`` does; where one is left it
    is cut into stretches.

    Raises DatasetError.
    """
    left = recordings_of(dataset, object_name, without)
    return list(stretches_of(dataset, left[0], FEWEST_LEARNED)) if len(left) == 1 else left


def recordings_of(
    dataset: Dataset, object_name: str | None = None, without: Collection[str] = ()
) -> list[DatasetEntry]:
    """Choose the labelled recordings of one object, but for some participants'.

    ``object_name`` may be left out where the dataset has one object. Raises DatasetError.
    """
    labelled = [entry for entry in dataset.entries if entry.object is not None]
    objects = sorted({entry.object for entry in labelled if entry.object is not None})
    if not objects:
        raise DatasetError(
            f"no recording in {dataset.folder / 'dataset.toml'} names an object to learn: where "
            "skeletons and labels are, write object with the name that the labels have"
        )
    name = _only(objects, dataset) if object_name is None else object_name
    chosen = [entry for entry in labelled if entry.object == name]
    if not chosen:
        raise DatasetError(
            f"{dataset.folder} has no labelled recording of {name!r}; there are: "
            f"{', '.join(objects)}"
        )
    participants = sorted({entry.participant for entry in chosen})
    unknown = sorted(set(without) - set(participants))
    if unknown:
        raise DatasetError(
            f"{dataset.folder} has no participant {unknown[0]!r} with {name!r}; there are: "
            f"{', '.join(participants)}"
        )
    return [entry for entry in chosen if entry.participant not in without]


def _only(objects: Sequence[str], dataset: Dataset) -> str:
    """Return the only object of a dataset; raises DatasetError where there are more."""
    if len(objects) != 1:
        raise DatasetError(
            f"{dataset.folder} has {len(objects)} labelled objects; choose with --object: "
            f"{', '.join(objects)}"
        )
    return objects[0]


def train(
    dataset: Dataset,
    entries: Sequence[DatasetEntry],
    on_step: Callable[[str], None] = lambda stage: None,
    on_refused: OnRefused | None = None,
) -> Model:
    """Learn from recordings of one object; ``on_step`` is called at each step of ``model_stages``.

    Recordings that cannot be learned from are passed over, and ``on_refused`` called for each;
    without it they are errors. Raises DatasetError or InhandError.
    """
    first = _first_of(dataset, entries)
    shape = checked_shape(dataset, str(first.object))
    entries, sequences = read_recordings(dataset, entries, on_step, on_refused)
    absent = absent_joints(entries, sequences)
    sequences = [sequence.with_stand_ins(absent) for sequence in sequences]
    check_rotations(entries, sequences, shape.mirror_normal)
    mapping = learned_mapping(dataset, sequences, shape, absent, on_step)
    viewpoints = find_viewpoints(shape, on_view=lambda: on_step(VIEWPOINTS))
    appearance = learn_appearance(shape, appearance_samples(dataset, entries))
    on_step(APPEARANCE)
    prior = learn_prior(sequences, shape)
    on_step(PRIOR)
    taught = TaughtRecordings.of(sequences)
    model = Model(first.interaction, shape, mapping, viewpoints, appearance, prior, taught)
    # Compiles, once an installation, what the start of a rig would otherwise wait for.
    new_tracker(model, DEFAULT_METHOD)
    return model


def learned_mapping(
    dataset: Dataset,
    sequences: Sequence[LabelledSequence],
    shape: ObjectShape,
    absent: tuple[int, ...],
    on_step: Callable[[str], None],
) -> Mapping:
    """Learn the mapping of sequences; raises DatasetError."""
    try:
        return learn(sequences, shape.mirror_normal, on_step, absent_joints=absent)
    except UnusableSequenceError as error:
        raise DatasetError(f"{dataset.folder}: {error}") from None


def _first_of(dataset: Dataset, entries: Sequence[DatasetEntry]) -> DatasetEntry:
    """Return the first recording; raises DatasetError where too few, or it, cannot be learned."""
    if len(entries) < FEWEST_LEARNED:
        raise DatasetError(
            f"{dataset.folder}: learning compares recordings, two at the least, and "
            f"{len(entries)} is left: add participants"
        )
    if entries[0].object is None:
        raise DatasetError(f"{entries[0].file} is not labelled")
    return entries[0]


def read_recordings(
    dataset: Dataset,
    entries: Sequence[DatasetEntry],
    on_step: Callable[[str], None],
    on_refused: OnRefused | None = None,
    fewest: int = FEWEST_LEARNED,
) -> tuple[list[DatasetEntry], list[LabelledSequence]]:
    """Read and check recordings; return those that can be learned from, and what they hold.

    ``on_refused`` is called for each of the others. Raises the first one's error without it, and
    where fewer than ``fewest`` are left.
    """
    usable, sequences = [], []
    refused: list[tuple[DatasetEntry, DatasetError | RecordingError]] = []
    # In this process, since reading is short, but on a cluster.
    read = in_processes(partial(_read, dataset), entries, 1, lambda _: on_step(READING))
    for entry, sequence in zip(entries, read, strict=True):
        if isinstance(sequence, LabelledSequence):
            sequences.append(sequence)
            usable.append(entry)
        elif on_refused is None:
            raise sequence
        else:
            refused.append((entry, sequence))
    if refused and len(usable) < fewest:
        raise refused[0][1]
    for entry, reason in refused:
        if on_refused is not None:
            on_refused(entry, reason)
    check_hands(usable, sequences)
    return usable, sequences


def _read(
    dataset: Dataset, entry: DatasetEntry
) -> LabelledSequence | DatasetError | RecordingError:
    """Read a recording, or return why it cannot be learned from."""
    try:
        return checked_sequence(dataset, entry)
    except (DatasetError, RecordingError) as error:
        return error


def checked_shape(dataset: Dataset, name: str) -> ObjectShape:
    """Read an object's shape for training; raises InhandError for one that cannot be meant."""
    shape = dataset.shape(name)
    check_shape(shape, dataset.folder / "objects" / name)
    return shape


def checked_sequence(dataset: Dataset, entry: DatasetEntry) -> LabelledSequence:
    """Read a recording, or a stretch of one, for training.

    Raises DatasetError for one that cannot be meant.
    """
    if isinstance(entry, RecordingStretch):
        whole = _whole_sequence(dataset, entry.whole())
        return whole.cut(entry.first, entry.end)
    try:
        sequence = labelled_sequence(dataset, entry)
    except MessageError as error:
        raise DatasetError(
            f"{entry.file} holds a message that is wrong ({error}): record or label it again, or "
            "take it out of dataset.toml"
        ) from None
    check_sequence(entry, sequence)
    return sequence


# The stretches of a recording are read one after the other.
@lru_cache(maxsize=1)
def _whole_sequence(dataset: Dataset, entry: DatasetEntry) -> LabelledSequence:
    return checked_sequence(dataset, entry)
