"""Shoes: put on and taken off."""

from dataclasses import dataclass

import numpy as np
from inhand_schemas.joints import Joint

from inhand_outcomes.achievement import Achievement
from inhand_outcomes.arrays import Array, Flags
from inhand_outcomes.measures.face import middle_of, nearest_hands
from inhand_outcomes.measures.spells import find_spells, lasting_spells, smoothed, sureness
from inhand_outcomes.measures.wearing import hand_at
from inhand_outcomes.thing import Thing
from inhand_outcomes.track import Track

FEET = ((Joint.ANKLE_LEFT, Joint.FOOT_LEFT), (Joint.ANKLE_RIGHT, Joint.FOOT_RIGHT))


@dataclass(frozen=True)
class ShoeParameters:
    """What a shoe on a foot is."""

    near_m: float = 0.085
    """Distance of the shoe's middle from the instep, halfway from ankle to foot, at which it is on:
    joints of feet are off by 2 to 3 cm, and a shoe beside a foot is 11 cm away."""
    away_m: float = 0.13
    """The same at which it is off: one at the toes is 20 cm away."""
    smoothing_s: float = 0.2
    """Deviation of the bell by which distances are averaged, seconds."""
    longest_gap_s: float = 1.2
    """Seconds unseen, or off by error, that do not count."""
    least_s: float = 0.9
    """Seconds of the shortest wear."""
    act_s: float = 0.5
    """Seconds that putting it on or taking it off is said to take, up to when it is on or off."""
    hand_m: float = 0.25
    """Distance of a hand within which it puts the shoe on or off."""
    hand_s: float = 0.8
    """Seconds before and after within which it must have been there."""
    handless: float = 0.6
    """Factor on the probability of what no hand was seen to do: some slip into their shoes."""
    deviation_m: float = 0.025
    """Standard deviation of the distance beside that of the pose: joints of feet err."""


DEFAULT_SHOE = ShoeParameters()


def shoes(track: Track, thing: Thing) -> list[Achievement]:
    """When a shoe was put on a foot and taken off it."""
    parameters = DEFAULT_SHOE
    middle = middle_of(thing.vertices)
    place = track.points(middle)
    distance, known = _from_instep(track, place)
    usable = track.seen & known
    distance = smoothed(track.times, distance, usable, parameters.smoothing_s)
    with np.errstate(invalid="ignore"):
        inner, outer = distance < parameters.near_m, distance < parameters.away_m
    spread = np.hypot(track.point_deviations(middle), parameters.deviation_m)
    margins = (parameters.away_m - distance) / spread
    hands = nearest_hands(track, place)
    found = []
    spells = find_spells(track.times, inner, outer, usable, parameters.longest_gap_s)
    for spell in lasting_spells(spells, parameters.least_s):
        sure = sureness(spell, usable, margins, best=0.75)
        evidence = {"shoe_to_instep_m": float(np.nanmedian(distance[spell.frames]))}
        for kind, happened, at in (
            ("shoe_on", spell.begun, spell.start_s),
            ("shoe_off", spell.ended, spell.end_s),
        ):
            if happened:
                nearest = hand_at(track.times, hands, at, parameters.hand_s)
                share = 1.0 if nearest < parameters.hand_m else parameters.handless
                start_s = max(at - parameters.act_s, float(track.times[0]))
                found.append(Achievement(kind, start_s, at, sure * share, evidence=evidence))
    return found


def _from_instep(track: Track, place: Array) -> tuple[Array, Flags]:
    """Distance (T,) of places (T, 3) from the nearer instep, metres, and whether (T,) one is
    known."""
    distances = [
        np.linalg.norm(0.5 * (track.joint(ankle) + track.joint(foot)) - place, axis=1)
        for ankle, foot in FEET
    ]
    nearer = np.min(np.where(np.isfinite(distances), distances, np.inf), axis=0)
    return nearer, np.isfinite(nearer)
