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
_PAIRS = ((1, 4), (2, 5), (3, 6), (7, 8), (9, 10), *((left, left + 1) for left in range(11, 33, 2)))
"""Points that are each other's mirror image: of the face, and of the body from the shoulders on."""


def _mirrored_points() -> NDArray[np.int64]:
    """Return for each of all points (39,) the one that is its mirror image."""
    order = np.arange(ALL_POINTS)
    for left, right in _PAIRS:
        order[left], order[right] = right, left
    return order


_MIRRORED = _mirrored_points()


@dataclass(frozen=True)
class Landmarks:
    """The points of one person.

    ``pixels`` (33, 2) in the picture, ``places`` (33, 3) in metres from the middle of the hips, in
    the directions of the picture and away from the camera, ``visibilities`` (33,) from 0 to 1,
    ``score`` the probability that this is a person, and the ``next_region`` to look at.
    """

    pixels: Floats
    places: Floats
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

    def find(
        self, picture: NDArray[np.uint8], region: Region, *, mirrored: bool = False
    ) -> Landmarks:
        """Find the points in a region of a picture (H, W, 3) RGB.

        The network may be shown the region's mirror image; what it finds is mirrored back.
        """
        cut = crop(picture, region, SIDE, beside="edge")
        if mirrored:
            cut = np.ascontiguousarray(cut[:, ::-1])
        outputs = self._network(cut * np.float32(1.0 / 255.0))
        points = outputs["Identity"].reshape(ALL_POINTS, 5).astype(float)
        spots = refine(
            points[:, :2],
            outputs["Identity_3"],
            self._parameters.refined_window // 2,
            self._parameters.refined_from,
        )
        places = outputs["Identity_4"].reshape(ALL_POINTS, 3).astype(float)
        if mirrored:
            spots, places, points = spots[_MIRRORED], places[_MIRRORED], points[_MIRRORED]
            spots[:, 0] = SIDE - 1.0 - spots[:, 0]
            places[:, 0] *= -1.0
        pixels = region.to_picture(spots, SIDE)
        return Landmarks(
            pixels=pixels[:POINTS],
            places=region.turned(places[:POINTS]),
            visibilities=1.0 / (1.0 + np.exp(-points[:POINTS, 3])),
            score=float(outputs["Identity_1"][0]),
            next_region=region_of_circle(
                pixels[NEXT_CENTRE], pixels[NEXT_RIM], self._parameters.region_scale
            ),
        )
