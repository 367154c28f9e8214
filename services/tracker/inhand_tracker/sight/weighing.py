"""Weighing poses of one object by every term of a frame, in several threads."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np

from inhand_tracker.geometry.arrays import Array, Flags
from inhand_tracker.sight.depth_table import depth_table, sensor_of
from inhand_tracker.sight.kernels.inputs import Outlines
from inhand_tracker.sight.kernels.weigh import VISIBLE, WeighSettings, weigh
from inhand_tracker.sight.parameters import SightParameters
from inhand_tracker.sight.view import SightView


class PoseWeigher:
    """Weighs poses of one object by the ``wanted`` (4,) terms of a view.

    ``returned`` and ``behind`` are those of ``Appearance``; many poses are weighed in several
    ``threads``.
    """

    def __init__(
        self,
        outlines: Outlines,
        wanted: Flags,
        measured: tuple[float, float],
        parameters: SightParameters,
        threads: int = 1,
    ) -> None:
        self._outlines = outlines
        self._wanted = wanted
        self._usual = _usual_settings(wanted, measured, parameters)
        self._parameters = parameters
        self._threads = threads
        self._pool = ThreadPoolExecutor(threads)

    def scores(self, translations: Array, orientations: Array, view: SightView) -> Array:
        """Return what ``weigh`` finds of poses (P, 3) and (P, 4), (P, 5)."""
        pixels, settings = view.pixels, self._settings(view)
        scores = np.zeros((len(translations), VISIBLE + 1), np.float32)

        def weigh_some(part: slice) -> None:
            weigh(
                np.ascontiguousarray(translations[part], np.float32),
                np.ascontiguousarray(orientations[part], np.float32),
                self._outlines,
                pixels,
                settings,
                scores[part],
            )

        share = max(self._parameters.fewest_in_thread, -(-len(scores) // self._threads))
        parts = [slice(start, start + share) for start in range(0, len(scores), share)]
        if len(parts) > 1:
            list(self._pool.map(weigh_some, parts))
        elif parts:
            weigh_some(parts[0])
        return scores.astype(float)

    def _settings(self, view: SightView) -> WeighSettings:
        coloured, deep = view.frame.bins is not None, view.frame.depth is not None
        return self._usual._replace(wanted=self._wanted & [coloured, coloured, coloured, deep])


def _usual_settings(
    wanted: Flags, measured: tuple[float, float], parameters: SightParameters
) -> WeighSettings:
    """The settings of a frame that shows all."""
    return WeighSettings(
        wanted,
        depth_table(*measured, parameters),
        sensor_of(parameters),
        np.float32(parameters.limb_weight),
        np.float32(1.0) / np.float32(parameters.usual_pixels),
        np.float32(parameters.least_outline_scale),
        np.float32(parameters.most_outline_scale),
        np.float32(parameters.least_interior_scale),
        np.float32(parameters.most_interior_scale),
    )
