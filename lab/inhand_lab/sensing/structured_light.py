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

from functools import cache, lru_cache
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
from inhand_lab.sensing.disparities import Area, find_disparities, shade
from inhand_lab.sensing.noise_fields import FIELD, Place
from inhand_lab.sensing.noise_parameters import StructuredLightNoise

MOST_STEPS = 4096
"""Number of disparities whose depths are looked up: down to 9 cm, nearer than is measured."""

TO_WHOLE = 2.0**52
"""Number that rounds another when it is added and taken away: no float64 beyond has a fraction."""


class _Lasting(NamedTuple):
    """What stays while a camera stands still, of H x W pixels.

    ``sources`` (H, W, 2) are the rows and columns from a pixel to the one that its depth is taken
    from, ``errors`` (H, W) the part of the noise that is not new in every frame, ``depths`` (D,)
    what is measured at each disparity, in millimetres, 0 of none.
    """

    sources: NDArray[np.int8]
    errors: Singles
    depths: NDArray[np.uint16]


class StillRoom(NamedTuple):
    """What a projector's sensor reads of a room that stands still, before this frame's noise.

    ``disparities`` (H, W) in steps are those that a pixel takes from its source, negative at an
    edge and 0 where nothing is measured; ``deviations`` (H, W) are relative to them.
    """

    disparities: Singles
    deviations: Singles


def read_still_room(scene: DepthScene, noise: StructuredLightNoise) -> StillRoom:
    """Read a room alone, once for all frames of a camera that stands still.

    Of the scene nothing that is new in every frame counts.
    """
    height, width = scene.inverse_depth.shape
    lasting = _lasting(noise, scene.lasting, height, width)
    return StillRoom(*_read_room(scene, lasting, noise))


def measure_structured_light_depth(
    scene: DepthScene,
    noise: StructuredLightNoise,
    still: StillRoom | None = None,
    drawn: Area | None = None,
) -> NDArray[np.uint16]:
    """Measure a projector's depth (H, W), millimetres, 0 where nothing was measured.

    Outside the area ``drawn`` the scene is the ``still`` room, which need not be read again;
    without them all of it is read.
    """
    height, width = scene.inverse_depth.shape
    lasting = _lasting(noise, scene.lasting, height, width)
    fields = fields_for(noise)
    if still is None or drawn is None:
        still, drawn = StillRoom(*np.empty((2, height, 0), np.float32)), (0, height, 0, width)
    # A pixel's depth comes from a place beside it, whose neighbours say whether it is at an edge.
    reach = _furthest_source(noise)
    changed = _grown(drawn, reach + 1, height, width)
    read = _grown(changed, reach, height, width)
    return np.asarray(_measure(scene, fields, lasting, still, changed, read, noise))


def _grown(area: Area, pixels: int, height: int, width: int) -> Area:
    top, bottom, left, right = area
    return (
        max(top - pixels, 0),
        min(bottom + pixels, height),
        max(left - pixels, 0),
        min(right + pixels, width),
    )


@cache
def _furthest_source(noise: StructuredLightNoise) -> int:
    """Rows or columns between a pixel and the farthest one that its depth is taken from."""
    return int(np.abs(fields_for(noise).lateral).max())


@lru_cache(maxsize=2)
def _lasting(noise: StructuredLightNoise, place: Place, height: int, width: int) -> _Lasting:
    sources, errors = _find_lasting(fields_for(noise), place, height, width, noise)
    disparities = np.arange(1, MOST_STEPS)
    millimetres = np.float32(1000.0) * steps_at_one_metre(noise) / disparities
    depths = np.concatenate(([0], np.minimum(millimetres, 65535.0))).astype(np.uint16)
    return _Lasting(sources, errors, depths)


@njit(cache=True, nogil=True)
def _find_lasting(fields, place, height, width, noise):  # type: ignore[no-untyped-def]
    sources, errors = np.empty((height, width, 2), np.int8), np.empty((height, width), np.float32)
    lasting_share, _ = shares(noise.fresh)
    for v in range(height):
        for u in range(width):
            at = looked_up(place, v, u)
            near_v, near_u = displaced(fields.lateral, at, v, u, (height, width))
            sources[v, u, 0], sources[v, u, 1] = near_v - v, near_u - u
            errors[v, u] = lasting_share * fields.axial[at]
    return sources, errors


