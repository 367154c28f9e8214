"""What is counted of false objects: recognised where none is in use, or one that nobody taught."""

from dataclasses import dataclass

from inhand_lab.datasets.dataset import Dataset
from inhand_lab.recognition.parameters import RecognitionEvaluationParameters


@dataclass(frozen=True)
class FalseObjectProtocol:
    """On whom false objects are counted.

    The recogniser learns from ``dataset``, but not from its participants who are ``unseen``. Each
    action is left out of training once, and looked at in them; nobody taught anything of the people
    of ``others``.
    """

    dataset: Dataset
    others: Dataset | None
    unseen: tuple[str, ...]
    parameters: RecognitionEvaluationParameters


@dataclass(frozen=True)
class FalseObjects:
    """Share of frames with a false object, by kind of people: idle ones by what they do, those of
    other datasets and those whose action was left out of training by their interaction.

    ``images`` is whether there were images, ``others_images`` whether there were of the others.
    """

    idle: dict[str, float]
    others: dict[str, float]
    never_trained: dict[str, float]
    images: bool
    others_images: bool
