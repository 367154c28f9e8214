"""Makes what whole frames are measured on: a stranger's recording, and models of several objects.

The people are simulated, before a depth camera; each object's model is learned as by ``inhand
train``, from all people but the first.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from inhand_tracker.model.model_file import save_model

from inhand_lab.benchmarks.parameters import FramePeopleParameters
from inhand_lab.datasets.dataset import Dataset, DatasetEntry
from inhand_lab.datasets.generation import GenerationSettings, generate
from inhand_lab.training.model_training import entries_for, train


@dataclass(frozen=True)
class LearnedObjects:
    """``models`` are files, in the order of the interactions; ``stranger`` is a recording of the
    first interaction by somebody who was not learned from."""

    dataset: Dataset
    stranger: DatasetEntry
    models: tuple[Path, ...]

    @property
    def recording(self) -> Path:
        """The stranger's recording."""
        return self.dataset.path(self.stranger)


def preparation_steps(interactions: Sequence[str], parameters: FramePeopleParameters) -> int:
    """Return how often ``learn_objects`` calls ``on_step``."""
    return len(interactions) * (parameters.people + 1)


def learn_objects(
    folder: Path,
    interactions: Sequence[str],
    parameters: FramePeopleParameters,
    on_step: Callable[[], None],
) -> LearnedObjects:
    """Simulate people in a new folder and learn each interaction's object."""
    people, seed, frames = parameters.people, parameters.seed, parameters.frames
    dataset = generate(
        folder / "people", GenerationSettings(interactions, people, seed, frames), on_step
    )
    stranger = dataset.entries[0]
    models = []
    for interaction in interactions:
        (name,) = {e.object for e in dataset.entries if e.interaction == interaction}
        models.append(folder / f"{interaction}.model")
        save_model(train(dataset, entries_for(dataset, name, [stranger.participant])), models[-1])
        on_step()
    return LearnedObjects(dataset, stranger, tuple(models))
