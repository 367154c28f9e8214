"""Reading through a magnifying glass: it is held between the eyes and what they read."""

from dataclasses import dataclass, replace

import numpy as np

from inhand_outcomes.achievement import Achievement
from inhand_outcomes.arrays import Array, Flags
from inhand_outcomes.measures.face import find_face, nearest_hands, thin_axis
from inhand_outcomes.measures.spells import (
    find_spells,
    lasting_act,
    lasting_spells,
    smoothed,
    speeds,
    sureness,
)
from inhand_outcomes.thing import Thing
from inhand_outcomes.track import Track


@dataclass(frozen=True)
class ReadingParameters:
    """What reading is."""

    facing: float = np.radians(55.0)
    """Largest angle, radians, between the lens's axis and the sight from the eyes."""
    nearest_m: float = 0.05
    """Least distance of the lens from the eyes."""
    furthest: float = 2.9
    """Largest distance of the lens from the eyes, in necks (``face``): half a metre in adults, who
    bend over what they read, and lay the glass down further away."""
    still_served: float = 3.1
    """The same at which it no longer serves who has been reading."""
    within_m: float = 0.10
    """How much further than usually while reading the lens may be when it begins or ends."""
    slow_m_s: float = 0.13
    """Speed of the lens with which reading begins and ends: along a line it goes at 0.1 to 0.2 m/s,
    and it is fetched and laid back at 0.3."""
    swift_m_s: float = 0.24
    """Speed of the lens above which it goes to the next line, or elsewhere."""
    hand_m: float = 0.14
    """Distance of a hand from the handle's end at most."""
    rested_m: float = 0.08
    """Distance from where it lay within which it still lies, or lies again."""
    rested_s: float = 0.4
    """Seconds without a hand, and without movement, after which it lay somewhere."""
    deviation_m: float = 0.02
    """Standard deviation of the distance beside that of the pose: joints of a head err."""
    smoothing_s: float = 0.15
    """Deviation of the bell by which places are averaged, seconds."""
    longest_gap_s: float = 1.1
    """Seconds of the way to the next line or page, or unseen, that do not end it."""
    least_s: float = 1.0
    """Seconds of the shortest reading."""
    edge_s: float = 0.25
    """Standard deviation of when it begins and of when it ends, seconds."""


DEFAULT_READING = ReadingParameters()


def reading(track: Track, thing: Thing) -> list[Achievement]:
    """Times of reading with their durations."""
    parameters = DEFAULT_READING
    face = find_face(track)
    usable = track.seen & face.seen
    lens, handle = lens_and_handle(thing)
    place = smoothed(track.times, track.points(lens), usable, parameters.smoothing_s)
    sight = place - face.eyes
    distance = np.linalg.norm(sight, axis=1)
    along = np.sum(track.directions(thin_axis(thing.vertices)) * sight, axis=1)
    angle = np.arccos(np.clip(np.abs(along) / np.maximum(distance, 1e-9), 0.0, 1.0))
    angle = smoothed(track.times, angle, usable, parameters.smoothing_s)
    hands = nearest_hands(track, track.points(handle))
    hands = smoothed(track.times, hands, usable & np.isfinite(hands), parameters.smoothing_s)
    speed = speeds(track.times, place)
    largest = parameters.still_served * face.size
    with np.errstate(invalid="ignore"):
        held = (hands < parameters.hand_m) & (distance > parameters.nearest_m)
        free = (hands > parameters.hand_m) & (speed < 0.5 * parameters.slow_m_s)
        held &= ~near_rest(track.times, place, free, parameters)
        served = held & (angle < parameters.facing) & (distance < largest)
        outer = served & (speed < parameters.swift_m_s)
        inner = served & (speed < parameters.slow_m_s)
        inner &= distance < parameters.furthest * face.size
    turning = np.maximum(track.turn_deviations(), np.radians(3.0))
    spread = np.hypot(track.point_deviations(lens), parameters.deviation_m)
    margins = np.minimum((parameters.facing - angle) / turning, (largest - distance) / spread)
    spells = []
    for spell in find_spells(
        track.times, inner, outer, usable, parameters.longest_gap_s, parameters.longest_gap_s
    ):
        during = np.zeros(len(track), bool)
        during[spell.frames] = outer[spell.frames]
        with np.errstate(invalid="ignore"):
            during &= distance < np.nanmedian(distance[during]) + parameters.within_m
        read = np.flatnonzero(inner & during & usable)
        if len(read):
            first, last = int(read[0]), int(read[-1])
            start_s, end_s = float(track.times[first]), float(track.times[last])
            spells.append(replace(spell, first=first, last=last, start_s=start_s, end_s=end_s))
    return [
        lasting_act(
            "reading",
            spell,
            sureness(spell, usable & outer, margins),
            parameters.edge_s,
            {
                "eyes_to_lens_m": float(np.nanmedian(distance[spell.frames])),
                "angle_rad": float(np.nanmedian(angle[spell.frames])),
                "seen_share": float(np.mean(usable[spell.frames])),
            },
        )
        for spell in lasting_spells(spells, parameters.least_s)
    ]


def lens_and_handle(thing: Thing) -> tuple[Array, Array]:
    """Middle of the lens (3,) and end of the handle (3,), the parts of those names.

    Usually the handle is towards -z, and the lens as far from the other end as it is broad.
    """
    low, high = thing.vertices.min(axis=0), thing.vertices.max(axis=0)
    broad = float(np.sort(high - low)[1])
    lens = np.array([0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), high[2] - 0.5 * broad])
    return thing.parts.get("lens", lens), thing.part("handle", "-z")


def near_rest(times: Array, places: Array, free: Flags, parameters: ReadingParameters) -> Flags:
    """Where (T,) a thing is at a place (T, 3) where it lay ``free`` for a while."""
    resting = np.zeros(len(times), bool)
    lain = find_spells(times, free, free, np.isfinite(places[:, 0]), 0.3)
    for spell in lain:
        if spell.seconds >= parameters.rested_s:
            spot = np.nanmedian(places[spell.frames], axis=0)
            resting |= np.linalg.norm(places - spot, axis=1) < parameters.rested_m
    return resting
