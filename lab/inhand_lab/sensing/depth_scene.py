"""What a depth sensor has before it, and what every one makes of it alike.

A pixel's depth is taken from a place beside it, noise is in part new in every frame, and some of
the pixels at an edge are lost. Stereo and structured light differ in the rest.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from inhand_runtime.compiled import njit
from inhand_tracker.geometry.arrays import Bytes, Singles

from inhand_lab.sensing.noise_fields import FIELD, NoiseFields, Place, noise_fields
from inhand_lab.sensing.noise_parameters import StereoNoise, StructuredLightNoise


class DepthScene(NamedTuple):
    """Perfect pixels before a depth sensor, which compiled code reads.

    ``colour`` (H, W, 3), ``inverse_depth`` (H, W) in 1/m and ``labels`` (H, W) are a canvas's;
    ``focal`` is the image's focal length in pixels and ``unseen`` the label of what depth does not
    see, 0 if it sees all. Noise is looked up from two places: ``lasting`` stays as long as the
    camera stands still, ``fresh`` is of this frame.
    """

    colour: Bytes
    inverse_depth: Singles
    labels: Bytes
    focal: float
    unseen: int
    lasting: Place
    fresh: Place


def fields_for(noise: StructuredLightNoise | StereoNoise) -> NoiseFields:
    """Fields of noise of a depth sensor's sizes."""
    return noise_fields(noise.grain, noise.lateral_deviation, noise.patch)


@njit(cache=True, nogil=True)
def steps_at_one_metre(noise):  # type: ignore[no-untyped-def]
    """Disparity of what is one metre away, in steps."""
    return np.float32(noise.focal_length * noise.baseline * noise.steps_per_pixel)


@njit(cache=True, nogil=True)
def looked_up(place, v, u):  # type: ignore[no-untyped-def]
    """Row and column of a field for a pixel of an image that begins at a place."""
    return (v + place[0]) & (FIELD - 1), (u + place[1]) & (FIELD - 1)


@njit(cache=True, nogil=True)
def displaced(lateral, at, v, u, shape):  # type: ignore[no-untyped-def]
    """The pixel of the image that a pixel's depth is taken from, by the field's value there."""
    near_v = min(max(v + lateral[at[0], at[1], 0], 0), shape[0] - 1)
    near_u = min(max(u + lateral[at[0], at[1], 1], 0), shape[1] - 1)
    return near_v, near_u


@njit(cache=True, nogil=True)
def steepest(inverse_depth, v, u):  # type: ignore[no-untyped-def]
    """Largest change of inverse depth to the neighbour before and above."""
    inverse = inverse_depth[v, u]
    beside = inverse_depth[v, max(u - 1, 0)]
    above = inverse_depth[max(v - 1, 0), u]
    return max(abs(beside - inverse), abs(above - inverse))


@njit(cache=True, nogil=True)
def shares(fresh_share):  # type: ignore[no-untyped-def]
    """Shares of lasting and fresh noise that together are of unit deviation."""
    return np.float32(np.sqrt(1.0 - fresh_share**2)), np.float32(fresh_share)


@njit(cache=True, nogil=True)
def mixed(axial, lasting_at, fresh_at, fresh_share):  # type: ignore[no-untyped-def]
    """Noise of unit deviation, of which a share is new in every frame."""
    lasting, fresh = shares(fresh_share)
    return lasting * axial[lasting_at[0], lasting_at[1]] + fresh * axial[fresh_at[0], fresh_at[1]]
