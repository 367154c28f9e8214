"""Looking for one object in prepared frames: weighing poses, and refining them.

The terms: ``edges`` that run as the outline does; ``region``, colours of the object just within
the outline and others just beside it; ``interior``, colours of the object all over it; ``depth``,
where it was measured at the surface, or nearer by something in front, which says nothing, or
farther away, which speaks against (a mixture as of Wüthrich et al. 2013).
"""

from collections.abc import Collection
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Literal, get_args

import cv2
import numpy as np

from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array, Bytes, Singles
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.image import Image
from inhand_tracker.shape.contours import find_contours
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.shape.view_grid import view_grid
from inhand_tracker.shape.viewpoints import Viewpoints
from inhand_tracker.sight.appearance import (
    BEHIND,
    RETURNED,
    Appearance,
    pixels_within,
    region_around,
    silhouette_depths,
)
from inhand_tracker.sight.colours import (
    Colours,
    blend,
    histogram,
    log_odds_by_colour,
    look_up,
)
from inhand_tracker.sight.frame import SightFrame, prepare
from inhand_tracker.sight.kernels import SEEN, Outlines, Pixels, depth_scores, weigh
from inhand_tracker.sight.limbs import limb_mask
from inhand_tracker.sight.refinement import (
    DAMPING,
    REACH_M,
    REACH_RAD,
    REACHES,
    TRUST,
    Prior,
    Refined,
    gather,
)

SightTerm = Literal["edges", "region", "interior", "depth"]

SIGHT_TERMS: tuple[SightTerm, ...] = get_args(SightTerm)

TERM_WEIGHTS = np.array([4.5, 13.0, 6.0, 5.0])
"""How many independent points each term's are worth."""
POINT_WEIGHTS = np.array([0.2, 1.0])
"""The same for a point of the outline and of the surface in refinement."""
LIMB_WEIGHT = 0.5
_REFINED_TERMS = [0, 1, 3]

CERTAIN = 0.8
"""How sure a pixel's colour can make one of where it belongs."""
LIMB_SHARE = 0.25
"""How much of what speaks against the object is believed where a hand may cover it."""
FEWEST_IN_THREAD = 500
"""Poses for which another thread is worth while."""
LEAST_SEEN = 0.1
FEWEST_SEEN = 1.0
"""Poses that can be seen, with which others can be compared."""
LEAST_RETURNED = 0.5
"""Depth that is measured of less of an object's surface is rather that of the hand around it."""


@dataclass(frozen=True)
class SightView:
    """A frame with one object's eyes: ``colour_scores`` (H, W, 2), what each pixel's colour says
    to its being within and beside the object, and ``limbs`` (H, W). ``unseen`` is the
    log-likelihood ratio of an object that is out of the frame, or covered: of one that is so for a
    part, that part of it counts."""

    frame: SightFrame
    colour_scores: Singles
    limbs: Bytes
    unseen: float = 0.0


