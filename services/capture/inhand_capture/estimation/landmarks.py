"""BlazePose's landmark network: 33 points of the person in a region of a picture."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from inhand_capture.estimation.found_person import Floats
from inhand_capture.estimation.kernels.heat_maps import refine
from inhand_capture.estimation.litert import LiteRtNetwork
from inhand_capture.estimation.parameters import DEFAULT_BLAZEPOSE, BlazePoseParameters
from inhand_capture.estimation.regions import Region, crop, region_of_circle, whole_picture

SIDE = 256
POINTS = 33
ALL_POINTS = 39
NEXT_CENTRE, NEXT_RIM = 33, 34
"""Points that say where to look in the next picture."""
HEAT_SIDE = 64


@dataclass(frozen=True)
class Landmarks:
    """The points of one person.

    ``pixels`` (33, 2) in the picture, ``depths`` (33,) in metres behind the middle of the hips,
    ``visibilities`` (33,) from 0 to 1, ``score`` the probability that this is a person, and the
    ``next_region`` to look at.
    """

    pixels: Floats
    depths: Floats
    visibilities: Floats
    score: float
    next_region: Region


class LandmarkNetwork:
    """Finds the points of the one person in a region."""

    def __init__(self, weights: Path, parameters: BlazePoseParameters = DEFAULT_BLAZEPOSE) -> None:
        self._network = LiteRtNetwork(
            weights,
            SIDE,
            {
                "Identity": 5 * ALL_POINTS,
                "Identity_1": 1,
                "Identity_3": HEAT_SIDE * HEAT_SIDE * ALL_POINTS,
                "Identity_4": 3 * ALL_POINTS,
            },
        )
        self._parameters = parameters
        # What the first picture would have to wait for.
        self.find(np.zeros((SIDE, SIDE, 3), np.uint8), whole_picture(SIDE, SIDE))

    def find(self, picture: NDArray[np.uint8], region: Region) -> Landmarks:
        """Find the points in a region of a picture (H, W, 3) RGB."""
        cut = crop(picture, region, SIDE, padded=False)
        outputs = self._network(cut * np.float32(1.0 / 255.0))
        points = outputs["Identity"].reshape(ALL_POINTS, 5).astype(float)
        places = refine(
            points[:, :2],
            outputs["Identity_3"],
            self._parameters.refined_window // 2,
            self._parameters.refined_from,
        )
        pixels = region.to_picture(places, SIDE)
        return Landmarks(
            pixels=pixels[:POINTS],
            depths=outputs["Identity_4"].reshape(ALL_POINTS, 3)[:POINTS, 2].astype(float),
            visibilities=1.0 / (1.0 + np.exp(-points[:POINTS, 3])),
            score=float(outputs["Identity_1"][0]),
            next_region=region_of_circle(
                pixels[NEXT_CENTRE], pixels[NEXT_RIM], self._parameters.region_scale
            ),
        )
