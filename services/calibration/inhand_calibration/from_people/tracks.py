"""Each camera's people as smooth movements on the camera's own clock.

A local line is fitted through the frames about each node of a time grid, weighted by confidence, so
that a movement has a place and a velocity at any time, whatever the camera's rate and whatever
frames it dropped, and without a delay.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from inhand_schemas.joints import Joint
from scipy.sparse import csr_array

from inhand_calibration.arrays import Array, Flags, Indices
from inhand_calibration.from_people.parameters import MovementParameters
from inhand_calibration.from_people.skeletons import CameraSkeletons


@dataclass(frozen=True)
class Track:
    """One person's movement in a camera's frame at G nodes, from ``start`` on, by ``step``.

    Times are seconds of the camera's clock after its first frame. ``positions`` and ``velocities``
    are (G, 20, 3), metres and m/s; ``support`` (G, 20) is the weight of the frames about a node, 0
    where a joint is unknown: its position and velocity are 0 there.
    """

    person: int
    start: float
    step: float
    positions: Array
    velocities: Array
    support: Array

    @property
    def end(self) -> float:
        """Time of the last node, seconds."""
        return self.start + self.step * (len(self.support) - 1)

    @property
    def spread(self) -> float:
        """Deviation of the hips from their mean place, metres."""
        seen = self.support[:, Joint.HIP_CENTER] > 0.0
        if not seen.any():
            return 0.0
        return float(np.sqrt(self.positions[seen, Joint.HIP_CENTER].var(axis=0).sum()))


@dataclass(frozen=True)
class Observed:
    """A tracks at K moments: ``positions`` and ``velocities`` (A, K, 20, 3), ``support``
    (A, K, 20)."""

    positions: Array
    velocities: Array
    support: Array


def find_tracks(skeletons: CameraSkeletons, parameters: MovementParameters) -> list[Track]:
    """Return the movements of a camera's people, without those who do not move if others do."""
    if not len(skeletons.times_ns):
        return []
    seconds = (skeletons.times_ns - skeletons.times_ns[0]) * 1e-9
    known = np.isfinite(skeletons.joints).all(axis=2)
    known &= skeletons.confidences >= parameters.least_confidence
    weights = np.where(known, skeletons.confidences, 0.0)
    joints = np.where(known[..., None], skeletons.joints, 0.0)
    tracks = [
        _smooth(int(person), seconds[piece], joints[piece], weights[piece], parameters)
        for person in np.unique(skeletons.people)
        for piece in _pieces(seconds, joints, weights, skeletons.people == person, parameters)
    ]
    tracks.sort(key=lambda track: track.start - track.end)
    spreads = np.array([track.spread for track in tracks[: parameters.most_tracks]])
    moving = spreads >= parameters.least_share_of_way * spreads.max(initial=0.0)
    return [track for track, moves in zip(tracks, moving, strict=False) if moves]


def observe(tracks: Sequence[Track], times: Array) -> Observed:
    """Return tracks at times (K,), seconds of the camera's clock, on lines between their nodes."""
    shape = (len(tracks), len(times), len(Joint))
    positions, velocities, support = np.zeros((*shape, 3)), np.zeros((*shape, 3)), np.zeros(shape)
    for index, track in enumerate(tracks):
        node = (times - track.start) / track.step
        inside = np.flatnonzero((node >= 0.0) & (node < len(track.support) - 1))
        before = node[inside].astype(np.int64)
        share = (node[inside] - before)[:, None, None]
        for result, values in ((positions, track.positions), (velocities, track.velocities)):
            result[index, inside] = (1.0 - share) * values[before] + share * values[before + 1]
        support[index, inside] = np.minimum(track.support[before], track.support[before + 1])
    return Observed(positions, velocities, support)


def _pieces(
    seconds: Array, joints: Array, weights: Array, of_person: Flags, parameters: MovementParameters
) -> list[Indices]:
    """Rows of one person, apart where there is a gap or a jump; short pieces are left out."""
    rows = np.flatnonzero(of_person & (weights[:, Joint.HIP_CENTER] > 0.0))
    if not len(rows):
        return []
    jumps = np.linalg.norm(np.diff(joints[rows, Joint.HIP_CENTER], axis=0), axis=1)
    breaks = (np.diff(seconds[rows]) > parameters.most_gap_s) | (jumps > parameters.most_jump_m)
    pieces = np.split(rows, np.flatnonzero(breaks) + 1)
    return [p for p in pieces if seconds[p[-1]] - seconds[p[0]] >= parameters.least_s]


def _smooth(
    person: int, seconds: Array, joints: Array, weights: Array, parameters: MovementParameters
) -> Track:
    """Local lines at nodes through one person's rows."""
    start, step = float(seconds[0]), parameters.step_s
    nodes = int((seconds[-1] - start) / step) + 1
    reach = int(parameters.reach_s / step)
    nearest = np.rint((seconds - start) / step).astype(np.int64)
    near = nearest[:, None] + np.arange(-reach, reach + 1)
    after = seconds[:, None] - (start + step * near)
    inside = (near >= 0) & (near < nodes)
    row, column = near[inside], np.nonzero(inside)[0]
    kernel = np.exp(-0.5 * (after[inside] / parameters.kernel_s) ** 2)
    moments = [
        csr_array((kernel * after[inside] ** power, (row, column)), shape=(nodes, len(seconds)))
        for power in range(3)
    ]
    zeroth, first, second = (matrix @ weights for matrix in moments)
    flat = (weights[..., None] * joints).reshape(len(seconds), -1)
    value, slope = ((matrix @ flat).reshape(nodes, -1, 3) for matrix in moments[:2])
    aside = np.abs(first) / np.maximum(zeroth, 1e-9)
    determinant = zeroth * second - first**2
    known = (zeroth >= parameters.least_support) & (aside <= parameters.most_aside_s)
    # Two frames at least: one alone has no velocity.
    known &= determinant > (parameters.least_support * 0.1 * parameters.kernel_s) ** 2
    scale = np.where(known, 1.0 / np.where(known, determinant, 1.0), 0.0)[..., None]
    positions = scale * (second[..., None] * value - first[..., None] * slope)
    velocities = scale * (zeroth[..., None] * slope - first[..., None] * value)
    return Track(person, start, step, positions, velocities, np.where(known, zeroth, 0.0))
