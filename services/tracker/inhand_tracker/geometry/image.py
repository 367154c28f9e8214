"""What the camera sees of one frame, prepared once for however many objects are tracked in it."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, TypeVar

from inhand_tracker.geometry.arrays import Bytes, Singles
from inhand_tracker.geometry.camera import Intrinsics

Prepared = TypeVar("Prepared")


@dataclass(frozen=True)
class Image:
    """A luminance image (H, W), or None, and the camera that took it.

    ``depth`` (h, w) is what was measured in the same view, in metres, 0 where nothing was;
    ``colour`` (H, W, 3) is RGB.
    """

    grey: Bytes | None
    camera: Intrinsics
    depth: Singles | None = None
    colour: Bytes | None = None
    _prepared: dict[Callable[["Image"], Any], Any] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )

    def once(self, prepare: Callable[["Image"], Prepared]) -> Prepared:
        """What a function makes of this image; it is called once, whoever asks."""
        if prepare not in self._prepared:
            self._prepared[prepare] = prepare(self)
        prepared: Prepared = self._prepared[prepare]
        return prepared
