"""Learning an object's colours, and its surroundings', from a pose in a frame."""

from dataclasses import replace

import cv2
import numpy as np

from inhand_tracker.geometry.arrays import Array, Singles
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.sight.colours import Bins, Colours, blend, histogram
from inhand_tracker.sight.frame import SightFrame, cut
from inhand_tracker.sight.parameters import SightParameters
from inhand_tracker.sight.silhouette import (
    object_shares,
    pixels_covered,
    region_around,
    silhouette_depths,
)

_WIDENED = np.ones((5, 5))
"""What is within two pixels of the object is not learned as its surroundings."""


def learn_colours(
    shape: ObjectShape,
    colours: Colours,
    frame: SightFrame,
    pose: tuple[Array, Array],
    rates: tuple[float, float],
) -> Colours:
    """Learn the colours of an object and of its surroundings from a pose, (3,) and (4,).

    The ``rates`` are the shares of this frame in the object's colours and in its surroundings';
    0 leaves them as they are.
    """
    parameters = frame.parameters
    region = region_around(shape, *pose, frame.camera, parameters)
    if frame.bins is None or region is None:
        return colours
    camera, pixels = cut(frame.camera, region)
    bins, measured = frame.bins[pixels], None if frame.depth is None else frame.depth[pixels]
    depths = silhouette_depths(shape, *pose, camera)
    object_rate, around_rate = rates
    if around_rate > 0.0:
        wide = cv2.dilate(np.isfinite(depths).astype(np.uint8), _WIDENED)
        around = histogram(bins, (1 - wide).astype(np.float32), parameters)
        colours = replace(colours, around=blend(colours.around, around, around_rate))
    if object_rate > 0.0:
        hidden = pixels_covered(measured, depths, parameters.aside_m)
        shares = object_shares(shape, *pose, camera)
        within = np.where(hidden, np.float32(0.0), shares)
        of_object = histogram(bins, _own(within), parameters)
        colours = replace(colours, of_object=blend(colours.of_object, of_object, object_rate))
        mixed = _mixed(bins, within, parameters)
        colours = replace(colours, mixed=blend(colours.mixed, mixed, around_rate))
    return colours


def _own(shares: Singles) -> Singles:
    """Weigh pixels (H, W) for the object's own colours, by its shares in them: only those that are
    all its own, where there are some."""
    own = (shares == 1.0).astype(np.float32)
    return own if own.any() else shares


def _mixed(bins: Bins, shares: Singles, parameters: SightParameters) -> Singles | None:
    """Count colours of the outline, ``Colours.mixed`` (4096, 2), by the object's ``shares`` in
    pixels (H, W); None where the object has no pixel."""
    mixed = ((shares > 0.0) & (shares < 1.0)).astype(np.float32)
    of_object = mixed * shares
    sides = of_object, mixed - of_object
    whole = max(float(shares.sum()), 1.0)
    columns = [
        np.float32(side.sum() / whole) * one
        for side in sides
        if (one := histogram(bins, side, parameters)) is not None
    ]
    return np.stack(columns, axis=1) if len(columns) == 2 else None
