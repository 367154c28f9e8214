"""The five methods of Darby et al. 2014, Table 1, by their published differences."""

from dataclasses import dataclass
from typing import Literal

PartRule = Literal["hand", "random", "stable", "proximate"]


@dataclass(frozen=True)
class Method:
    """How a tracker re-initialises particles, and from which parts it predicts."""

    name: str
    reinitialises: bool
    translation_part: PartRule
    rotation_part: PartRule


METHODS = {
    method.name: method
    for method in (
        Method("g-hand", False, "hand", "hand"),
        Method("gd-hand", True, "hand", "hand"),
        Method("gd-random", True, "random", "random"),
        Method("gd-stable", True, "stable", "stable"),
        Method("gd-stable-proximate", True, "proximate", "stable"),
    )
}

DEFAULT_METHOD = "gd-stable-proximate"