class Sight:
    """Weighs and refines poses of one object; many poses are weighed in so many threads."""

    def __init__(
        self,
        shape: ObjectShape,
        viewpoints: Viewpoints,
        appearance: Appearance | None = None,
        terms: Collection[SightTerm] = SIGHT_TERMS,
        *,
        threads: int = 1,
    ) -> None:
        self._shape = shape
        self._threads = threads
        self._pool = ThreadPoolExecutor(threads)
        contours = viewpoints.contours
        if contours is None:
            contours = find_contours(shape, viewpoints.directions)
        self._outlines = Outlines(
            view_grid(contours.directions),
            contours.directions,
            _points_last(contours.points),
            _points_last(contours.normals),
            contours.inside,
            contours.outside,
            _points_last(contours.surface_points),
            _points_last(contours.surface_normals),
            np.sqrt(contours.areas),
        )
        self._wanted = np.array([term in terms for term in SIGHT_TERMS])
        self._appearance = appearance
        returned, behind = RETURNED, BEHIND
        if appearance is not None:
            returned, behind = appearance.returned, appearance.behind
        self._returned = returned if returned >= LEAST_RETURNED else 0.0
        self._depth_scores = depth_scores(self._returned, behind)

    def compile(self) -> None:
        """Let all that a first frame would wait for be compiled: seconds, once an installation."""
        camera = Intrinsics(50.0, 50.0, 15.5, 15.5, 32, 32)
        image = Image(None, camera, np.ones((32, 32), np.float32), np.zeros((32, 32, 3), np.uint8))
        frame = prepare(image)
        ahead, upright = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0, 0.0])
        colours = self.look_around(Colours(), frame, ahead, upright)
        colours = self.learn(colours, frame, ahead, upright)
        view = self.view(frame, colours, np.tile(ahead, (20, 1)))
        self.log_likelihood(ahead[None], upright[None], view)
        self.refine(ahead[None], upright[None], view)

    def start(self) -> Colours:
        """What is known of the object's colours and its surroundings' from training."""
        if self._appearance is None:
            return Colours()
        return Colours(self._appearance.of_object, self._appearance.around)

    def look_around(
        self,
        colours: Colours,
        frame: SightFrame,
        translation: Array,
        rotation: Array,
        rate: float = 0.5,
    ) -> Colours:
        """The surroundings' colours learned from around a predicted pose (3,), (4,)."""
        part, depths = self._part_around(frame, translation, rotation)
        if part is None or part.bins is None:
            return colours
        wide = cv2.dilate(np.isfinite(depths).astype(np.uint8), np.ones((5, 5)))
        around = histogram(part.bins, (1 - wide).astype(np.float32))
        return replace(colours, around=blend(colours.around, around, rate))

    def learn(
        self,
        colours: Colours,
        frame: SightFrame,
        translation: Array,
        rotation: Array,
        rate: float = 0.1,
    ) -> Colours:
        """The object's colours learned from a pose (3,), (4,) that is trusted."""
        part, depths = self._part_around(frame, translation, rotation)
        if part is None or part.bins is None:
            return colours
        seen = histogram(part.bins, pixels_within(part, depths).astype(np.float32))
        return replace(colours, of_object=blend(colours.of_object, seen, rate))

    def _part_around(
        self, frame: SightFrame, translation: Array, rotation: Array
    ) -> tuple[SightFrame | None, Array]:
        """The part of a coloured frame around a pose, and how far away its surface is in each pixel
        of it; None where there is nothing to learn colours from."""
        region = region_around(self._shape, translation, rotation, frame.camera)
        if frame.colour is None or region is None:
            return None, np.empty((0, 0))
        part = prepare(Image(None, frame.camera, frame.depth, frame.colour), region)
        return part, silhouette_depths(self._shape, translation, rotation, part.camera)

    def view(self, frame: SightFrame, colours: Colours, joints: Array | None = None) -> SightView:
        """A frame as one with these colours sees it, and a person with joints (20, 3) in it."""
        limbs = limb_mask(joints, frame.camera, frame.depth)
        scores = np.zeros((*limbs.shape, 2), np.float32)
        if frame.bins is not None:
            within = 1.0 / (1.0 + np.exp(-log_odds_by_colour(colours)))
            sure = CERTAIN * within + (1.0 - CERTAIN) * (1.0 - within)
            table = np.log(2.0 * np.column_stack((sure, 1.0 - sure)))
            look_up(frame.bins, limbs, table.astype(np.float32), LIMB_SHARE, scores)
        return SightView(frame, scores, limbs)

    def log_likelihood(self, translations: Array, orientations: Array, view: SightView) -> Array:
        """Of poses (P, 3) and (P, 4), (P,): how many times likelier (log) the frame is with the
        object there than with none; 0 where the frame says nothing."""
        scores = self._scores(translations, orientations, view)
        return scores[:, :SEEN] @ TERM_WEIGHTS + (1.0 - scores[:, SEEN]) * view.unseen

    def compare_unseen(
        self, translations: Array, orientations: Array, view: SightView, trust: float
    ) -> SightView:
        """The view in which an object that is not seen is as likely as one that is, of a sample of
        what is believed, poses (P, 3) and (P, 4).

        Not to be seen is no evidence, but a pose that could be seen is unlikely by a frame without
        the object: to come off better others need only lie out of it. So they get the mean
        likelihood of those that can be seen (of their seen part, as if it were all), where that
        is less than 1. The frame counts by ``trust``.
        """
        scores = self._scores(translations, orientations, view)
        seen = scores[:, SEEN]
        if seen.sum() < FEWEST_SEEN:
            return view
        said = trust * (scores[:, :SEEN] @ TERM_WEIGHTS) / np.maximum(seen, LEAST_SEEN)
        most = float(said.max())
        mean = most + float(np.log(seen @ np.exp(said - most) / seen.sum()))
        return replace(view, unseen=min(mean / trust, 0.0))

    def log_likelihoods_by_term(
        self, translations: Array, orientations: Array, view: SightView
    ) -> dict[str, Array]:
        """The parts of ``log_likelihood``, each (P,)."""
        scores = self._scores(translations, orientations, view)[:, :SEEN] * TERM_WEIGHTS
        return dict(zip(SIGHT_TERMS, scores.T, strict=True))

    def refine(
        self,
        translations: Array,
        orientations: Array,
        view: SightView,
        prior: Prior | None = None,
        trust: float = 1.0,
    ) -> Refined:
        """Poses (K, 3) and (K, 4) moved to where the frame and the prior agree best nearby; one
        that does not become likelier stays where it is.

        The frame counts by ``trust``: less than 1 where the frames before have said the same.
        """
        moved, turned, information = self._steps(translations, orientations, view, prior, trust)
        worse = self._posterior(moved, turned, view, prior, trust) < self._posterior(
            translations, orientations, view, prior, trust
        )
        return Refined(
            np.where(worse[:, None], translations, moved),
            np.where(worse[:, None], orientations, turned),
            np.where(worse[:, None, None], 0.0, TRUST * information),
        )

    def _posterior(
        self,
        translations: Array,
        orientations: Array,
        view: SightView,
        prior: Prior | None,
        trust: float,
    ) -> Array:
        likelihood = trust * self.log_likelihood(translations, orientations, view)
        if prior is None:
            return likelihood
        return likelihood + prior.log_density(translations, orientations)

    def _steps(
        self,
        translations: Array,
        orientations: Array,
        view: SightView,
        prior: Prior | None,
        trust: float,
    ) -> tuple[Array, Array, Array]:
        """Poses (K, 3) and (K, 4) after all Gauss-Newton steps, and the image's (K, 6, 6)."""
        frame = view.frame
        coloured, deep = frame.bins is not None, frame.depth is not None
        wanted = self._wanted[_REFINED_TERMS] & [coloured, coloured, deep]
        pixels = self._pixels(view)
        information = np.zeros((len(translations), 6, 6))
        reach_m, reach_rad = (REACH_M, REACH_RAD) if prior is None else prior.reach()
        for share in REACHES:
            information = np.zeros((len(translations), 6, 6))
            gradients = np.zeros((len(translations), 6))
            gather(
                translations,
                orientations,
                self._outlines,
                pixels,
                self._returned,
                wanted,
                share * reach_m,
                share * reach_rad,
                trust * POINT_WEIGHTS,
                information,
                gradients,
            )
            total, pull = information + np.diag(DAMPING), gradients
            if prior is not None:
                total, pull = prior.added_to(total, pull, translations, orientations)
            steps = np.linalg.solve(total, pull[..., None])[..., 0]
            translations = translations + steps[:, :3]
            turns = rotations.from_vector(np.asarray(steps[:, 3:], np.float64))
            orientations = rotations.normalise(rotations.multiply(turns, orientations))
        return translations, orientations, information

    def _scores(self, translations: Array, orientations: Array, view: SightView) -> Array:
        frame = view.frame
        coloured, deep = frame.bins is not None, frame.depth is not None
        wanted = self._wanted & [coloured, coloured, coloured, deep]
        pixels = self._pixels(view)
        scores = np.zeros((len(translations), SEEN + 1), np.float32)

        def weigh_some(part: slice) -> None:
            weigh(
                np.ascontiguousarray(translations[part], np.float32),
                np.ascontiguousarray(orientations[part], np.float32),
                self._outlines,
                pixels,
                np.float32(LIMB_WEIGHT),
                self._depth_scores,
                wanted,
                scores[part],
            )

        share = max(FEWEST_IN_THREAD, -(-len(scores) // self._threads))
        parts = [slice(start, start + share) for start in range(0, len(scores), share)]
        if len(parts) > 1:
            list(self._pool.map(weigh_some, parts))
        elif parts:
            weigh_some(parts[0])
        return scores.astype(float)

    def _pixels(self, view: SightView) -> Pixels:
        """The frame for the kernels; what it does not hold is not read, or says nothing."""
        frame, camera = view.frame, view.frame.camera
        size = (camera.height, camera.width)
        edges, scores, depth = frame.edges, frame.edge_scores, frame.depth
        return Pixels(
            np.array([camera.fx, camera.fy, camera.cx, camera.cy], np.float32),
            np.zeros((4, 1, 1), np.uint8) if edges is None else edges,
            np.zeros((4, 8), np.float32) if scores is None else scores,
            view.colour_scores,
            view.limbs,
            np.zeros(size, np.float32) if depth is None else depth,
        )


def _points_last(points: Singles) -> Singles:
    """(V, B, 3) as (V, 3, B), so that points are weighed several at once."""
    return np.ascontiguousarray(np.swapaxes(points, 1, 2))
