"""How often an object is known falsely: where none is in use, or one that nobody taught."""

from dataclasses import dataclass

from inhand_lab.world.idle_people import Idleness

IDLE_KINDS: tuple[Idleness, ...] = ("stand", "walkOnSpot", "walkAbout", "gesture")
IDLE_SEED = 900


@dataclass(frozen=True)
class FalseObjects:
    """The share of frames in which an object is known falsely, of people of each kind: idle ones,
    those of other datasets, and those whose action was left out of training.

    ``images`` and ``others_images`` tell whether there were images, of the others apart.
    """

    idle: dict[str, float]
    others: dict[str, float]
    never_trained: dict[str, float]
    images: bool
    others_images: bool
