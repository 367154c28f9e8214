"""What to hide of each picture of a camera, and pictures in which it is hidden."""

from dataclasses import dataclass
from typing import Literal

import cv2
import numpy as np
from inhand_capture.faces.discs import mask_of_discs
from inhand_capture.view.masks import Mask, in_blocks, without
from inhand_recorder.recorded import RecordedImages
from inhand_recorder.recording_reader import Recording
from inhand_runtime.pixels import decode_colour, decode_depth, encode_colour, encode_depth
from inhand_runtime.recording import RecordingError
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import ColourImage, DepthImage, Preview, RgbdFrame
from msgspec.structs import replace
from numpy.typing import NDArray

from inhand.redaction.background import (
    Background,
    Metres,
    Units,
    background_of,
    new_things,
    separate_things,
)
from inhand.redaction.bodies import mask_as_far_as_trunks, mask_of_bodies
from inhand.redaction.looking import CameraSightings, Sighting
from inhand.redaction.parameters import DEFAULT_REDACTION

What = Literal["faces", "people"]


@dataclass(frozen=True)
class Hidden:
    """What is hidden of a frame: a mask (H, W), of whatever size; None stands for all of it."""

    mask: Mask | None

    def of(self, shape: tuple[int, int]) -> Mask:
        """Return the pixels of a picture of that shape which it touches."""
        if self.mask is None:
            return np.ones(shape, bool)
        if self.mask.shape == shape:
            return self.mask
        size = (shape[1], shape[0])
        scaled = cv2.resize(self.mask.astype(np.float32), size, interpolation=cv2.INTER_AREA)
        return np.asarray(scaled > 0.0)


ALL = Hidden(None)


class CameraHiding:
    """Says what to hide of a camera's frames."""

    def __init__(
        self, what: What, sightings: CameraSightings, background: Background | None
    ) -> None:
        self._what: What = what
        self._sightings, self._info = sightings, sightings.info
        self._background = background

    def hidden_in(self, frame: RgbdFrame) -> Hidden:
        """Return what to hide of a frame; raises MessageError where its depth is damaged.

        All of one is hidden that was not looked at, or in which somebody may be and nobody was
        found. Where faces are hidden, people are in frames in which one of them was missed.
        """
        sighting = self._sightings.of((frame.sequence, frame.time_ns))
        if sighting is None:
            return ALL
        depth = None if frame.depth is None else decode_depth(frame.depth)
        metres = None if depth is None else depth * np.float32(self._info.depth_scale)
        shape = (self._info.height, self._info.width)
        if self._what == "people" or self._sightings.missed(sighting):
            return self._without_people(sighting, metres, shape)
        headless = self._sightings.headless(sighting)
        if len(sighting.heads) or headless:
            heads = mask_of_discs(sighting.discs, shape, shape)
            mask = heads | mask_of_bodies(headless, self._info, shape)
            return Hidden(mask | self._somebody_else(sighting, metres, shape))
        return self._all_or_nothing(metres, shape)

    def _without_people(
        self, sighting: Sighting, metres: Metres | None, shape: tuple[int, int]
    ) -> Hidden:
        if not self._sightings.bodies(sighting):
            return self._all_or_nothing(metres, shape)
        mask = people_mask(self._sightings, sighting, metres)
        if metres is None:
            return Hidden(mask)
        numbers, areas = self._things(metres)
        chosen = areas >= DEFAULT_REDACTION.new_m2
        chosen[np.unique(numbers[Hidden(mask).of(metres.shape)])] = True
        chosen[0] = False
        return Hidden(mask | _widened(Hidden(chosen[numbers]).of(shape)))

    def _somebody_else(
        self, sighting: Sighting, metres: Metres | None, shape: tuple[int, int]
    ) -> Mask:
        """Return where somebody may be beside those who were found, whose face would be seen."""
        if metres is None:
            return np.zeros(shape, bool)
        numbers, areas = self._things(metres)
        chosen = areas >= DEFAULT_REDACTION.somebody_m2
        found = people_mask(self._sightings, sighting, metres)
        chosen[np.unique(numbers[Hidden(found).of(metres.shape)])] = False
        return _widened(Hidden(chosen[numbers]).of(shape))

    def _all_or_nothing(self, metres: Metres | None, shape: tuple[int, int]) -> Hidden:
        """Hide all of a frame unless its depth shows that nothing is before the background."""
        if metres is None:
            return ALL
        _, areas = self._things(metres)
        nothing = (areas < DEFAULT_REDACTION.new_m2).all()
        return Hidden(np.zeros(shape, bool)) if nothing else ALL

    def _things(self, metres: Metres) -> tuple[NDArray[np.int32], NDArray[np.float64]]:
        """Number what is before the background, and measure the square metres of each."""
        new = new_things(metres, self._background)
        return separate_things(new, metres, self._background, self._info)


