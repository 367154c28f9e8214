"""BlazeFace, for faces up to five metres away: where in a picture faces are (Bazarevsky et al.
2019)."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from inhand_capture.estimation.boxes import overlap, scores_of
from inhand_capture.estimation.found_person import Floats
from inhand_capture.estimation.litert import LiteRtNetwork
from inhand_capture.estimation.regions import Region, crop
from inhand_capture.faces.discs import Disc
from inhand_capture.faces.parameters import DEFAULT_FACES, FaceParameters

SIDE = 192
CELLS = 48
"""Cells along each side of the grid of anchors."""
NUMBERS = 16
"""Numbers of a candidate: the box's middle and size, and six points."""


class FaceDetector:
    """Looks for all faces in a region of a picture."""

    def __init__(self, weights: Path, parameters: FaceParameters = DEFAULT_FACES) -> None:
        """Load the network; raises WeightsError, or SettingsError where LiteRT is missing."""
        count = CELLS * CELLS
        self._network = LiteRtNetwork(
            weights, SIDE, {"Identity": NUMBERS * count, "Identity_1": count}
        )
        ticks = (np.arange(CELLS) + 0.5) / CELLS
        across, down = np.meshgrid(ticks, ticks)
        self._anchors = np.stack([across.ravel(), down.ravel()], axis=1)
        self._parameters = parameters

    def find(self, picture: NDArray[np.uint8], view: Region) -> list[Disc]:
        """Return what to hide of a picture (H, W, 3) RGB, looked at in one region of it.

        Beside the picture is its mirror image, which makes whole faces of those that an edge cuts.
        """
        cut = crop(picture, view, SIDE, beside="mirror")
        outputs = self._network(cut * np.float32(1.0 / 127.5) - np.float32(1.0))
        scores = scores_of(outputs["Identity_1"][:, 0])
        good = np.flatnonzero(scores >= self._parameters.face_score)
        boxes = outputs["Identity"][good, :4].astype(float)
        boxes[:, :2] += self._anchors[good] * SIDE
        chosen = _each_once(boxes, scores[good], self._parameters.same_face)
        places = view.to_picture(boxes[chosen, :2], SIDE)
        radii = self._parameters.face_radius * view.side / SIDE * boxes[chosen, 2:].max(axis=1)
        height, width = picture.shape[:2]
        return [
            Disc(_mirrored_into(x, width), _mirrored_into(y, height), radius)
            for (x, y), radius in zip(places.tolist(), radii.tolist(), strict=True)
        ]


def _mirrored_into(place: float, size: int) -> float:
    """Return where in a picture that is which a place beside it shows the mirror image of."""
    last = size - 1.0
    if place < 0.0:
        return min(-place, last)
    return max(2.0 * last - place, 0.0) if place > last else place


def _each_once(boxes: Floats, scores: Floats, nearness: float) -> Sequence[int]:
    """Return which of boxes (N, 4), middle and size, are the best of their face."""
    chosen: list[int] = []
    for one in np.argsort(-scores, kind="stable").tolist():
        if all(overlap(boxes[one], boxes[other]) <= nearness for other in chosen):
            chosen.append(one)
    return chosen
