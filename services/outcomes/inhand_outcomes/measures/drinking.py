"""Drinking from a mug: sips, how much each was, and refills."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from inhand_schemas.joints import Joint

from inhand_outcomes.achievement import Achievement, Amount
from inhand_outcomes.arrays import Array
from inhand_outcomes.measures.emptying import (
    EmptyingParameters,
    deepest_tilt,
    raises,
    tilt_evidence,
    tilts,
    with_volumes,
)
from inhand_outcomes.measures.face import DEFAULT_FACE, find_face
from inhand_outcomes.measures.spells import find_spells, smoothed, sureness
from inhand_outcomes.measures.vessels import inside_of
from inhand_outcomes.thing import Thing
from inhand_outcomes.track import Track


@dataclass(frozen=True)
class DrinkingParameters:
    """What a sip is."""

    near_m: float = 0.085
    """Distance of the mug's lip from the mouth at which it is there: poses and mouths are off by
    2 to 3 cm each, and a mug before the chest or looked into from above is 15 cm away."""
    away_m: float = 0.125
    """The same at which it has left."""
    tilt: float = np.radians(17.0)
    """Tilt of a sip, radians: a mug that is filled to a finger below its rim pours at 15 degrees,
    and one that is carried stays below 10."""
    level: float = np.radians(14.0)
    """Tilt at which a sip is over, radians."""
    raise_again: float = np.radians(17.0)
    """How far, radians, a tilt must fall and rise again for another sip at the mouth."""
    towards: float = np.radians(75.0)
    """Largest angle, radians, between where the mug is tilted and where who drinks is."""
    least_s: float = 0.35
    """Seconds that a sip takes at least; a swallow takes one."""
    smoothing_s: float = 0.12
    """Deviation of the bell by which tilts are averaged, seconds."""
    longest_gap_s: float = 0.6
    """Seconds unseen, or apart from the mouth by error, that do not end a sip."""


DEFAULT_DRINKING = DrinkingParameters()
SIPS = EmptyingParameters("sip", usual=Amount(20.0, 8.0))
"""Volume of a sip whose beginning is not known, millilitres: 25 in men and 20 in women from a
    cup (Adnerhill et al., 1989; Lawless et al., 2003), 16 where nobody looked (Bennett et al.,
    2009)."""


def drinking(track: Track, thing: Thing) -> list[Achievement]:
    """Sips with the tilts by which ``sip_volumes`` tells how much they were."""
    parameters = DEFAULT_DRINKING
    inside = inside_of(thing)
    rim = thing.part("rim", "+z") if inside is None else inside.rim
    radius = 0.04 if inside is None else inside.radius
    face = find_face(track)
    usable = track.seen & face.seen
    tilt, low, deviation = tilts(track)
    to_mouth, aside = _lip(track, rim, radius, face.mouth)
    tilt_smooth = smoothed(track.times, tilt, usable, parameters.smoothing_s)
    away = smoothed(track.times, to_mouth, usable, parameters.smoothing_s)
    with np.errstate(invalid="ignore"):
        leaning = (aside < parameters.towards) | (tilt_smooth < parameters.tilt)
        inner = (away < parameters.near_m) & (tilt_smooth > parameters.tilt) & leaning
        outer = (away < parameters.away_m) & (tilt_smooth > parameters.level) & leaning
    spread = np.hypot(track.point_deviations(rim), DEFAULT_FACE.deviation_m)
    margins = np.minimum(
        (parameters.away_m - away) / spread,
        (tilt_smooth - parameters.level) / np.maximum(deviation, np.radians(2.0)),
    )
    found = []
    for spell in find_spells(track.times, inner, outer, usable, parameters.longest_gap_s):
        if not (spell.begun and spell.ended):
            continue
        for sip in raises(spell, track.times, tilt_smooth, usable, parameters.raise_again):
            if sip.seconds < parameters.least_s:
                continue
            deepest = deepest_tilt(sip, track.times, tilt_smooth, low, deviation, usable)
            nearest = float(np.nanmin(away[sip.frames]))
            found.append(
                Achievement(
                    "sip",
                    sip.start_s,
                    sip.end_s,
                    sureness(sip, usable, margins, best=0.5),
                    evidence={
                        "lip_to_mouth_m": nearest,
                        **tilt_evidence(inside, deepest, SIPS),
                    },
                )
            )
    return found


def sip_volumes(found: Sequence[Achievement], earlier: Sequence[Achievement]) -> list[Achievement]:
    """Sips with how much they were, and refills, by what earlier sips had left."""
    return with_volumes(found, earlier, SIPS)


def _lip(track: Track, rim: Array, radius: float, mouth: Array) -> tuple[Array, Array]:
    """Distance (T,) from the mouth to the nearest point of the rim, metres, and the angle (T,)
    about the vertical from the direction of the tilt to who drinks, radians.

    They are where the neck is: a mouth that a mug hides is off by as much as the two are apart.
    """
    middle = track.points(rim)
    axis = track.directions(np.array([0.0, 0.0, 1.0]))
    way = mouth - middle
    across = way - np.sum(way * axis, axis=1, keepdims=True) * axis
    length = np.linalg.norm(across, axis=1, keepdims=True)
    nearest = middle + across * (radius / np.maximum(length, 1e-9))
    neck = track.joint(Joint.SHOULDER_CENTER)
    way = np.where(np.isfinite(neck), neck, mouth) - middle
    leaning = np.arctan2(axis[:, 1], axis[:, 0]) - np.arctan2(way[:, 1], way[:, 0])
    return np.linalg.norm(mouth - nearest, axis=1), np.abs(np.angle(np.exp(1j * leaning)))
