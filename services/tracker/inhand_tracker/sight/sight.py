"""Looking for one object in prepared frames: how likely its poses are, and the likeliest nearby.

The terms: ``edges`` that run as the outline does; ``region``, colours of the object just within
the outline and others just beside it; ``interior``, colours of the object all over it; ``depth``,
where it was measured at the surface, or nearer by something in front, which says nothing, or
farther away, which speaks against.
"""

import math
from collections.abc import Collection, Sequence
from dataclasses import replace
from typing import Literal, get_args

import numpy as np

from inhand_tracker.geometry.arrays import Array, Indices, Singles
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.image import Image
from inhand_tracker.shape.contours import Contours, find_contours
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.shape.view_grid import view_grid
from inhand_tracker.shape.viewpoints import Viewpoints
from inhand_tracker.sight.appearance import Appearance
from inhand_tracker.sight.colour_learning import learn_colours
from inhand_tracker.sight.colours import Colours
from inhand_tracker.sight.frame import SightFrame, prepare
from inhand_tracker.sight.kernels.inputs import Outlines
from inhand_tracker.sight.kernels.weigh import VISIBLE
from inhand_tracker.sight.light import LightWatch, surrounding_tint
from inhand_tracker.sight.parameters import DEFAULT_SIGHT, SightParameters
from inhand_tracker.sight.refinement import Moved, PosePrior, PoseRefiner, Refined
from inhand_tracker.sight.view import PlacedView, SightView, view_frame
from inhand_tracker.sight.weighing import PoseWeigher

SightTerm = Literal["edges", "region", "interior", "depth"]

SIGHT_TERMS: tuple[SightTerm, ...] = get_args(SightTerm)


