"""Playing: a flute at the lips."""

from dataclasses import dataclass

import numpy as np

from inhand_outcomes.achievement import Achievement
from inhand_outcomes.arrays import Array
from inhand_outcomes.measures.face import DEFAULT_FACE, find_face
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
class PlayingParameters:
    """What playing is."""

    near_m: float = 0.12
    """Distance of the mouth hole from the mouth at which it is there: a flute's pose is off by 3 to
    6 cm, for it is thin and shines."""
    away_m: float = 0.17
    """The same at which it has left: between two pieces a flute is lowered by more than 20 cm."""
    steep: float = np.radians(55.0)
    """Largest slope of the flute, radians."""
    hole: float = 0.10
    """Place of the mouth hole along the flute, from its end, as a share of its length."""
    smoothing_s: float = 0.15
    """Deviation of the bell by which distances are averaged, seconds."""
    longest_gap_s: float = 0.6
    """Seconds unseen, or away by error, that do not end it."""
    least_s: float = 0.5
    """Seconds of the shortest piece."""
    edge_s: float = 0.15
    """Standard deviation of when it begins and of when it ends, seconds."""


DEFAULT_PLAYING = PlayingParameters()


def playing(track: Track, thing: Thing) -> list[Achievement]:
    """Times of playing with their durations."""
    parameters = DEFAULT_PLAYING
    face = find_face(track)
    usable = track.seen & face.seen
    hole, axis = mouth_hole(thing, parameters)
    distance = np.linalg.norm(track.points(hole) - face.mouth, axis=1)
    distance = smoothed(track.times, distance, usable, parameters.smoothing_s)
    slope = np.abs(np.arcsin(np.clip(track.directions(axis)[:, 2], -1.0, 1.0)))
    with np.errstate(invalid="ignore"):
        level = slope < parameters.steep
        inner = (distance < parameters.near_m) & level
        outer = (distance < parameters.away_m) & level
    spread = np.hypot(track.point_deviations(hole), DEFAULT_FACE.deviation_m)
    margins = (parameters.away_m - distance) / spread
    spells = find_spells(track.times, inner, outer, usable, parameters.longest_gap_s)
    return [
        lasting_act(
            "playing",
            spell,
            sureness(spell, usable, margins),
            parameters.edge_s,
            {
                "hole_to_mouth_m": float(np.nanmedian(distance[spell.frames])),
                "seen_share": float(np.mean(usable[spell.frames])),
            },
        )
        for spell in lasting_spells(spells, parameters.least_s)
    ]


def mouth_hole(
    thing: Thing, parameters: PlayingParameters = DEFAULT_PLAYING
) -> tuple[Array, Array]:
    """The hole that is blown (3,) and the flute's axis (3,): the part ``mouth_hole``, or else a
    place near the end towards -y, or the lower end of a flute that was taught along another axis.
    """
    longest = int(np.argmax(np.ptp(thing.vertices, axis=0)))
    axis = np.eye(3)[longest]
    low, high = thing.vertices.min(axis=0), thing.vertices.max(axis=0)
    usual = 0.5 * (low + high)
    usual[longest] = low[longest] + parameters.hole * (high - low)[longest]
    return thing.parts.get("mouth_hole", usual), axis
