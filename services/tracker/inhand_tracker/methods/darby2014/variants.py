"""The five methods of Darby et al. 2014, Table 1, by their published differences, and what their
section 7 proposes for body poses that are like none of those learned."""

from dataclasses import dataclass
from typing import Literal

PublishedMethod = Literal[
    "g-hand", "gd-hand", "gd-random", "gd-stable", "gd-stable-proximate", "gd-fallback"
]
PartRule = Literal["hand", "random", "stable", "proximate"]


@dataclass(frozen=True)
class Variant:
    """How a tracker re-initialises particles, and from which parts it predicts.

    ``falls_back``: where no training pose is near, from the hands and a wide range of poses.
    """

    name: PublishedMethod
    reinitialises: bool
    translation_part: PartRule
    rotation_part: PartRule
    falls_back: bool = False


VARIANTS: dict[str, Variant] = {
    method.name: method
    for method in (
        Variant("g-hand", False, "hand", "hand"),
        Variant("gd-hand", True, "hand", "hand"),
        Variant("gd-random", True, "random", "random"),
        Variant("gd-stable", True, "stable", "stable"),
        Variant("gd-stable-proximate", True, "proximate", "stable"),
        Variant("gd-fallback", True, "proximate", "stable", falls_back=True),
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