class Sight:
    """Weighs and refines poses of one object; many poses are weighed in several threads."""

    def __init__(
        self,
        shape: ObjectShape,
        viewpoints: Viewpoints,
        appearance: Appearance | None = None,
        terms: Collection[SightTerm] = SIGHT_TERMS,
        *,
        threads: int = 1,
        parameters: SightParameters = DEFAULT_SIGHT,
    ) -> None:
        self._shape = shape
        self._appearance = appearance
        self._parameters = parameters
        returned, behind = parameters.returned, parameters.behind
        if appearance is not None:
            returned, behind = appearance.returned, appearance.behind
        returned = returned if returned >= parameters.least_returned else 0.0
        whole = _outlines(shape, viewpoints)
        thin = _thinned(whole, parameters.thinning)
        wanted = np.array([term in terms for term in SIGHT_TERMS])
        self._weigher, self._quick_weigher = (
            PoseWeigher(outlines, wanted, (returned, behind), parameters, threads)
            for outlines in (whole, thin)
        )
        self._refiner = PoseRefiner(whole, thin, wanted, returned, parameters)
        self._term_weights = np.array(
            [
                parameters.edges_weight,
                parameters.region_weight,
                parameters.interior_weight,
                parameters.depth_weight,
            ]
        )

    def compile(self) -> None:
        """Compile all that a first frame would wait for: seconds, once an installation."""
        image = blank_image()
        surrounding_tint(image, np.ones((20, 3)), self._parameters)
        frame = prepare(image, parameters=self._parameters)
        ahead, upright = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0, 0.0])
        colours = self.learn(Colours(), frame, ahead, upright, of_object=0.5, around=0.5)
        view = self.view(frame, colours, np.tile(ahead, (20, 1)))
        self.log_likelihood(ahead[None], upright[None], view)
        self.refine(ahead[None], upright[None], view)

    def start(self) -> Colours:
        """The colours of the object and its surroundings as training left them."""
        if self._appearance is None:
            return Colours()
        return Colours(self._appearance.of_object, self._appearance.around)

    def watch_light(self) -> LightWatch:
        """A watch of the light, which knows the one that the object was learned in."""
        learned = self._appearance
        usual = (math.nan, math.nan) if learned is None else (learned.tint, learned.tint_range)
        return LightWatch(usual, self._parameters)

    def learn(
        self,
        colours: Colours,
        frame: SightFrame,
        translation: Array,
        rotation: Array,
        *,
        of_object: float = 0.0,
        around: float = 0.0,
    ) -> Colours:
        """Learn colours from a pose (3,), (4,): with this frame's share ``of_object`` in the
        object's, where the pose is trusted, and ``around`` in its surroundings'."""
        return learn_colours(
            self._shape, colours, frame, (translation, rotation), (of_object, around)
        )

    def view(self, frame: SightFrame, colours: Colours, joints: Array | None = None) -> SightView:
        """Score a frame for the object with these colours, and a person with joints (20, 3)."""
        return view_frame(frame, colours, joints, self._parameters)

    def weigh(
        self, translations: Array, orientations: Array, view: SightView, *, quickly: bool = False
    ) -> Array:
        """Weigh poses (P, 3) and (P, 4): each term's mean over their points, and the share of
        points that are visible, (P, 5).

        ``quickly`` by some of their points only: enough to tell which of many are worth a look.
        """
        weigher = self._quick_weigher if quickly else self._weigher
        return weigher.scores(translations, orientations, view)

    def log_likelihood_by(self, weighed: Array, view: SightView) -> Array:
        """Return the ``log_likelihood`` of poses that ``weigh`` has weighed, (P,)."""
        seen = weighed[:, :VISIBLE] @ self._term_weights
        return seen + (1.0 - weighed[:, VISIBLE]) * view.unseen

    def log_likelihood(self, translations: Array, orientations: Array, view: SightView) -> Array:
        """Return how many times likelier (log) the frame is with the object at each of poses
        (P, 3) and (P, 4) than with none, (P,); 0 where the frame says nothing."""
        return self.log_likelihood_by(self.weigh(translations, orientations, view), view)

    def compare_unseen(self, weighed: Array, view: SightView, trust: float) -> SightView:
        """Return the view in which an object that is not seen is as likely as one that is, by a
        sample of what is believed, poses that ``weigh`` has weighed, (P, 5).

        Not to be seen is no evidence, but a pose that could be seen is unlikely by a frame without
        the object: to come off better others need only lie out of it. So they get the mean
        likelihood of those that can be seen (of their seen part, as if it were all), where that
        is less than 1. The frame counts by ``trust``.
        """
        visible = weighed[:, VISIBLE]
        if visible.sum() < self._parameters.fewest_visible:
            return view
        whole = np.maximum(visible, self._parameters.least_visible)
        likelihoods = trust * (weighed[:, :VISIBLE] @ self._term_weights) / whole
        most = float(likelihoods.max())
        mean = most + float(np.log(visible @ np.exp(likelihoods - most) / visible.sum()))
        return replace(view, unseen=min(mean / trust, 0.0))

    def log_likelihoods_by_term(
        self, translations: Array, orientations: Array, view: SightView
    ) -> dict[str, Array]:
        """Return the parts of ``log_likelihood``, each (P,)."""
        parts = self.weigh(translations, orientations, view)[:, :VISIBLE] * self._term_weights
        return dict(zip(SIGHT_TERMS, parts.T, strict=True))

    def refine(
        self,
        translations: Array,
        orientations: Array,
        view: SightView,
        prior: PosePrior | None = None,
        trust: float = 1.0,
    ) -> Refined:
        """Move poses (K, 3) and (K, 4) to where the frame and the prior agree best nearby; one
        that does not become likelier stays where it is.

        The frame counts by ``trust``: less than 1 where earlier frames showed the same.
        """
        moved = self._refiner.refine((translations, orientations), view, prior, trust)
        return self._likelier((translations, orientations), moved, [PlacedView(view)], prior, trust)

    def refine_alone(
        self, pose: tuple[Array, Array], view: SightView, prior: PosePrior, trust: float
    ) -> Refined:
        """Move one pose, (3,) and (4,), as ``refine`` does, wherever that leads."""
        moved = self._refiner.refine((pose[0][None], pose[1][None]), view, prior, trust)
        seen = self.log_likelihood(moved.translations, moved.rotations, view)
        return Refined(moved.translations, moved.rotations, moved.information, seen)

    def refine_together(
        self,
        translations: Array,
        orientations: Array,
        views: Sequence[PlacedView],
        prior: PosePrior,
        trust: float,
        near: tuple[float, float],
    ) -> tuple[Refined, Indices]:
        """Move poses (K, 3) and (K, 4), as ``refine`` does, to where several views and each one's
        prior agree best; each view counts by ``trust`` times its sharpness. The log-likelihoods
        are those of the views' sum, by their sharpness.

        Of poses that come within ``near`` of each other, in metres and radians, one is returned;
        also the indices (L,) of those that are.
        """
        poses = translations, orientations
        moved, kept = self._refiner.refine_together(poses, views, prior, trust, near)
        chosen = replace(
            prior,
            translation=prior.translation[kept],
            rotation=prior.rotation[kept],
            information=prior.information[kept],
        )
        starts = translations[kept], orientations[kept]
        return self._likelier(starts, moved, views, chosen, trust), kept

    def _likelier(
        self,
        poses: tuple[Array, Array],
        moved: Moved,
        views: Sequence[PlacedView],
        prior: PosePrior | None,
        trust: float,
    ) -> Refined:
        """Take poses, (K, 3) and (K, 4), back to where they were if they did not become
        likelier."""
        translations, orientations = poses
        count = len(translations)
        both = (
            np.concatenate((translations, moved.translations)),
            np.concatenate((orientations, moved.rotations)),
        )
        each = [one.sharpness * self.log_likelihood(*one.poses(*both), one.view) for one in views]
        before, after = sum(each[1:], each[0]).reshape(2, count)
        gain = trust * (after - before)
        if prior is not None:
            expected = prior.log_density(both[0].reshape(2, -1, 3), both[1].reshape(2, -1, 4))
            gain = gain + expected[1] - expected[0]
        worse = gain < 0.0
        return Refined(
            np.where(worse[:, None], translations, moved.translations),
            np.where(worse[:, None], orientations, moved.rotations),
            np.where(worse[:, None, None], 0.0, moved.information),
            np.where(worse, before, after),
        )


