"""Calls: a phone at an ear."""

from dataclasses import dataclass

import numpy as np

from inhand_outcomes.achievement import Achievement
from inhand_outcomes.measures.face import DEFAULT_FACE, find_face, middle_of, thin_axis
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
class PhoningParameters:
    """What a call is."""

    near_m: float = 0.155
    """Distance of the phone's middle from the middle of the head at an ear: it is 9 cm, and poses
    of phones are off by 3 cm; one before the eyes is 30 cm away."""
    away_m: float = 0.20
    """The same at which it has left."""
    ahead: float = 0.8
    """Largest share of that distance that is straight ahead: a phone before the mouth, into which
    somebody dictates, is at no ear."""
    smoothing_s: float = 0.15
    """Deviation of the bell by which distances are averaged, seconds."""
    longest_gap_s: float = 1.2
    """Seconds unseen, or away by error, that do not end a call: hand and head hide a phone."""
    least_s: float = 0.7
    """Seconds of the shortest call: a phone that passes the head is there for less."""
    edge_s: float = 0.15
    """Standard deviation of when it begins and of when it ends, seconds."""


DEFAULT_PHONING = PhoningParameters()


def phoning(track: Track, thing: Thing) -> list[Achievement]:
    """Calls with their durations."""
    parameters = DEFAULT_PHONING
    face = find_face(track)
    usable = track.seen & face.seen
    middle = middle_of(thing.vertices)
    way = track.points(middle) - face.middle
    distance = np.linalg.norm(way, axis=1)
    ahead = np.sum(way * face.forward, axis=1) / np.maximum(distance, 1e-9)
    distance = smoothed(track.times, distance, usable, parameters.smoothing_s)
    ahead = smoothed(track.times, ahead, usable, parameters.smoothing_s)
    with np.errstate(invalid="ignore"):
        beside = ahead < parameters.ahead
        inner = (distance < parameters.near_m) & beside
        outer = (distance < parameters.away_m) & beside
    spread = np.hypot(track.point_deviations(middle), 0.5 * DEFAULT_FACE.deviation_m)
    margins = (parameters.away_m - distance) / spread
    flat = np.abs(np.sum(track.directions(thin_axis(thing.vertices)) * way, axis=1)) / np.maximum(
        np.linalg.norm(way, axis=1), 1e-9
    )
    spells = find_spells(track.times, inner, outer, usable, parameters.longest_gap_s)
    return [
        lasting_act(
            "call",
            spell,
            sureness(spell, usable, margins),
            parameters.edge_s,
            {
                "head_to_phone_m": float(np.nanmedian(distance[spell.frames])),
                "seen_share": float(np.mean(usable[spell.frames])),
                "facing_share": float(np.median(flat[spell.frames])),
            },
        )
        for spell in lasting_spells(spells, parameters.least_s)
    ]
