"""What the images of a stretch show of an object, made when a frame is looked at.

A view takes some megabytes, and a stretch may be minutes long: the last few views stay in memory,
and others are read and made again.
"""

from collections import OrderedDict
from collections.abc import Collection, Sequence
from contextlib import suppress
from typing import Generic, TypeVar, overload

from inhand_schemas.errors import MessageError
from inhand_tracker.geometry.image import Image
from inhand_tracker.sight.frame import prepare
from inhand_tracker.sight.sight import Sight
from inhand_tracker.sight.view import SightView
from inhand_tracker.wire.conversion import Need, image_of

from inhand_lab.datasets.frame_index import FrameIndex
from inhand_lab.labelling.interpolation import Stretch
from inhand_lab.labelling.scene import Scene

Item = TypeVar("Item")


def image_at(
    scene: Scene,
    frames: FrameIndex,
    frame: int,
    needs: Collection[Need] = ("colour", "depth"),
) -> Image | None:
    """Read what is needed of the image of a frame; None where none was recorded, or it is damaged.

    Raises RecordingError where the file is.
    """
    with suppress(MessageError):
        pixels = frames.pixels(frame)
        return None if pixels is None else image_of(pixels, scene.info, needs)
    return None


class Picked(Sequence[Item], Generic[Item]):
    """A sequence whose items are made one by one; parts of it are lists."""

    def pick(self, index: int) -> Item:
        """Make the item of an index from 0 to one less than the length."""
        raise NotImplementedError

    @overload
    def __getitem__(self, index: int) -> Item: ...
    @overload
    def __getitem__(self, index: slice) -> list[Item]: ...
    def __getitem__(self, index: int | slice) -> Item | list[Item]:
        """Make an item, or some; raises IndexError beyond the last one."""
        if isinstance(index, slice):
            return [self.pick(one) for one in range(*index.indices(len(self)))]
        return self.pick(range(len(self))[index])


class StretchViews(Picked[SightView | None]):
    """The views of a stretch's frames; None where there is no image. ``kept`` stay in memory."""

    def __init__(
        self, scene: Scene, frames: FrameIndex, sight: Sight, stretch: Stretch, kept: int
    ) -> None:
        self._scene, self._frames, self._sight, self._stretch = scene, frames, sight, stretch
        # An lru_cache of a method would keep all views until Python looks for cycles.
        self._kept: OrderedDict[int, SightView | None] = OrderedDict()
        self._most = kept

    def __len__(self) -> int:
        return self._stretch.last - self._stretch.first + 1

    def pick(self, index: int) -> SightView | None:
        """Return the view of a frame, by its number in the stretch."""
        if index not in self._kept:
            self._kept[index] = self._make(index)
        self._kept.move_to_end(index)
        if len(self._kept) > self._most:
            self._kept.popitem(last=False)
        return self._kept[index]

    def _make(self, index: int) -> SightView | None:
        frame = self._stretch.first + index
        image = image_at(self._scene, self._frames, frame)
        if image is None:
            return None
        joints = self._scene.joints[frame]
        return self._sight.view(prepare(image), self._sight.start(), joints)


class Backwards(Picked[Item]):
    """The same items from the last to the first."""

    def __init__(self, items: Sequence[Item]) -> None:
        self._items = items

    def __len__(self) -> int:
        return len(self._items)

    def pick(self, index: int) -> Item:
        """Return the item that is as far from the end."""
        return self._items[len(self._items) - 1 - index]