def blank_image() -> Image:
    """Give a small image of a wall at 1 m, for what compiles before a first frame comes."""
    camera = Intrinsics(50.0, 50.0, 15.5, 15.5, 32, 32)
    return Image(None, camera, np.ones((32, 32), np.float32), np.zeros((32, 32, 3), np.uint8))


def _outlines(shape: ObjectShape, viewpoints: Viewpoints) -> Outlines:
    """Lay an object's contours out for kernels; older models hold none."""
    contours = viewpoints.contours
    if contours is None:
        contours = find_contours(shape, viewpoints.directions)
    return Outlines(
        view_grid(contours.directions),
        contours.directions,
        _points_last(contours.points),
        _points_last(contours.normals),
        contours.inside,
        contours.outside,
        _points_last(contours.surface_points),
        _points_last(contours.surface_normals),
        np.sqrt(contours.areas),
        _outline_lengths(contours),
    )


def _outline_lengths(contours: Contours) -> Singles:
    """Measure the outlines (V,), as shares of their mean length: their points are equally spaced,
    but for the steps from one outline to the next."""
    steps = np.diff(contours.points, axis=1)
    along = np.einsum("vbi,vi->vb", steps, contours.directions)
    across = steps - along[..., None] * contours.directions[:, None]
    lengths = np.median(np.linalg.norm(across, axis=2), axis=1)
    return np.asarray(lengths / lengths.mean(), np.float32)


def _points_last(points: Singles) -> Singles:
    """(V, B, 3) as (V, 3, B), so that points are weighed several at once."""
    return np.ascontiguousarray(np.swapaxes(points, 1, 2))


def _thinned(outlines: Outlines, step: int) -> Outlines:
    """Keep one in ``step`` points of outlines and surfaces."""
    points = {
        name: np.ascontiguousarray(getattr(outlines, name)[..., ::step])
        for name in (
            "points",
            "normals",
            "inside",
            "outside",
            "surface_points",
            "surface_normals",
        )
    }
    return outlines._replace(**points)
