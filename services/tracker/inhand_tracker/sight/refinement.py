"""Moving poses to where a frame's contours and depth fit best: Gauss-Newton steps.

What nothing is seen of stays where it is, or where a prior wants it. The measurements are those of
``kernels/gather``.
"""

from dataclasses import dataclass

import numpy as np

from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array, Flags
from inhand_tracker.sight.depth_table import sensor_of
from inhand_tracker.sight.kernels.gather import Equations, GatherSettings, gather
from inhand_tracker.sight.kernels.inputs import Outlines
from inhand_tracker.sight.parameters import SightParameters
from inhand_tracker.sight.view import SightView

_REFINED_TERMS = [0, 1, 3]
"""Edges, region and depth; the interior's colours hardly change with a small step."""


@dataclass(frozen=True)
class PosePrior:
    """A Gaussian about one pose, ``translation`` (3,) and ``rotation`` (4,), by its
    ``information`` (6, 6): of a translation in the camera frame, then of a rotation vector on the
    left."""

    translation: Array
    rotation: Array
    information: Array

    def reach(self) -> tuple[float, float]:
        """The root mean squares of its translation and rotation, in metres and radians."""
        variances = np.diag(np.linalg.inv(self.information))
        return float(np.sqrt(variances[:3].sum())), float(np.sqrt(variances[3:].sum()))

    def log_density(self, translations: Array, orientations: Array) -> Array:
        """The log-density (K,) of poses (K, 3) and (K, 4), up to a constant."""
        turns = rotations.multiply(orientations, rotations.conjugate(self.rotation))
        off = np.concatenate((translations - self.translation, rotations.to_vector(turns)), axis=1)
        return -0.5 * np.einsum("ki,ij,kj->k", off, self.information, off)

    def added_to(self, equations: Equations, translations: Array, orientations: Array) -> Equations:
        """The equations of poses (K, 3) and (K, 4) with the prior's information and gradients."""
        turns = rotations.multiply(self.rotation, rotations.conjugate(orientations))
        off = np.concatenate((self.translation - translations, rotations.to_vector(turns)), axis=1)
        return Equations(
            equations.information + self.information,
            equations.gradients + off @ self.information,
        )


@dataclass(frozen=True)
class Refined:
    """Poses (K, 3) and (K, 4), and ``information`` (K, 6, 6), what the image alone says of each,
    in the order of ``PosePrior.information``; none of a pose that could not be made likelier."""

    translations: Array
    rotations: Array
    information: Array


class PoseRefiner:
    """Moves poses of one object by the ``wanted`` (4,) terms of a view.

    ``returned`` is the share of the surface of which depth is measured.
    """

    def __init__(
        self, outlines: Outlines, wanted: Flags, returned: float, parameters: SightParameters
    ) -> None:
        self._outlines = outlines
        self._wanted = wanted[_REFINED_TERMS]
        self._returned = returned
        self._parameters = parameters
        self._damping = np.diag(
            np.repeat([parameters.damping_per_m2, parameters.damping_per_rad2], 3)
        )

    def refine(
        self,
        poses: tuple[Array, Array],
        view: SightView,
        prior: PosePrior | None,
        trust: float,
    ) -> Refined:
        """Move poses, (K, 3) and (K, 4), by all steps, each looking less far around them.

        The frame counts by ``trust``. The information is the last step's.
        """
        translations, orientations = poses
        pixels = view.pixels()
        settings = self._settings(view, prior, trust)
        information = np.zeros((len(translations), 6, 6))
        for share in np.geomspace(
            1.0, self._parameters.last_reach, self._parameters.refinement_steps
        ).tolist():
            information = np.zeros((len(translations), 6, 6))
            equations = Equations(information, np.zeros((len(translations), 6)))
            nearer = settings._replace(
                reach_m=share * settings.reach_m, reach_rad=share * settings.reach_rad
            )
            gather(translations, orientations, self._outlines, pixels, nearer, equations)
            translations, orientations = self._step(equations, translations, orientations, prior)
        return Refined(translations, orientations, self._parameters.information_share * information)

    def _step(
        self,
        equations: Equations,
        translations: Array,
        orientations: Array,
        prior: PosePrior | None,
    ) -> tuple[Array, Array]:
        """Move poses to where their equations have their solutions."""
        total = equations._replace(information=equations.information + self._damping)
        if prior is not None:
            total = prior.added_to(total, translations, orientations)
        steps = np.linalg.solve(total.information, total.gradients[..., None])[..., 0]
        turns = rotations.from_vector(np.asarray(steps[:, 3:], np.float64))
        return (
            translations + steps[:, :3],
            rotations.normalise(rotations.multiply(turns, orientations)),
        )

    def _settings(self, view: SightView, prior: PosePrior | None, trust: float) -> GatherSettings:
        coloured, deep = view.frame.bins is not None, view.frame.depth is not None
        parameters = self._parameters
        reach = (parameters.reach_m, parameters.reach_rad) if prior is None else prior.reach()
        return GatherSettings(
            wanted=self._wanted & [coloured, coloured, deep],
            reach_m=reach[0],
            reach_rad=reach[1],
            returned=self._returned,
            outline_weight=trust * parameters.outline_point_weight,
            surface_weight=trust * parameters.surface_point_weight,
            sensor=sensor_of(parameters),
            samples=parameters.outline_samples,
            least_step_pixels=parameters.least_step_pixels,
            widest_edge_step=parameters.widest_edge_step,
            contour_error_m=parameters.contour_error_m,
            in_front_per_m=parameters.in_front_per_m,
            behind_per_m=parameters.behind_per_m,
            colour_weight=parameters.surface_colour_weight,
            limb_factor=parameters.surface_limb_factor,
        )
