"""Pouring from a jug: how far it was tilted, for how long, and how much left it."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inhand_outcomes.achievement import Achievement, Amount
from inhand_outcomes.measures.emptying import (
    EmptyingParameters,
    deepest_tilt,
    raises,
    tilt_evidence,
    tilts,
    with_volumes,
)
from inhand_outcomes.measures.face import middle_of
from inhand_outcomes.measures.spells import find_spells, smoothed, speeds, sureness
from inhand_outcomes.measures.vessels import inside_of
from inhand_outcomes.thing import Thing
from inhand_outcomes.track import Track


@dataclass(frozen=True)
class PouringParameters:
    """What a pour is."""

    tilt: float = np.radians(28.0)
    """Tilt towards the spout that a pour reaches, radians: jugs are carried below 15 degrees."""
    level: float = np.radians(22.0)
    """Tilt at which it begins and ends, radians: a jug that is three quarters full pours."""
    raise_again: float = np.radians(16.0)
    """How far, radians, a tilt must fall and rise again for another pour."""
    towards: float = np.radians(60.0)
    """Largest angle, radians, between the tilt and the spout."""
    swift_m_s: float = 0.4
    """Speed of the spout above which nobody pours: it is held over what is filled."""
    calm_s: float = 0.15
    """Deviation of the bell by which the spout's places are averaged, seconds."""
    least_s: float = 0.3
    """Seconds that a pour takes at least."""
    smoothing_s: float = 0.08
    """Deviation of the bell by which tilts are averaged, seconds."""
    longest_gap_s: float = 0.4
    """Seconds unseen that do not end a pour."""
    edge_s: float = 0.1
    """Standard deviation of when it begins and of when it ends, seconds."""


DEFAULT_POURING = PouringParameters()
POURS = EmptyingParameters("pour", usual=Amount(20.0, 10.0))
"""Volume of a pour whose beginning is not known, millilitres: a serving of cream is 15 ml, a
    tablespoon (21 CFR 101.12), and people pour more."""


def pouring(track: Track, thing: Thing) -> list[Achievement]:
    """Pours with their angles and durations; ``pour_volumes`` tells how much they were."""
    parameters = DEFAULT_POURING
    inside = inside_of(thing)
    tip = thing.part("spout", "+y")
    spout = tip - middle_of(thing.vertices)
    tilt, low, deviation = tilts(track)
    smooth = smoothed(track.times, tilt, track.seen, parameters.smoothing_s)
    aside = np.abs(np.angle(np.exp(1j * (low - np.arctan2(spout[1], spout[0])))))
    places = smoothed(track.times, track.points(tip), track.seen, parameters.calm_s)
    with np.errstate(invalid="ignore"):
        calm = speeds(track.times, places) < parameters.swift_m_s
        ahead = calm & (aside < parameters.towards)
        inner, outer = (smooth > parameters.tilt) & ahead, (smooth > parameters.level) & ahead
    spread = np.maximum(deviation, np.radians(2.0))
    margins = np.minimum((smooth - parameters.level), parameters.towards - aside) / spread
    found = []
    for spell in find_spells(track.times, inner, outer, track.seen, parameters.longest_gap_s):
        if not (spell.begun and spell.ended):
            continue
        for pour in raises(spell, track.times, smooth, track.seen, parameters.raise_again):
            if pour.seconds < parameters.least_s:
                continue
            deepest = deepest_tilt(pour, track.times, smooth, low, deviation, track.seen)
            angle, spread_deg = np.degrees([deepest.deepest, deepest.deviation]).tolist()
            found.append(
                Achievement(
                    "pour",
                    pour.start_s,
                    pour.end_s,
                    sureness(pour, track.seen, margins, best=0.5),
                    amounts={
                        "angle_deg": Amount(angle, spread_deg),
                        "duration_s": Amount(pour.seconds, 1.5 * parameters.edge_s),
                    },
                    evidence=tilt_evidence(inside, deepest, POURS),
                )
            )
    return found


def pour_volumes(found: Sequence[Achievement], earlier: Sequence[Achievement]) -> list[Achievement]:
    """Pours with how much they were, and refills, by what earlier pours had left."""
    return with_volumes(found, earlier, POURS)
