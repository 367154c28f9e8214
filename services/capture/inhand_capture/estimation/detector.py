"""BlazePose's detector: where in a picture somebody is, as a region to look at."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from inhand_capture.estimation.boxes import overlap, scores_of
from inhand_capture.estimation.found_person import Floats
from inhand_capture.estimation.litert import LiteRtNetwork
from inhand_capture.estimation.parameters import DEFAULT_BLAZEPOSE, BlazePoseParameters
from inhand_capture.estimation.regions import Region, crop, region_of_circle

SIDE = 224
GRIDS = ((28, 2), (14, 2), (7, 6))
"""Cells along each side of a grid of anchors, and how many anchors share a cell."""
ANCHORS = sum(cells * cells * shared for cells, shared in GRIDS)


def anchor_centres() -> Floats:
    """Return the anchors' centres (2254, 2) in shares of the crop's side."""
    centres = []
    for cells, shared in GRIDS:
        ticks = (np.arange(cells) + 0.5) / cells
        across, down = np.meshgrid(ticks, ticks)
        centres.append(np.repeat(np.stack([across.ravel(), down.ravel()], axis=1), shared, axis=0))
    return np.concatenate(centres)


class PersonDetector:
    """Looks for the one person who is clearest in a region of a picture."""

    def __init__(self, weights: Path, parameters: BlazePoseParameters = DEFAULT_BLAZEPOSE) -> None:
        self._network = LiteRtNetwork(
            weights, SIDE, {"Identity": 12 * ANCHORS, "Identity_1": ANCHORS}
        )
        self._anchors = anchor_centres()
        self._parameters = parameters

    def detect(self, picture: NDArray[np.uint8], view: Region) -> Region | None:
        """Return the region of the person in a view of a picture (H, W, 3); None for nobody.

        Overlapping boxes are averaged by their scores, as the network's authors do it.
        """
        cut = crop(picture, view, SIDE, beside="grey")
        outputs = self._network(cut * np.float32(1.0 / 127.5) - np.float32(1.0))
        scores = scores_of(outputs["Identity_1"][:, 0])
        good = np.flatnonzero(scores >= self._parameters.detection_score)
        if not len(good):
            return None
        boxes = outputs["Identity"][good].astype(float).reshape(-1, 6, 2)
        points = boxes[:, 2:4] / SIDE + self._anchors[good, None]
        places = np.column_stack([boxes[:, 0] / SIDE + self._anchors[good], boxes[:, 1] / SIDE])
        near = overlap(places, places[np.argmax(scores[good])]) > LEAST_OVERLAP
        weights = scores[good][near]
        hips, rim = (weights[:, None, None] * points[near]).sum(axis=0) / weights.sum()
        ends = view.to_picture(np.stack([hips, rim]) * SIDE, SIDE)
        return region_of_circle(ends[0], ends[1], self._parameters.region_scale)


LEAST_OVERLAP = 0.3
"""Shared area over joint area from which two boxes are of one person: the authors' number."""
