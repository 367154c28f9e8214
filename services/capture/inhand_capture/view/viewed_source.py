"""A source as everybody else sees it: turned, and with its masks burned in."""

import logging
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache, partial
from typing import Any, TypeVar

from inhand_runtime.pixels import decode_colour, decode_depth
from inhand_runtime.source import Captured, Pixels, Source, SourceError, control_source
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import CameraInfo, ColourImage, DepthImage, JointState, Person, Vector3
from msgspec.structs import replace as replace_struct
from numpy import uint8, uint16
from numpy.typing import NDArray

from inhand_capture.view.masks import Mask, Polygon, in_blocks, mask_of
from inhand_capture.view.turning import Turn

log = logging.getLogger(__name__)

P = TypeVar("P", uint8, uint16)
NOWHERE: Vector3 = (0.0, 0.0, 0.0)


def viewed(source: Source, degrees: int, masks: Sequence[Polygon]) -> Source:
    """Return the source, turned clockwise and masked where there is anything to turn or to mask.

    Raises SourceError, and closes the source, when its camera cannot be turned.
    """
    if not degrees and not masks:
        return source
    try:
        return ViewedSource(source, degrees // 90, masks)
    except SourceError:
        source.close()
        raise


class ViewedSource:
    """Wraps a source, so that nothing of what a mask covers leaves it.

    ``quarters`` turn its pictures clockwise; ``masks`` are polygons of the turned picture. In both
    colour and depth what is masked is 0; joints of the source's own skeletons that lie there are
    missing. A picture that cannot be decoded cannot be masked either, and is left out.
    """

    def __init__(self, source: Source, quarters: int, masks: Sequence[Polygon]) -> None:
        self._source = source
        info = source.info
        self._turn = Turn(quarters, info.width, info.height)
        self._masks = tuple(masks)
        self._info = self._turn.info(info)
        self._unreadable = False
        self._mask = lru_cache(maxsize=4)(self._source_mask)
        """Masks by the size of the source's pictures: colour's and depth's may differ."""
        self._upright_mask = mask_of(self._masks, self._info.width, self._info.height)

    @property
    def info(self) -> CameraInfo:
        """How the turned camera sees."""
        return self._info

    def captures(self, wanted: Callable[[], bool]) -> Iterator[Captured | None]:
        """The source's moments, turned and masked."""
        for captured in self._source.captures(wanted):
            yield None if captured is None else self._viewed(captured)

    def troubles(self) -> Mapping[str, str]:
        """What the source says of its device."""
        troubles: Mapping[str, str] = getattr(self._source, "troubles", dict)()
        return troubles

    def control(self, options: Mapping[str, Any]) -> None:
        """Change options of the source; raises SourceError."""
        control_source(self._source, options)

    def close(self) -> None:
        """Close the source."""
        self._source.close()

    def _viewed(self, captured: Captured) -> Captured:
        pixels, people = captured.pixels, captured.people
        return replace(
            captured,
            pixels=None if pixels is None else partial(self._pixels, pixels),
            people=None if people is None else tuple(map(self._person, people)),
            labels=tuple(map(self._turn.label, captured.labels)),
        )

    def _pixels(self, pixels: Callable[[], Pixels]) -> Pixels:
        taken = pixels()
        colour, depth = taken.colour, taken.depth
        mixed = isinstance(colour, ColourImage) and colour.codec == "jpeg"
        try:
            if isinstance(colour, ColourImage):
                colour = decode_colour(colour)
            if isinstance(depth, DepthImage):
                depth = decode_depth(depth)
        except MessageError as error:
            self._leave_out(error)
            return Pixels(None, None)
        return Pixels(
            colour=None if colour is None else self._seen(colour, mixed=mixed),
            depth=None if depth is None else self._seen(depth, mixed=False),
        )

    def _seen(self, picture: NDArray[P], *, mixed: bool) -> NDArray[P]:
        """Mask and turn a picture; in a ``mixed`` one neighbours hold traces of what is masked."""
        if self._masks:
            picture = picture.copy()
            picture[self._mask(*picture.shape[:2], mixed)] = 0
        return self._turn.picture(picture)

    def _source_mask(self, height: int, width: int, mixed: bool) -> Mask:
        upright = (width, height) if self._turn.quarters % 2 == 0 else (height, width)
        mask = self._turn.back(mask_of(self._masks, *upright))
        return in_blocks(mask) if mixed else mask

    def _person(self, person: Person) -> Person:
        person = self._turn.person(person)
        if not self._masks:
            return person
        hidden = [self._is_hidden(joint) for joint in person.joints]
        states: tuple[JointState, ...] = tuple(
            "missing" if hides else state
            for state, hides in zip(person.states, hidden, strict=True)
        )
        joints = tuple(
            NOWHERE if hides else joint for joint, hides in zip(person.joints, hidden, strict=True)
        )
        return replace_struct(person, states=states, joints=joints)

    def _is_hidden(self, joint: Vector3) -> bool:
        """Whether a joint lies where a mask is, in the picture."""
        (x, y, z), info = joint, self._info
        if z <= 0.0:
            return False
        column, row = round(info.fx * x / z + info.cx), round(info.fy * y / z + info.cy)
        if not (0 <= column < info.width and 0 <= row < info.height):
            return False
        return bool(self._upright_mask[row, column])

    def _leave_out(self, error: MessageError) -> None:
        if not self._unreadable:
            log.warning(
                "a picture cannot be read, and so not be masked or turned: it is left out, as all "
                "further ones like it: %s",
                error,
            )
        self._unreadable = True
