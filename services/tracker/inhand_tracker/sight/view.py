"""A frame as it is scored for one object: what each pixel's colour says, and where limbs are."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from inhand_tracker.geometry.arrays import Array, Bytes, Singles
from inhand_tracker.geometry.placement import Placement
from inhand_tracker.sight.colours import Colours, colour_scores
from inhand_tracker.sight.frame import SightFrame
from inhand_tracker.sight.kernels.inputs import ScoredPixels
from inhand_tracker.sight.kernels.score_colours import score_colours
from inhand_tracker.sight.limbs import limb_mask
from inhand_tracker.sight.parameters import DEFAULT_SIGHT, SightParameters


@dataclass(frozen=True)
class SightView:
    """A frame scored for one object: ``colour_scores`` (H, W, 2), the log-likelihood ratios of each
    pixel's colour for its being within and beside the object, and ``limbs`` (H, W), 1 where a limb
    may cover it. ``unseen`` is the log-likelihood ratio of an object that is out of the frame, or
    covered; of one that is so in part, that part of ``unseen`` counts."""

    frame: SightFrame
    colour_scores: Singles
    limbs: Bytes
    unseen: float = 0.0

    @cached_property
    def pixels(self) -> ScoredPixels:
        """The view as kernels take it; what the frame lacks is not read, or says nothing."""
        frame, camera = self.frame, self.frame.camera
        size = (camera.height, camera.width)
        edges, scores, depth = frame.edges, frame.edge_scores, frame.depth
        return ScoredPixels(
            np.array([camera.fx, camera.fy, camera.cx, camera.cy], np.float32),
            np.zeros((4, 1, 1), np.uint8) if edges is None else edges,
            np.zeros((4, 8), np.float32) if scores is None else scores,
            self.colour_scores,
            self.limbs,
            np.zeros(size, np.float32) if depth is None else depth,
            np.zeros((*size, 3), np.uint8) if frame.colour is None else frame.colour,
        )


@dataclass(frozen=True)
class PlacedView:
    """A view of one of several cameras, ``view_from_reference`` from the frame of reference that
    poses are in; None where it is the camera's own. It counts by its ``sharpness``, from 0 to 1."""

    view: SightView
    view_from_reference: Placement | None = None
    sharpness: float = 1.0

    def poses(self, translations: Array, orientations: Array) -> tuple[Array, Array]:
        """Take poses (P, 3) and (P, 4) to the camera's frame."""
        if self.view_from_reference is None:
            return translations, orientations
        return self.view_from_reference.poses(translations, orientations)

    def points(self, points: Array) -> Array:
        """Take points (..., 3) to the camera's frame."""
        place = self.view_from_reference
        return points if place is None else place.points(points)


def view_frame(
    frame: SightFrame,
    colours: Colours,
    joints: Array | None = None,
    parameters: SightParameters = DEFAULT_SIGHT,
) -> SightView:
    """Score a frame for an object with these colours, held by a person with joints (20, 3)."""
    limbs = limb_mask(joints, frame.camera, frame.depth, parameters)
    scores = np.zeros((*limbs.shape, 2), np.float32)
    if frame.bins is not None:
        table = colour_scores(colours, parameters)
        score_colours(frame.bins, limbs, table, parameters.limb_share, scores)
    return SightView(frame, scores, limbs)
