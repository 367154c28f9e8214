"""Learning an object's colours, and its surroundings', from a pose in a frame."""

from dataclasses import replace

import cv2
import numpy as np

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.sight.colours import Colours, blend, histogram
from inhand_tracker.sight.frame import SightFrame, cut
from inhand_tracker.sight.silhouette import pixels_covered, region_around, silhouette_depths

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
        within = np.isfinite(depths) & ~pixels_covered(measured, depths, parameters.aside_m)
        of_object = histogram(bins, within.astype(np.float32), parameters)
        colours = replace(colours, of_object=blend(colours.of_object, of_object, object_rate))
    return colours
