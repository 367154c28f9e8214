"""Keeps an image of one frame, prepared once for all the objects that are tracked in it."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeVar

from inhand_tracker.geometry.arrays import Array, Bytes, Singles
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.placement import Placement

Prepared = TypeVar("Prepared")
MOST_VIEWS = 4
"""Number of cameras' images of one moment that poses are looked for in at the most."""


@dataclass(frozen=True)
class Image:
    """Holds what of a frame was decoded, and the camera that took it.

    ``grey`` (H, W) is the luminance, ``colour`` (H, W, 3) RGB, ``depth`` (h, w) the depth of the
    same view in metres, 0 where nothing was measured. ``others`` are images of other cameras of the
    same moment, and ``source`` names this one's camera among them: what a method learns of a
    camera's images it keeps by that. An image may hold nothing beside the others. ``on_pulls`` is
    told what several cameras' images said of an object that was found.
    """

    grey: Bytes | None
    camera: Intrinsics
    depth: Singles | None = None
    colour: Bytes | None = None
    source: str = ""
    others: tuple["OtherView", ...] = ()
    on_pulls: Callable[[Sequence["ViewPull"]], None] | None = field(
        default=None, repr=False, compare=False
    )
    _prepared: dict[Callable[["Image"], Any], Any] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )

    @property
    def has_pixels(self) -> bool:
        """Whether the image itself holds anything."""
        return any(one is not None for one in (self.grey, self.depth, self.colour))

    def once(self, prepare: Callable[["Image"], Prepared]) -> Prepared:
        """Give what a function makes of this image; it is called once, however often asked."""
        if prepare not in self._prepared:
            self._prepared[prepare] = prepare(self)
        prepared: Prepared = self._prepared[prepare]
        return prepared


@dataclass(frozen=True)
class OtherView:
    """Holds an image of another camera, which stands at ``view_from_reference`` from the camera
    of the image that it is beside; it was captured ``later_s`` seconds after that one, or, below 0,
    before. ``place_covariance`` (6, 6) is that of the camera's translation, and of its rotation
    about itself, in the frame of reference; None where the place is sure."""

    image: Image
    view_from_reference: Placement
    later_s: float = 0.0
    place_covariance: Array | None = None


@dataclass(frozen=True)
class ViewPull:
    """What a camera's image alone says of an object that was found with its origin ``at`` (3,) in
    the frame of reference: the ``deviation`` (6,) of its pose from there, translation and rotation
    on the left, with the ``information`` (6, 6) in that."""

    camera: str
    at: Array
    deviation: Array
    information: Array
