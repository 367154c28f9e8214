"""Depth as a Kinect's projector and infrared camera measure it.

Depth is a disparity in steps of one eighth of a pixel with a baseline of 7.5 cm and a focal length
of 580 pixels (Khoshelham & Elberink, Sensors 2012), so that the step grows with the square of the
distance: 18 mm at 2.5 m. Its noise has an axial deviation of 1.2 mm + 1.9 mm/m^2 (z - 0.4 m)^2 and
a lateral one of 0.8 pixels (Nguyen, Izadi & Lovell, 3DIMPVT 2012), correlated between neighbours
as block matching makes it. Most of it stands still, for the projected dots do: in UTD-MHAD only a
sixth of a resting chest's pixels differ from one frame to the next. Nothing is measured where the
projector, to the right of the camera, casts the shadow of a nearer surface, on some of the pixels
at an edge, on what returns no light, and outside 0.5 to 8 m.
"""

from __future__ import annotations

import numpy as np
from inhand_runtime.compiled import njit
from numpy.typing import NDArray

from inhand_lab.sensing.depth_scene import (
    DepthScene,
    displaced,
    fields_for,
    looked_up,
    mixed,
    steepest,
    steps_at_one_metre,
)
from inhand_lab.sensing.noise_parameters import StructuredLightNoise


def measure_structured_light_depth(
    scene: DepthScene, noise: StructuredLightNoise
) -> NDArray[np.uint16]:
    """Measure a projector's depth (H, W), millimetres, 0 where nothing was measured."""
    return np.asarray(_measure(scene, fields_for(noise), noise))


@njit(cache=True, nogil=True)
def _measure(scene, fields, noise):  # type: ignore[no-untyped-def]
    inverse_depth = scene.inverse_depth
    height, width = inverse_depth.shape
    depth = np.zeros((height, width), np.uint16)
    steps = steps_at_one_metre(noise)
    parallax = np.float32(scene.focal * noise.baseline)
    for v in range(height):
        lit_from = np.float32(1e9)
        for u in range(width - 1, -1, -1):
            from_projector = u - parallax * inverse_depth[v, u]
            shadowed = from_projector > lit_from + np.float32(noise.shadow)
            lit_from = min(lit_from, from_projector)
            lasting, fresh = looked_up(scene.lasting, v, u), looked_up(scene.fresh, v, u)
            near = displaced(fields.lateral, lasting, v, u, (height, width))
            inverse = inverse_depth[near]
            if shadowed or inverse < 1.0 / noise.furthest or inverse > 1.0 / noise.nearest:
                continue
            if scene.unseen != 0 and scene.labels[near] == scene.unseen:
                continue
            jump = steepest(inverse_depth, near[0], near[1])
            if jump > noise.edge_jump * inverse and fields.patches[fresh] < noise.edge_loss:
                continue
            beyond = np.float32(1.0) / inverse - np.float32(noise.most_exact)
            growth = np.float32(noise.deviation_growth) * beyond * beyond
            deviation = np.float32(noise.least_deviation) + growth
            error = mixed(fields.axial, lasting, fresh, noise.fresh)
            disparity = steps * inverse * (1 + deviation * inverse * error)
            depth[v, u] = np.uint16(np.float32(1000.0) * steps / np.rint(disparity))
    return depth
