"""The five methods of Darby et al. 2014, Table 1, by their published differences, and what their
section 7 proposes for body poses that are like none of those learned."""

from dataclasses import dataclass
from typing import Literal

PublishedMethod = Literal[
    "g-hand", "gd-hand", "gd-random", "gd-stable", "gd-stable-proximate", "gd-fallback"
]
PartRule = Literal["hand", "random", "stable", "proximate"]


@dataclass(frozen=True)
class Method:
    """How a tracker re-initialises particles, and from which parts it predicts.

    ``falls_back``: where no training pose is near, from the hands and a wide range of poses.
    """

    name: PublishedMethod
    reinitialises: bool
    translation_part: PartRule
    rotation_part: PartRule
    falls_back: bool = False


METHODS: dict[str, Method] = {
    method.name: method
    for method in (
        Method("g-hand", False, "hand", "hand"),
        Method("gd-hand", True, "hand", "hand"),
        Method("gd-random", True, "random", "random"),
        Method("gd-stable", True, "stable", "stable"),
        Method("gd-stable-proximate", True, "proximate", "stable"),
        Method("gd-fallback", True, "proximate", "stable", falls_back=True),
    )
}

TABLE_1: tuple[PublishedMethod, ...] = (
    "g-hand",
    "gd-hand",
    "gd-random",
    "gd-stable",
    "gd-stable-proximate",
)
"""The columns of the published table."""
