"""Shows what was recorded as it would look in a light of another colour."""

from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np
from inhand_tracker.sight.light import scale_colours

from inhand_lab.datasets.observations import Observation

Light = tuple[float, float, float]
"""Factors on red, green and blue."""

RECORDED: Light = (1.0, 1.0, 1.0)
"""The light in which something was recorded."""


def in_light(observations: Iterable[Observation], light: Light) -> Iterator[Observation]:
    """Yield observations whose images' colours are multiplied by a light, and bounded at 255.

    In the ``RECORDED`` light they stay as they are. Luminance stays as it is in every light.
    """
    for seen in observations:
        image = seen.image
        if image is None or image.colour is None or light == RECORDED:
            yield seen
            continue
        lit = replace(image, colour=scale_colours(image.colour, np.array(light)))
        yield replace(seen, image=lit)
