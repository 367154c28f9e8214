"""Keeps an image of one frame, prepared once for all the objects that are tracked in it."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, TypeVar

from inhand_tracker.geometry.arrays import Bytes, Singles
from inhand_tracker.geometry.camera import Intrinsics

Prepared = TypeVar("Prepared")


@dataclass(frozen=True)
class Image:
    """Holds what of a frame was decoded, and the camera that took it.

    ``grey`` (H, W) is the luminance, ``colour`` (H, W, 3) RGB, ``depth`` (h, w) the depth of the
    same view in metres, 0 where nothing was measured.
    """

    grey: Bytes | None
    camera: Intrinsics
    depth: Singles | None = None
    colour: Bytes | None = None
    _prepared: dict[Callable[["Image"], Any], Any] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )

    def once(self, prepare: Callable[["Image"], Prepared]) -> Prepared:
        """Give what a function makes of this image; it is called once, however often asked."""
        if prepare not in self._prepared:
            self._prepared[prepare] = prepare(self)
        prepared: Prepared = self._prepared[prepare]
        return prepared
