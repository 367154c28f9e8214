"""The five methods of Darby et al. 2014, Table 1, by their published differences."""

from dataclasses import dataclass
from typing import Literal

MethodName = Literal["g-hand", "gd-hand", "gd-random", "gd-stable", "gd-stable-proximate"]
PartRule = Literal["hand", "random", "stable", "proximate"]


@dataclass(frozen=True)
class Method:
    """How a tracker re-initialises particles, and from which parts it predicts."""

    name: MethodName
    reinitialises: bool
    translation_part: PartRule
    rotation_part: PartRule


METHODS: dict[str, Method] = {
    method.name: method
    for method in (
        Method("g-hand", False, "hand", "hand"),
        Method("gd-hand", True, "hand", "hand"),
        Method("gd-random", True, "random", "random"),
        Method("gd-stable", True, "stable", "stable"),
        Method("gd-stable-proximate", True, "proximate", "stable"),
    )
}

DEFAULT_METHOD: MethodName = "gd-stable-proximate"
