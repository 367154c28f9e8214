"""How likely a measured depth is where a surface of the object would be, as a table."""

import numpy as np

from inhand_tracker.geometry.arrays import Singles
from inhand_tracker.sight.kernels.inputs import Sensor
from inhand_tracker.sight.kernels.projection import depth_noise
from inhand_tracker.sight.kernels.weigh import (
    DEPTH_COLUMNS,
    DEPTH_COLUMNS_PER_NOISE,
    DEPTH_ROWS,
    DEPTH_ROWS_PER_M,
)
from inhand_tracker.sight.parameters import SightParameters


def sensor_of(parameters: SightParameters) -> Sensor:
    """The sensor as kernels take it."""
    return Sensor(
        np.float32(parameters.depth_noise_m),
        np.float32(parameters.depth_noise_per_m),
        np.float32(parameters.covered_m),
    )


def depth_table(returned: float, behind: float, parameters: SightParameters) -> Singles:
    """(DEPTH_ROWS, DEPTH_COLUMNS): log how many times likelier a measured depth is for a surface
    of the object there, by how far away the surface is and how far behind it was measured.

    ``returned`` and ``behind`` are those of ``Appearance``. What is in front may hide the object
    as well as anything else, and says nothing (a mixture as of Wüthrich et al. 2013).
    """
    sensor = sensor_of(parameters)
    depths = (np.arange(DEPTH_ROWS)[:, None] + 0.5) / DEPTH_ROWS_PER_M
    noise = depth_noise(sensor.noise_m, sensor.noise_per_m, depths)
    off = (np.arange(DEPTH_COLUMNS) - DEPTH_COLUMNS // 2) / DEPTH_COLUMNS_PER_NOISE
    near = np.exp(-0.5 * off**2) / (np.sqrt(2.0 * np.pi) * noise)
    error = max(behind / parameters.background_measured, parameters.least_behind)
    other = np.where(off < 0.0, 1.0, error)
    return np.log(returned * near / parameters.clutter_per_m + other).astype(np.float32)
