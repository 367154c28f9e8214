"""A source as everybody else sees it: turned, and with its masks and faces burned in."""

import logging
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, lru_cache, partial
from typing import TYPE_CHECKING, Any, TypeVar

from inhand_runtime.pixels import raw_colour, raw_depth
from inhand_runtime.source import (
    Captured,
    Pixels,
    Source,
    SourceError,
    control_playback,
    control_source,
)
from inhand_schemas.errors import MessageError
from inhand_schemas.fields import JointState, Vector3
from inhand_schemas.messages import CameraInfo, ColourImage, Person
from inhand_schemas.playback import PlaybackReply, PlaybackRequest
from msgspec.structs import replace as replace_struct
from numpy import uint8, uint16
from numpy.typing import NDArray

from inhand_capture.view.masks import Mask, Polygon, in_blocks, mask_of, without
from inhand_capture.view.turning import Turn

if TYPE_CHECKING:  # what finds faces is loaded only where they are hidden
    from inhand_capture.estimation.found_person import FoundPerson
    from inhand_capture.faces.finder import FaceFinder

log = logging.getLogger(__name__)

P = TypeVar("P", uint8, uint16)
NOWHERE: Vector3 = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class FacelessPixels(Pixels):
    """A picture whose faces are hidden; what leaves the process is this.

    ``whole`` is the picture with its faces, for what looks at it inside of the process, and
    ``people`` are the bodies that were found in it.
    """

    whole: Pixels
    people: "Sequence[FoundPerson]"


def viewed(
    source: Source,
    degrees: int,
    masks: Sequence[Polygon],
    faces: "FaceFinder | None" = None,
) -> Source:
    """Return the source, turned clockwise and masked where there is anything to turn or to mask.

    ``faces`` finds those to hide. Raises SourceError, and closes the source, when its camera cannot
    be turned.
    """
    if not degrees and not masks and faces is None:
        return source
    try:
        return ViewedSource(source, degrees // 90, masks, faces)
    except SourceError:
        source.close()
        raise


class ViewedSource:
    """Wraps a source, so that nothing of what a mask covers leaves it.

    ``quarters`` turn its pictures clockwise; ``masks`` are polygons of the turned picture. In both
    colour and depth what is masked is 0; joints of the source's own skeletons that lie there are
    missing. A picture that cannot be decoded cannot be masked either, and is left out; so is one
    without colour where faces are to be hidden.
    """

    def __init__(
        self,
        source: Source,
        quarters: int,
        masks: Sequence[Polygon],
        faces: "FaceFinder | None" = None,
    ) -> None:
        self._source = source
        info = source.info
        self._turn = Turn(quarters, info.width, info.height)
        self._masks = tuple(masks)
        self._faces = faces
        self._info = self._turn.info(info)
        self._left_out: set[str] = set()
        self._mask = lru_cache(maxsize=4)(self._source_mask)
        """Masks by the size of the source's pictures: colour's and depth's may differ."""
        self._upright_mask = mask_of(self._masks, self._info.width, self._info.height)

    @property
    def info(self) -> CameraInfo:
        """How the turned camera sees."""
        return self._info

    def captures(self, wanted: Callable[[], bool]) -> Iterator[Captured | None]:
        """The source's moments, turned and masked.

        Faces are followed from picture to picture: while any are wanted, all are looked at.
        """
        for captured in self._source.captures(wanted):
            if captured is None:
                yield None
                continue
            seen = self._viewed(captured)
            if self._faces is not None and seen.pixels is not None and wanted():
                seen.pixels()
            yield seen

    def troubles(self) -> Mapping[str, str]:
        """What the source says of its device."""
        troubles: Mapping[str, str] = getattr(self._source, "troubles", dict)()
        return troubles

    def control(self, options: Mapping[str, Any]) -> None:
        """Change options of the source; raises SourceError."""
        control_source(self._source, options)

    def playback(self, request: PlaybackRequest, camera: str) -> PlaybackReply:
        """Change how the source plays what is recorded."""
        return control_playback(self._source, request, camera)

    def close(self) -> None:
        """Close the source."""
        self._source.close()

    def _viewed(self, captured: Captured) -> Captured:
        pixels, people = captured.pixels, captured.people
        seen = None if people is None else tuple(map(self._person, people))
        return replace(
            captured,
            pixels=None if pixels is None else cache(partial(self._pixels, captured)),
            people=seen,
            labels=tuple(map(self._turn.label, captured.labels)),
        )

    def _pixels(self, captured: Captured) -> Pixels:
        taken = Pixels(None, None) if captured.pixels is None else captured.pixels()
        mixed = isinstance(taken.colour, ColourImage) and taken.colour.codec == "jpeg"
        try:
            colour, depth = raw_colour(taken.colour), raw_depth(taken.depth)
        except MessageError as error:
            self._leave_out("cannot be read, and so not be masked or turned", str(error))
            return Pixels(None, None)
        colour = None if colour is None else self._seen(colour, mixed=mixed)
        depth = None if depth is None else self._seen(depth, mixed=False)
        if self._faces is None:
            return Pixels(colour, depth)
        if colour is None:
            self._leave_out("has no colour, in which faces could be found to be hidden", "")
            return Pixels(None, None)
        return self._faceless(self._faces, colour, depth, captured, mixed=mixed)

    def _faceless(
        self,
        finder: "FaceFinder",
        colour: NDArray[uint8],
        depth: NDArray[uint16] | None,
        captured: Captured,
        *,
        mixed: bool,
    ) -> FacelessPixels:
        """Hide the faces of a turned picture."""
        skeletons = tuple(map(self._turn.person, captured.people or ()))
        found = finder.find(colour, captured.time_ns, skeletons, self._info)
        mask = found.mask(*colour.shape[:2])
        if mixed:
            mask = self._turn.picture(in_blocks(self._turn.back(mask)))
        hidden = Pixels(
            without(colour, mask),
            None if depth is None else without(depth, found.mask(*depth.shape)),
        )
        return FacelessPixels(hidden.colour, hidden.depth, Pixels(colour, depth), found.people)

    def _seen(self, picture: NDArray[P], *, mixed: bool) -> NDArray[P]:
        """Mask and turn a picture; in a ``mixed`` one neighbours hold traces of what is masked."""
        if self._masks:
            picture = without(picture, self._mask(*picture.shape[:2], mixed))
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

    def _leave_out(self, why: str, detail: str) -> None:
        if why not in self._left_out:
            log.warning(
                "a picture %s: it is left out, as all further ones like it%s",
                why,
                f": {detail}" if detail else "",
            )
        self._left_out.add(why)
