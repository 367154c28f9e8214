"""Filming: a camera that is held before the face, and where it points."""

from dataclasses import dataclass, replace

import numpy as np

from inhand_outcomes.achievement import Achievement, Amount
from inhand_outcomes.arrays import Array
from inhand_outcomes.measures.face import (
    DEFAULT_FACE,
    find_face,
    middle_of,
    nearest_hands,
)
from inhand_outcomes.measures.spells import (
    find_spells,
    lasting_act,
    lasting_spells,
    smoothed,
    sureness,
)
from inhand_outcomes.thing import Thing
from inhand_outcomes.track import Track


@dataclass(frozen=True)
class FilmingParameters:
    """What filming is."""

    below_m: float = 0.15
    """How far below the middle of the head the camera is at most: one that waits before the chest
    is 35 cm below, one at the eyes or overhead is above."""
    left_m: float = 0.22
    """The same at which it has been lowered."""
    reach_m: float = 0.75
    """Distance from the head at most: a stretched arm."""
    hand_m: float = 0.20
    """Distance of its middle from a hand at most, beyond half of its largest extent."""
    steep: float = np.radians(45.0)
    """Largest elevation of where it points, radians: steeper is looking at it or carrying it."""
    smoothing_s: float = 0.12
    """Deviation of the bell by which places are averaged, seconds."""
    longest_gap_s: float = 0.8
    """Seconds unseen, or lowered by error, that do not end it."""
    least_s: float = 0.7
    """Seconds of the shortest take."""
    edge_s: float = 0.15
    """Standard deviation of when it begins and of when it ends, seconds."""


DEFAULT_FILMING = FilmingParameters()


def filming(track: Track, thing: Thing) -> list[Achievement]:
    """Takes with their durations and mean directions.

    ``azimuth_deg`` is the turn of the direction in which it points, 0 to 360 to the left from the
    room's y axis, which goes away from the rig's camera; ``elevation_deg`` is above the level.
    """
    parameters = DEFAULT_FILMING
    face = find_face(track)
    usable = track.seen & face.seen
    middle = middle_of(thing.vertices)
    axis = thing.part("lens", "+y") - middle
    axis = np.eye(3)[int(np.argmax(np.abs(axis)))] * np.sign(axis[np.argmax(np.abs(axis))])
    pointing = track.directions(axis)
    place = track.points(middle)
    way = place - face.middle
    below = smoothed(track.times, -way[:, 2], usable, parameters.smoothing_s)
    hands = nearest_hands(track, place) - 0.5 * float(np.ptp(thing.vertices, axis=0).max())
    elevation = np.arcsin(np.clip(pointing[:, 2], -1.0, 1.0))
    elevation = smoothed(track.times, elevation, usable, parameters.smoothing_s)
    with np.errstate(invalid="ignore"):
        held = (hands < parameters.hand_m) & (np.linalg.norm(way, axis=1) < parameters.reach_m)
        held &= (np.abs(elevation) < parameters.steep) & (np.sum(pointing * way, axis=1) > 0.0)
        inner, outer = (below < parameters.below_m) & held, (below < parameters.left_m) & held
    spread = np.hypot(track.point_deviations(middle), 0.5 * DEFAULT_FACE.deviation_m)
    turning = np.maximum(track.turn_deviations(), np.radians(2.0))
    margins = np.minimum(
        (parameters.left_m - below) / spread, (parameters.steep - np.abs(elevation)) / turning
    )
    found = []
    spells = find_spells(track.times, inner, outer, usable, parameters.longest_gap_s)
    for spell in lasting_spells(spells, parameters.least_s):
        seen = pointing[spell.frames][usable[spell.frames]]
        deviation = float(np.degrees(np.mean(turning[spell.frames])))
        azimuth, mean_elevation = _direction(seen)
        act = lasting_act(
            "filming",
            spell,
            sureness(spell, usable, margins),
            parameters.edge_s,
            {
                "below_head_m": float(np.nanmedian(below[spell.frames])),
                "seen_share": float(np.mean(usable[spell.frames])),
            },
        )
        directions = {
            "azimuth_deg": Amount(azimuth, deviation),
            "elevation_deg": Amount(mean_elevation, deviation),
        }
        found.append(replace(act, amounts={**act.amounts, **directions}))
    return found


def _direction(pointing: Array) -> tuple[float, float]:
    """Mean azimuth, 0 to 360 to the left from y, and elevation of directions (T, 3), degrees."""
    x, y, z = pointing.mean(axis=0)
    return float(np.degrees(np.arctan2(-x, y)) % 360.0), float(
        np.degrees(np.arctan2(z, np.hypot(x, y)))
    )
