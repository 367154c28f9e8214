"""Moving poses to where a frame's contours and depth fit best: Gauss-Newton steps.

What nothing is seen of stays where it is, or where a prior wants it. The measurements are those of
``kernels/gather``.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inhand_tracker.geometry.arrays import Array, Flags, Indices
from inhand_tracker.geometry.image import MOST_VIEWS
from inhand_tracker.geometry.kernels.pose_normals import (
    each_once,
    inverses,
    squares_by_information,
)
from inhand_tracker.geometry.placement import HERE
from inhand_tracker.sight.depth_table import sensor_of
from inhand_tracker.sight.kernels.gather import GatherSettings
from inhand_tracker.sight.kernels.inputs import Outlines
from inhand_tracker.sight.kernels.mixed_offset import Mixing
from inhand_tracker.sight.kernels.refine import Priors, Steps, refine
from inhand_tracker.sight.kernels.refine_together import Views, refine_together
from inhand_tracker.sight.parameters import SightParameters
from inhand_tracker.sight.view import PlacedView, SightView

_REFINED_TERMS = [0, 1, 3]
"""Edges, region and depth; the interior's colours hardly change with a small step."""


@dataclass(frozen=True)
class PosePrior:
    """Gaussians about poses, ``translation`` (..., 3) and ``rotation`` (..., 4), by their
    ``information`` (..., 6, 6): of a translation in the camera frame, then of a rotation vector on
    the left. Poses are known to be off by no more than ``most`` (2,), in metres and radians."""

    translation: Array
    rotation: Array
    information: Array
    most: tuple[float, float] = (np.inf, np.inf)

    def reach(self) -> Array:
        """How far poses may be off (..., 2), in metres and radians: the root mean squares of
        translation and rotation."""
        variances = np.diagonal(inverses(self.information), axis1=-2, axis2=-1)
        squares = variances.reshape(*variances.shape[:-1], 2, 3).sum(axis=-1)
        return np.minimum(np.sqrt(squares), self.most)

    def log_density(self, translations: Array, orientations: Array) -> Array:
        """The log-density (..., K) of poses (..., K, 3) and (..., K, 4), up to a constant."""
        prior = self.translation, self.rotation, self.information
        return -0.5 * squares_by_information(*prior, translations, orientations)


@dataclass(frozen=True)
class Moved:
    """Poses (K, 3) and (K, 4), and ``information`` (K, 6, 6), what the image alone says of each,
    in the order of ``PosePrior.information``."""

    translations: Array
    rotations: Array
    information: Array


@dataclass(frozen=True)
class Refined(Moved):
    """Poses that moved where they became likelier, and the image's ``log_likelihoods`` (K,); there
    is no information of the others."""

    log_likelihoods: Array


