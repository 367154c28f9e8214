"""Glasses: worn, put on, taken off."""

from dataclasses import dataclass

import numpy as np

from inhand_outcomes.achievement import Achievement
from inhand_outcomes.arrays import Array
from inhand_outcomes.measures.face import find_face, nearest_hands
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
class WearingParameters:
    """What wearing glasses is."""

    near_m: float = 0.15
    """Distance of their bridge from the middle of the head at which they are on: it is 11 cm."""
    away_m: float = 0.185
    """The same at which they are off."""
    ahead: float = 0.5
    """Least share of that distance that is straight ahead: heads turn."""
    above_m: float = 0.085
    """Height of the bridge above the middle of the head at most: above it they are in the hair."""
    below_m: float = 0.085
    """How far it is below at most: below it they hang from a collar."""
    facing: float = 0.4
    """Least cosine of the angle between where the glasses and the face look: whoever chews at a
    temple holds them aside."""
    smoothing_s: float = 0.12
    """Deviation of the bell by which distances are averaged, seconds."""
    longest_gap_s: float = 1.2
    """Seconds unseen, or off by error, that do not end it."""
    least_s: float = 0.8
    """Seconds of the shortest wear."""
    act_s: float = 0.5
    """Seconds that putting them on or taking them off is said to take, up to when they are."""
    hand_m: float = 0.20
    """Distance of a hand within which it puts them on or takes them off."""
    hand_s: float = 0.6
    """Seconds before and after within which it must have been there."""
    handless: float = 0.3
    """Factor on the probability of what no hand was seen to do."""
    deviation_m: float = 0.02
    """Standard deviation of the distance beside that of the pose: heads differ."""
    edge_s: float = 0.15
    """Standard deviation of when they are on and of when they are off, seconds."""


DEFAULT_WEARING = WearingParameters()


def wearing(track: Track, thing: Thing) -> list[Achievement]:
    """Times of wearing with their durations, and when glasses were put on and taken off."""
    parameters = DEFAULT_WEARING
    face = find_face(track)
    usable = track.seen & face.seen
    bridge = thing.part("bridge", "+y")
    place = track.points(bridge)
    way = smoothed(track.times, place - face.middle, usable, parameters.smoothing_s)
    distance = np.linalg.norm(way, axis=1)
    with np.errstate(invalid="ignore"):
        above = np.sum(way * face.up, axis=1)
        before = np.sum(way * face.forward, axis=1) > parameters.ahead * distance
        looking = np.sum(track.directions(np.array([0.0, 1.0, 0.0])) * face.forward, axis=1)
        before &= smoothed(track.times, looking, usable, parameters.smoothing_s) > parameters.facing
        before &= (above < parameters.above_m) & (above > -parameters.below_m)
        inner = (distance < parameters.near_m) & before
        outer = (distance < parameters.away_m) & before
    spread = np.hypot(track.point_deviations(bridge), parameters.deviation_m)
    margins = (parameters.away_m - distance) / spread
    hands = nearest_hands(track, place)
    found = []
    spells = find_spells(track.times, inner, outer, usable, parameters.longest_gap_s)
    for spell in lasting_spells(spells, parameters.least_s):
        sure = sureness(spell, usable, margins)
        found.append(
            lasting_act(
                "worn",
                spell,
                sure,
                parameters.edge_s,
                {
                    "head_to_bridge_m": float(np.nanmedian(distance[spell.frames])),
                    "seen_share": float(np.mean(usable[spell.frames])),
                },
            )
        )
        for kind, happened, at in (
            ("put_on", spell.begun, spell.start_s),
            ("taken_off", spell.ended, spell.end_s),
        ):
            if happened:
                nearest = hand_at(track.times, hands, at, parameters.hand_s)
                share = 1.0 if nearest < parameters.hand_m else parameters.handless
                evidence = {"hand_m": nearest} if np.isfinite(nearest) else {}
                start_s = max(at - parameters.act_s, float(track.times[0]))
                found.append(Achievement(kind, start_s, at, sure * share, evidence=evidence))
    return sorted(found, key=lambda one: one.end_s)


def hand_at(times: Array, hands: Array, at_s: float, around_s: float) -> float:
    """The least distance (T,) of a hand about a time, metres; infinite where none was seen."""
    near = np.abs(times - at_s) <= around_s
    return float(np.min(hands[near], initial=np.inf))