@njit(cache=True, nogil=True)
def _measure(scene, fields, lasting, still, changed, read, noise):  # type: ignore[no-untyped-def]
    """Measure all pixels; outside the area that ``changed`` they are the still room's.

    ``read`` is the area of those that depths in there are taken from.
    """
    height, width = scene.inverse_depth.shape
    top, bottom, left, right = changed
    disparities, deviations = find_disparities(scene, read, noise)
    row, relative = np.empty(width, np.float32), np.empty(width, np.float32)
    depth = np.empty((height, width), np.uint16)
    for v in range(height):
        if top <= v < bottom:
            for u in range(left):
                row[u], relative[u] = still.disparities[v, u], still.deviations[v, u]
            for u in range(right, width):
                row[u], relative[u] = still.disparities[v, u], still.deviations[v, u]
            _take(disparities, deviations, lasting.sources[v], v, read, left, right, row, relative)
            shade(scene.inverse_depth[v], scene.focal, noise, left, right, row)
            _add_noise(row, relative, scene, fields, lasting, v, noise, depth[v])
        else:
            _add_noise(
                still.disparities[v],
                still.deviations[v],
                scene,
                fields,
                lasting,
                v,
                noise,
                depth[v],
            )
    return depth


@njit(cache=True, nogil=True)
def _read_room(scene, lasting, noise):  # type: ignore[no-untyped-def]
    height, width = scene.inverse_depth.shape
    whole = 0, height, 0, width
    disparities, deviations = find_disparities(scene, whole, noise)
    taken, relative = np.empty_like(disparities), np.empty_like(deviations)
    for v in range(height):
        sources = lasting.sources[v]
        _take(disparities, deviations, sources, v, whole, 0, width, taken[v], relative[v])
        shade(scene.inverse_depth[v], scene.focal, noise, 0, width, taken[v])
    return taken, relative


@njit(cache=True, nogil=True)
def _take(disparities, deviations, sources, v, read, left, right, row, relative):  # type: ignore[no-untyped-def]
    """Take disparities and deviations, of the area that was read, for some columns of a row."""
    first_v, first_u = v - read[0], -read[2]
    for u in range(left, right):
        near_v, near_u = first_v + sources[u, 0], first_u + u + sources[u, 1]
        row[u], relative[u] = disparities[near_v, near_u], deviations[near_v, near_u]


@njit(cache=True, nogil=True)
def _add_noise(disparities, deviations, scene, fields, lasting, v, noise, measured):  # type: ignore[no-untyped-def]
    """Measure a row: the fields repeat, so that it is one stretch of them or several."""
    width, u = len(disparities), 0
    while u < width:
        fresh_v, fresh_u = looked_up(scene.fresh, v, u)
        until = min(u + FIELD - fresh_u, width)
        after = fresh_u + until - u
        _add_noise_of(
            fields.axial[fresh_v, fresh_u:after],
            fields.patches[fresh_v, fresh_u:after],
            lasting.errors[v, u:until],
            disparities[u:until],
            deviations[u:until],
            lasting.depths,
            noise,
            measured[u:until],
        )
        u = until


@njit(cache=True, nogil=True)
def _add_noise_of(axial, patches, errors, disparities, deviations, depths, noise, measured):  # type: ignore[no-untyped-def]
    _, fresh_share = shares(noise.fresh)
    edge_loss, most = noise.edge_loss, MOST_STEPS - 1.0
    steps = np.empty(len(measured), np.int32)
    # Two loops, for the first one has no look-up in it and is done for several pixels at once.
    for u in range(len(measured)):
        disparity = disparities[u]
        error = errors[u] + fresh_share * axial[u]
        step = np.float64(abs(disparity)) * (1.0 + np.float64(deviations[u] * error))
        whole = (step + TO_WHOLE) - TO_WHOLE
        bounded = 0.0 if whole < 0.0 else (most if whole > most else whole)
        kept = (disparity >= 0.0) | (patches[u] >= edge_loss)
        steps[u] = np.int32(bounded) if kept else np.int32(0)
    for u in range(len(measured)):
        measured[u] = depths[np.uint32(steps[u])]
