"""Spells: times in which something holds, by two limits, so that noise does not cut them."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from inhand_outcomes.achievement import Achievement, Amount
from inhand_outcomes.arrays import Array, Flags
from inhand_outcomes.normal import normal_share

SEEN_ENOUGH = 0.5
"""Share of a spell's frames that must be seen for its probability not to suffer: a hand hides what
it holds now and then, and what was seen before and after tells of the time between."""
LONGEST_AWAY_S = 0.5
"""Seconds for which a tracker that errs may say otherwise within a spell."""
LEAST_REST_S = 0.3
"""Seconds that the rest of a spell lasts at least: averages differ at the beginning of a track."""


@dataclass(frozen=True)
class Spell:
    """From ``start_s`` to ``end_s``; ``first`` and ``last`` are its first and last frame.

    ``begun`` and ``ended`` say whether it was otherwise before and after, as far as was seen.
    """

    first: int
    last: int
    start_s: float
    end_s: float
    begun: bool
    ended: bool

    @property
    def seconds(self) -> float:
        """How long it lasts."""
        return self.end_s - self.start_s

    @property
    def frames(self) -> slice:
        """Its frames."""
        return slice(self.first, self.last + 1)


def find_spells(
    times: Array,
    inner: Flags,
    outer: Flags,
    usable: Flags,
    longest_gap_s: float,
    longest_away_s: float = LONGEST_AWAY_S,
) -> list[Spell]:
    """Spells in which the looser condition ``outer`` (T,) holds, and somewhere the stricter one.

    Frames that are not ``usable`` say nothing, for up to ``longest_gap_s``; nor is what they say in
    between believed if it lasts no longer than ``longest_away_s``. A spell begins and ends halfway
    between two frames that differ.
    """
    known = np.flatnonzero(usable)
    if not len(known):
        return []
    inside = known[outer[known]]
    if not len(inside):
        return []
    away = known[~outer[known]]
    first_away = np.searchsorted(away, inside[:-1])
    last_away = np.searchsorted(away, inside[1:]) - 1
    spans = np.zeros(len(inside) - 1)
    between = last_away >= first_away
    spans[between] = times[away[last_away[between]]] - times[away[first_away[between]]]
    cuts = np.flatnonzero((np.diff(times[inside]) > longest_gap_s) | (spans > longest_away_s))
    firsts = inside[np.concatenate([[0], cuts + 1])]
    lasts = inside[np.concatenate([cuts, [len(inside) - 1]])]
    spells = []
    for first, last in zip(firsts, lasts, strict=True):
        strict = inner[first : last + 1] & outer[first : last + 1] & usable[first : last + 1]
        if not np.any(strict):
            continue
        before, after = known[known < first], known[known > last]
        start_s, end_s = float(times[first]), float(times[last])
        if len(before) and start_s - times[before[-1]] <= longest_gap_s:
            start_s = 0.5 * (start_s + float(times[before[-1]]))
        if len(after) and times[after[0]] - end_s <= longest_gap_s:
            end_s = 0.5 * (end_s + float(times[after[0]]))
        spell = Spell(int(first), int(last), start_s, end_s, len(before) > 0, len(after) > 0)
        spells.append(spell)
    return spells


def lasting_spells(spells: list[Spell], least_s: float) -> list[Spell]:
    """Those that last long enough; what the beginning of a track cuts may be the rest of more."""
    return [
        spell for spell in spells if spell.seconds >= (least_s if spell.begun else LEAST_REST_S)
    ]


def lasting_act(
    kind: str, spell: Spell, probability: float, edge_s: float, evidence: Mapping[str, float]
) -> Achievement:
    """A spell as a lasting achievement with its duration, whose ends are off by ``edge_s`` each."""
    duration = Amount(spell.seconds, 1.5 * edge_s)
    return Achievement(
        kind, spell.start_s, spell.end_s, probability, {"duration_s": duration}, evidence, True
    )


def sureness(spell: Spell, usable: Flags, margins: Array, best: float = 1.0) -> float:
    """Probability of a spell by the ``margins`` (T,) to its limit, in standard deviations.

    Errors of neighbouring frames go together, so it is the mean of what its frames say, or the
    ``best`` share of them, and less where few of them were seen.
    """
    seen = usable[spell.frames]
    values = np.sort(margins[spell.frames][seen & np.isfinite(margins[spell.frames])])
    if not len(values):
        return 0.0
    shown = values[int((1.0 - best) * len(values)) :]
    return float(np.mean(normal_share(shown))) * min(1.0, float(np.mean(seen)) / SEEN_ENOUGH)


def smoothed(times: Array, values: Array, usable: Flags, seconds: float) -> Array:
    """Values (T, ...) averaged over neighbours in time, by a bell of that deviation, seconds.

    Only usable frames count; where none is near, NaN.
    """
    known = np.flatnonzero(usable)
    if not len(known):
        return np.full(values.shape, np.nan)
    starts = np.searchsorted(times[known], times - 3.0 * seconds)
    ends = np.searchsorted(times[known], times + 3.0 * seconds, side="right")
    sums, weights = np.zeros(values.shape), np.zeros(len(times))
    for offset in range(int((ends - starts).max())):
        place = starts + offset
        near = known[np.minimum(place, len(known) - 1)]
        weight = np.exp(-0.5 * ((times[near] - times) / seconds) ** 2) * (place < ends)
        weights += weight
        sums += values[near] * weight.reshape(-1, *(1,) * (values.ndim - 1))
    weights = np.where(weights > 0.0, weights, np.nan)
    return np.asarray(sums / weights.reshape(-1, *(1,) * (values.ndim - 1)))


def speeds(times: Array, places: Array) -> Array:
    """Speed (T,) of places (T, 3), m/s, by neighbours on both sides; NaN where unknown."""
    if len(times) < 3:
        return np.full(len(times), np.nan)
    return np.asarray(np.linalg.norm(np.gradient(places, times, axis=0), axis=1))
