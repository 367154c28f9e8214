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

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from inhand_runtime.compiled import njit
from inhand_tracker.geometry.arrays import Singles
from numpy.typing import NDArray

from inhand_lab.sensing.depth_scene import (
    DepthScene,
    displaced,
    fields_for,
    looked_up,
    shares,
    steps_at_one_metre,
)
from inhand_lab.sensing.noise_fields import FIELD, Place
from inhand_lab.sensing.noise_parameters import StructuredLightNoise

MOST_STEPS = 4096
"""Number of disparities whose depths are looked up: down to 9 cm, nearer than is measured."""


class _Lasting(NamedTuple):
    """What stays while a camera stands still, of H x W pixels.

    ``sources`` (H, W) are the numbers of the pixels that depths are taken from, ``errors`` (H, W)
    the part of the noise that is not new in every frame, ``depths`` (D,) what is measured at each
    disparity, in millimetres, 0 of none.
    """

    sources: NDArray[np.int32]
    errors: Singles
    depths: NDArray[np.uint16]


def measure_structured_light_depth(
    scene: DepthScene, noise: StructuredLightNoise
) -> NDArray[np.uint16]:
    """Measure a projector's depth (H, W), millimetres, 0 where nothing was measured."""
    height, width = scene.inverse_depth.shape
    lasting = _lasting(noise, scene.lasting, height, width)
    return np.asarray(_measure(scene, fields_for(noise), lasting, noise))


@lru_cache(maxsize=2)
def _lasting(noise: StructuredLightNoise, place: Place, height: int, width: int) -> _Lasting:
    sources, errors = _find_lasting(fields_for(noise), place, height, width, noise)
    disparities = np.arange(1, MOST_STEPS)
    millimetres = np.float32(1000.0) * steps_at_one_metre(noise) / disparities
    depths = np.concatenate(([0], np.minimum(millimetres, 65535.0))).astype(np.uint16)
    return _Lasting(sources, errors, depths)


@njit(cache=True, nogil=True)
def _find_lasting(fields, place, height, width, noise):  # type: ignore[no-untyped-def]
    sources, errors = np.empty((height, width), np.int32), np.empty((height, width), np.float32)
    lasting_share, _ = shares(noise.fresh)
    for v in range(height):
        for u in range(width):
            at = looked_up(place, v, u)
            near_v, near_u = displaced(fields.lateral, at, v, u, (height, width))
            sources[v, u] = near_v * width + near_u
            errors[v, u] = lasting_share * fields.axial[at]
    return sources, errors


@njit(cache=True, nogil=True)
def _measure(scene, fields, lasting, noise):  # type: ignore[no-untyped-def]
    height, width = scene.inverse_depth.shape
    disparities, deviations = _find_disparities(scene, noise)
    disparities, deviations = disparities.ravel(), deviations.ravel()
    shadowed, places = np.empty(width, np.bool_), np.empty(width)
    _, fresh_share = shares(noise.fresh)
    depth = np.zeros((height, width), np.uint16)
    for v in range(height):
        _find_shadows(scene.inverse_depth[v], scene.focal, noise, places, shadowed)
        sources, errors, measured = lasting.sources[v], lasting.errors[v], depth[v]
        fresh_v, first = looked_up(scene.fresh, v, 0)
        axial, patches = fields.axial[fresh_v], fields.patches[fresh_v]
        for u in range(width):
            disparity = disparities[sources[u]]
            if shadowed[u] or disparity == 0.0:
                continue
            fresh_u = (first + u) & (FIELD - 1)
            if disparity < 0.0:
                if patches[fresh_u] < noise.edge_loss:
                    continue
                disparity = -disparity
            error = errors[u] + fresh_share * axial[fresh_u]
            steps = np.rint(disparity * (1 + deviations[sources[u]] * error))
            measured[u] = lasting.depths[int(min(max(steps, 0.0), MOST_STEPS - 1.0))]
    return depth


@njit(cache=True, nogil=True)
def _find_disparities(scene, noise):  # type: ignore[no-untyped-def]
    """Disparities (H, W) in steps and their relative deviations (H, W).

    A disparity is negative at an edge, and 0 of what is too near, too far or unseen.
    """
    height, width = scene.inverse_depth.shape
    disparities = np.empty((height, width), np.float32)
    deviations = np.empty((height, width), np.float32)
    for v in range(height):
        row, above = scene.inverse_depth[v], scene.inverse_depth[max(v - 1, 0)]
        _find_deviations(row, noise, deviations[v])
        _find_steps(row, above, noise, disparities[v])
        if scene.unseen != 0:
            for u in range(width):
                if scene.labels[v, u] == scene.unseen:
                    disparities[v, u] = 0.0
    return disparities, deviations


@njit(cache=True, nogil=True)
def _find_deviations(inverse_depth, noise, deviations):  # type: ignore[no-untyped-def]
    least, growth = np.float32(noise.least_deviation), np.float32(noise.deviation_growth)
    most_exact = np.float32(noise.most_exact)
    for u in range(len(inverse_depth)):
        inverse = inverse_depth[u]
        beyond = np.float32(1.0) / inverse - most_exact
        deviations[u] = (least + growth * beyond * beyond) * inverse


@njit(cache=True, nogil=True)
def _find_steps(inverse_depth, above, noise, disparities):  # type: ignore[no-untyped-def]
    steps, edge_jump = steps_at_one_metre(noise), noise.edge_jump
    least, most = 1.0 / noise.furthest, 1.0 / noise.nearest
    for u in range(len(inverse_depth)):
        inverse = inverse_depth[u]
        jump = max(abs(inverse_depth[max(u - 1, 0)] - inverse), abs(above[u] - inverse))
        sign = np.float32(-1.0) if jump > edge_jump * inverse else np.float32(1.0)
        seen = inverse >= least and inverse <= most
        disparities[u] = sign * (steps * inverse) if seen else np.float32(0.0)


@njit(cache=True, nogil=True)
def _find_shadows(inverse_depth, focal, noise, places, shadowed):  # type: ignore[no-untyped-def]
    """Find pixels of a row that something nearer hides from the projector.

    ``places`` is where the projector sees each, filled in here.
    """
    parallax, shadow = np.float32(focal * noise.baseline), np.float32(noise.shadow)
    for u in range(len(inverse_depth)):
        places[u] = u - parallax * inverse_depth[u]
    lit_from = 1e9
    for u in range(len(inverse_depth) - 1, -1, -1):
        shadowed[u] = places[u] > lit_from + shadow
        lit_from = min(lit_from, places[u])
