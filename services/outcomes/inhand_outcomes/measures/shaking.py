"""Shaking something out of a bottle: each time it is tipped and shaken, and by how many strokes.

A ``shake`` is one bout: the mouth is held below level, and the bottle goes to and fro along its
axis at least twice without a rest. Its strokes, movements towards the mouth that are turned back at
once, are an amount of it: the first and the last of a bout are often half a stroke, and whether
these count is a matter of taste, so they are counted by the share of a stroke that they surely are.
A bottle that is shaken upright is mixed, and gives nothing.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inhand_outcomes.achievement import Achievement, Amount
from inhand_outcomes.measures.smoothing import smooth
from inhand_outcomes.measures.turning import share_seen, turns_of
from inhand_outcomes.normal import normal_share
from inhand_outcomes.thing import Thing
from inhand_outcomes.track import Track

TO_MOUTH = np.array([0.0, 0.0, 1.0])
"""Where the mouth of a bottle is, in its frame."""


@dataclass(frozen=True)
class ShakingParameters:
    """What a shake is."""

    half_width_s: float = 0.06
    """Time on either side over which the bottle's place is smoothed: a fifth of a quick stroke."""
    step_s: float = 1.0 / 60.0
    """Time between the places that are looked at."""
    stroke_m: float = 0.016
    """Way of a stroke from which it is one: hands that hold a bottle still move it by less than a
    third of this."""
    stroke_deviation_m: float = 0.003
    """Deviation of that way by the tracker: from stroke to stroke it errs much alike."""
    longest_stroke_s: float = 0.30
    """Time of a stroke, at most: slower ones are a bottle that is carried."""
    usual_stroke_s: float = 0.15
    """Time of a stroke at 3.5 to and fro a second."""
    pause_s: float = 0.55
    """Time between the ends of strokes, at most, in one shake."""
    least_strokes: float = 1.2
    """Strokes of a shake, at least, each counted as surely as it is one."""
    tipped_deg: float = 80.0
    """Tilt of a bottle out of which something is shaken."""
    tilt_deg: float = 6.0
    """Deviation of that tilt: bottles are shaken out at little below level by some."""
    seen: float = 0.5
    """Share of a shake's frames that must be seen, about."""


DEFAULT_SHAKING = ShakingParameters()


@dataclass(frozen=True)
class _Stroke:
    start_s: float
    end_s: float
    way_m: float
    tilt_deg: float
    probability: float


def shaking(
    track: Track, thing: Thing, parameters: ShakingParameters = DEFAULT_SHAKING
) -> list[Achievement]:
    """Find shakes, each with its number of strokes and how fast they follow each other."""
    del thing  # Bottles stand along z; nothing else of them matters.
    if len(track) < 8:
        return []
    found = []
    for bout in _bouts(_strokes(track, parameters), parameters):
        chances = np.array([stroke.probability for stroke in bout])
        start, end = bout[0].start_s, bout[-1].end_s
        seen = share_seen(track.times, track.seen, start, end)
        tilt = float(np.median([stroke.tilt_deg for stroke in bout]))
        error = np.hypot(parameters.tilt_deg, np.degrees(track.turn_deviations().mean()))
        scores = (
            (float(chances.sum()) - parameters.least_strokes) / 0.3,
            (tilt - parameters.tipped_deg) / error,
            (seen - parameters.seen) / 0.12,
        )
        chance = float(np.prod(normal_share(np.array(scores))))
        intervals = np.diff([stroke.end_s for stroke in bout])
        rate = 1.0 / float(np.median(intervals))
        strokes = Amount(
            float(np.sum(chances > 0.5)),
            float(np.sqrt(0.25 + np.sum(chances * (1.0 - chances)))),
        )
        amounts = {
            "stroke_count": strokes,
            "rate_per_s": Amount(rate, 0.1 * rate),
            "duration_s": Amount(end - start, 0.3),
        }
        evidence = {"tilt_deg": tilt, "way_m": float(np.max([s.way_m for s in bout])), "seen": seen}
        found.append(Achievement("shake", start, end, chance, amounts, evidence))
    return found


def _strokes(track: Track, parameters: ShakingParameters) -> list[_Stroke]:
    """Quick movements along the bottle towards its mouth that are turned back."""
    at = np.arange(track.times[0], track.times[-1], parameters.step_s)
    both = np.column_stack([track.positions, track.directions(TO_MOUTH)])
    smoothed = smooth(track.times, both, track.seen, at, parameters.half_width_s, order=2)
    axes = smoothed.values[:, 3:] / np.linalg.norm(smoothed.values[:, 3:], axis=1, keepdims=True)
    gone = np.cumsum(np.nan_to_num(np.sum(smoothed.slopes[:, :3] * axes, axis=1)))
    gone *= parameters.step_s
    tilts = np.degrees(np.arccos(np.clip(axes[:, 2], -1.0, 1.0)))
    turns = turns_of(gone, 0.5 * parameters.stroke_m)
    found = []
    for number in range(1, len(turns.indices)):
        if not turns.peaks[number]:
            continue
        first, last = turns.indices[number - 1], turns.indices[number]
        way = float(gone[last] - gone[first])
        if at[last] - at[first] > parameters.longest_stroke_s:
            # The bottle was carried on before: what counts is how it ends.
            first = last - round(parameters.usual_stroke_s / parameters.step_s)
            way = float(gone[last] - gone[first])
        surely = (way - parameters.stroke_m) / parameters.stroke_deviation_m
        chance = float(normal_share(np.array(surely)))
        tilt = float(np.nanmean(tilts[first : last + 1]))
        if chance > 0.02 and np.isfinite(tilt):
            found.append(_Stroke(float(at[first]), float(at[last]), way, tilt, chance))
    return found


def _bouts(strokes: Sequence[_Stroke], parameters: ShakingParameters) -> list[list[_Stroke]]:
    """Strokes that follow each other at once; doubtful ones at the ends are left out."""
    bouts: list[list[_Stroke]] = []
    for stroke in strokes:
        if bouts and stroke.end_s - bouts[-1][-1].end_s <= parameters.pause_s:
            bouts[-1].append(stroke)
        else:
            bouts.append([stroke])
    kept = []
    for bout in bouts:
        surely = [number for number, stroke in enumerate(bout) if stroke.probability > 0.2]
        rest = bout[surely[0] : surely[-1] + 1] if surely else []
        if len(rest) > 1:
            kept.append(rest)
    return kept
