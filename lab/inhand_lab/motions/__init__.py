"""The interactions, one a file; each performs as a right-handed person in the person's world."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from inhand_lab.motions import drink_from_mug, put_on_glasses, sweep_floor
from inhand_lab.motions.performance import Performance
from inhand_lab.objects.broom import broom
from inhand_lab.objects.glasses import glasses
from inhand_lab.objects.model import ObjectModel
from inhand_lab.objects.mug import mug
from inhand_lab.person import Person
from inhand_lab.transforms import Floats


@dataclass(frozen=True)
class Interaction:
    """Something people do with an object."""

    object_model: Callable[[], ObjectModel]
    perform: Callable[[Person, Floats, np.random.Generator], Performance]


INTERACTIONS = {
    "drinkFromMug": Interaction(mug, drink_from_mug.perform),
    "putOnGlasses": Interaction(glasses, put_on_glasses.perform),
    "sweepFloor": Interaction(broom, sweep_floor.perform),
}
"""What people can do, by name."""