def camera_hiding(
    what: What, recording: Recording, key: str, sightings: CameraSightings
) -> CameraHiding:
    """Return what says what to hide of a camera, by the background behind those who were found."""
    frames = recording[key]
    found = [one for one in sightings.in_time if one.bodies]
    step = max(1, -(-len(found) // DEFAULT_REDACTION.samples))
    samples: list[tuple[Units, Mask]] = []
    for sighting in found[::step]:
        try:
            frame = frames.nearest(sighting.time_ns, within_ns=0)
            depth = frame.depth if isinstance(frame, RecordedImages) else None
        except (RecordingError, MessageError):
            continue
        if depth is not None:
            metres = depth * np.float32(sightings.info.depth_scale)
            mask = Hidden(people_mask(sightings, sighting, metres))
            samples.append((depth, mask.of(depth.shape)))
    background = background_of(samples, sightings.info.depth_scale)
    return CameraHiding(what, sightings, background)


def people_mask(sightings: CameraSightings, sighting: Sighting, metres: Metres | None) -> Mask:
    """Return the camera's pixels that people may take by their joints and faces, and by what is
    beside these in the depth (h, w)."""
    info = sightings.info
    shape, bodies = (info.height, info.width), sightings.bodies(sighting)
    mask = mask_of_bodies(bodies, info, shape) | mask_of_discs(sighting.discs, shape, shape)
    if metres is not None:
        mask |= Hidden(mask_as_far_as_trunks(bodies, info, metres)).of(shape)
    return _widened(mask)


def hide_in_frame(frame: RgbdFrame, hidden: Hidden) -> RgbdFrame | None:
    """Return a frame without what is hidden of it; None where that is nothing.

    Raises MessageError where a picture is damaged.
    """
    colour = None if frame.colour is None else _hide_colour(frame.colour, hidden)
    depth = None if frame.depth is None else _hide_depth(frame.depth, hidden)
    if colour is frame.colour and depth is frame.depth:
        return None
    return replace(frame, colour=colour, depth=depth)


def hide_in_preview(preview: Preview, hidden: Hidden) -> Preview | None:
    """Return a preview without what is hidden of its frame, as ``hide_in_frame`` does."""
    whole = ColourImage("jpeg", preview.width, preview.height, preview.jpeg)
    colour = _hide_colour(whole, hidden)
    return None if colour is whole else replace(preview, jpeg=colour.data)


def _hide_colour(image: ColourImage, hidden: Hidden) -> ColourImage:
    mask = hidden.of((image.height, image.width))
    pixels = decode_colour(image)
    if not mask.any():
        return image
    if image.codec == "rgb8":
        return replace(image, data=without(pixels, mask).tobytes())
    return encode_colour(without(pixels, in_blocks(mask)))


def _hide_depth(image: DepthImage, hidden: Hidden) -> DepthImage:
    mask = hidden.of((image.height, image.width))
    depth = decode_depth(image)
    return encode_depth(without(depth, mask), image.codec) if mask.any() else image


def _widened(mask: Mask) -> Mask:
    reach = max(1, round(DEFAULT_REDACTION.edge * mask.shape[1]))
    kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * reach + 1, 2 * reach + 1))
    return np.asarray(cv2.dilate(mask.astype(np.uint8), kernel), bool)