class PoseRefiner:
    """Moves poses of one object by the ``wanted`` (4,) terms of a view.

    The first steps look at the points of the ``thin`` outlines only. ``returned`` is the share of
    the surface of which depth is measured.
    """

    def __init__(
        self,
        outlines: Outlines,
        thin: Outlines,
        wanted: Flags,
        returned: float,
        parameters: SightParameters,
    ) -> None:
        self._outlines = outlines
        self._thin = thin
        self._wanted = wanted[_REFINED_TERMS]
        self._usual = _usual_settings(self._wanted, returned, parameters)
        self._parameters = parameters
        self._damping = np.repeat([parameters.damping_per_m2, parameters.damping_per_rad2], 3)
        steps = parameters.refinement_steps
        self._shares = np.geomspace(1.0, parameters.last_reach, steps)

    def refine(
        self,
        poses: tuple[Array, Array],
        view: SightView,
        prior: PosePrior | None,
        trust: float,
    ) -> Moved:
        """Move poses, (K, 3) and (K, 4), by all steps, each looking less far around them.

        The frame counts by ``trust``. The information is the last step's.
        """
        parameters, count = self._parameters, len(poses[0])
        moved = poses[0].astype(np.float64), poses[1].astype(np.float64)
        priors, reaches = self._priors(prior, count)
        information = np.zeros((count, 6, 6))
        first, last = parameters.thin_steps, self._shares[-1]
        for outlines, shares, mixes in (
            (self._thin, self._shares[:first], False),
            (self._outlines, self._shares[first:], False),
            (self._outlines, np.full(parameters.mixed_steps, last), True),
        ):
            settings = self._settings(view, trust * self._thinness(outlines))
            refine(
                moved,
                priors,
                Steps(shares, reaches, self._damping),
                outlines,
                view.pixels,
                settings._replace(mixes=mixes and bool(settings.wanted[1])),
                information,
            )
        return Moved(*moved, parameters.information_share * information)

    def refine_together(
        self,
        poses: tuple[Array, Array],
        views: Sequence[PlacedView],
        prior: PosePrior | None,
        trust: float,
        near: tuple[float, float],
    ) -> tuple[Moved, Indices]:
        """Move poses as ``refine`` does, by several views at once, each of which counts by
        ``trust`` times its sharpness; raises ValueError for more than ``MOST_VIEWS``.

        Of poses that the first steps have brought within ``near``, in metres and radians, one goes
        on. Also returns the indices (L,) of those that did.
        """
        parameters, count = self._parameters, len(poses[0])
        moved = poses[0].astype(np.float64), poses[1].astype(np.float64)
        priors, reaches = self._priors(prior, count)
        information = np.zeros((count, 6, 6))
        kept = np.arange(count)
        first, last = parameters.thin_steps, self._shares[-1]
        for outlines, shares, mixes in (
            (self._thin, self._shares[:first], False),
            (self._outlines, self._shares[first:], False),
            (self._outlines, np.full(parameters.mixed_steps, last), True),
        ):
            settings = [
                self._settings(one.view, trust * one.sharpness * self._thinness(outlines))
                for one in views
            ]
            settings = [one._replace(mixes=mixes and bool(one.wanted[1])) for one in settings]
            refine_together(
                moved,
                priors,
                Steps(shares, reaches, self._damping),
                outlines,
                _views_of(views, settings),
                information,
            )
            if outlines is self._thin:
                kept = np.flatnonzero(each_once(*moved, *near))
                moved, reaches = (moved[0][kept], moved[1][kept]), reaches[kept]
                priors = Priors(*(np.ascontiguousarray(one[kept]) for one in priors))
                information = information[kept]
        return Moved(*moved, parameters.information_share * information), kept

    def _thinness(self, outlines: Outlines) -> float:
        """How many points one of these outlines' stands for."""
        return self._outlines.points.shape[2] / outlines.points.shape[2]

    def _priors(self, prior: PosePrior | None, count: int) -> tuple[Priors, Array]:
        """A prior of each of K poses, and how far they may be off, (K, 2)."""
        parameters = self._parameters
        if prior is None:
            nothing = Priors(np.zeros((count, 3)), np.zeros((count, 4)), np.zeros((count, 6, 6)))
            return nothing, np.tile([parameters.reach_m, parameters.reach_rad], (count, 1))
        one_each = np.zeros((count, 1))
        each = Priors(
            prior.translation + one_each,
            prior.rotation + one_each,
            prior.information + one_each[..., None],
        )
        return each, prior.reach() + one_each

    def _settings(self, view: SightView, trust: float) -> GatherSettings:
        coloured, deep = view.frame.bins is not None, view.frame.depth is not None
        parameters = self._parameters
        return self._usual._replace(
            wanted=self._wanted & [coloured, coloured, deep],
            outline_weight=trust * parameters.outline_point_weight,
            surface_weight=trust * parameters.surface_point_weight,
        )


def _views_of(views: Sequence[PlacedView], settings: Sequence[GatherSettings]) -> Views:
    """Lay views out for kernels; the last one stands for those that are not there."""
    if not 1 <= len(views) <= MOST_VIEWS:
        raise ValueError(f"poses are refined by 1 to {MOST_VIEWS} views, not by {len(views)}")
    first, second, third, fourth = (min(n, len(views) - 1) for n in range(MOST_VIEWS))
    order = first, second, third, fourth
    pixels = [one.view.pixels for one in views]
    places = [one.view_from_reference or HERE for one in views]
    return Views(
        len(views),
        (pixels[first], pixels[second], pixels[third], pixels[fourth]),
        (settings[first], settings[second], settings[third], settings[fourth]),
        np.array([places[number].translation for number in order]),
        np.array([places[number].rotation for number in order]),
    )


def _usual_settings(wanted: Flags, returned: float, parameters: SightParameters) -> GatherSettings:
    """The settings of a frame that shows all and counts wholly."""
    return GatherSettings(
        wanted=wanted,
        returned=returned,
        outline_weight=parameters.outline_point_weight,
        surface_weight=parameters.surface_point_weight,
        sensor=sensor_of(parameters),
        samples=parameters.outline_samples,
        least_step_pixels=parameters.least_step_pixels,
        widest_edge_step=parameters.widest_edge_step,
        contour_error_m=parameters.contour_error_m,
        in_front_per_m=parameters.in_front_per_m,
        behind_per_m=parameters.behind_per_m,
        colour_weight=parameters.surface_colour_weight,
        limb_factor=parameters.surface_limb_factor,
        common_pixels=parameters.common_pixels,
        mixing=Mixing(
            parameters.mixed_reach_pixels,
            parameters.mixed_least_pixels,
            parameters.mixed_contrast,
            parameters.mixed_variance,
            parameters.mixed_gain,
        ),
        mixes=False,
    )
