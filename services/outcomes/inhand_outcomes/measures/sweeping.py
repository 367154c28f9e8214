"""Sweeping: strokes of a broom's head on the floor, for how long, over how much of it.

A pass is a way of the head from one turn to the next. It is a stroke where the head is on the
floor; people who lift it on the way back do so each time, so passes of one direction are judged
together.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from inhand_outcomes.achievement import Achievement, Amount
from inhand_outcomes.arrays import Array, Indices
from inhand_outcomes.measures.footprint import Footprint, footprint_of, swept_cells
from inhand_outcomes.measures.passes import DEFAULT_HALTING, Halting, moving_part, ways_of
from inhand_outcomes.measures.smoothing import smooth
from inhand_outcomes.measures.turning import end_of_lasting
from inhand_outcomes.normal import normal_share
from inhand_outcomes.thing import Thing
from inhand_outcomes.track import Track


@dataclass(frozen=True)
class SweepingParameters:
    """What a stroke is."""

    half_width_s: float = 0.20
    """Time on either side over which the head's place is smoothed: a third of a quick stroke."""
    path_half_width_s: float = 0.30
    """The same for the floor that it passed over, by parabolas: they keep the ends of strokes."""
    step_s: float = 0.04
    """Time between the places that are looked at."""
    turn_m: float = 0.10
    """Way back from where the head was furthest after which it has turned: above what the tracker
    errs, below half of a short stroke."""
    halting: Halting = DEFAULT_HALTING
    """Where a way from turn to turn is two movements."""
    shortest_m: float = 0.18
    """Length of a stroke, at least."""
    longest_s: float = 3.0
    """Time of a pass, at most: beyond it a broom is carried, or leans."""
    floor_m: float = 0.035
    """Height of the head above where it sweeps up to which it is on the floor: half of what people
    lift it by."""
    highest_floor_m: float = 0.08
    """Height, at most, at which a head that sweeps may be seen, by faults of floor and tracker."""
    height_m: float = 0.012
    """Deviation of the head's height beyond the tracker's own: floors and strokes are uneven."""
    alike: float = 0.6
    """How much the other passes of the same direction say of a pass."""
    along: float = 0.6
    """Cosine of the angle, at least, between the first or the last stroke and the others: what
    goes elsewhere brings the broom, or takes it away."""
    pause_s: float = 2.5
    """Time between strokes, at most, in one sweeping. Until it is over sweeping is under way."""
    least_strokes: float = 1.5
    """Strokes of a sweeping, at least, each counted as surely as it is one."""
    broom_upright_deg: float = 60.0
    """Lean of a broom that sweeps, at most."""


DEFAULT_SWEEPING = SweepingParameters()


@dataclass(frozen=True)
class Pass:
    """A way of the head between turns: indices of its first and last place, of all that is seen of
    it (N,) with what rests before and after, and how it goes."""

    first: int
    last: int
    rows: Indices
    height_m: float
    deviation_m: float
    length_m: float
    way: Array
    """Its direction (2,), level."""


@dataclass(frozen=True)
class Stroke:
    """A pass on the floor, with how surely, and the places (N, 2) and directions (N, 2) of the
    head's width, with their deviation (N,), metres."""

    start_s: float
    end_s: float
    probability: float
    height_m: float
    way: Array
    places: Array
    widths: Array
    deviations: Array


def sweeping(
    track: Track, thing: Thing, parameters: SweepingParameters = DEFAULT_SWEEPING
) -> list[Achievement]:
    """Find stretches of sweeping; area is that of the floor under the head in each of them."""
    found = []
    footprint = footprint_of(thing)
    for group in groups_of(strokes(track, thing, parameters), parameters):
        chances = np.array([stroke.probability for stroke in group])
        count = float(chances.sum())
        if count < parameters.least_strokes:
            continue
        area = _area(group, footprint)
        seconds = group[-1].end_s - group[0].start_s
        # Of so many passes two at least were strokes, or it was no sweeping.
        surely = 1.0 - float(np.prod(1.0 - np.sort(chances)[1:]))
        by_chance = float(np.sqrt(np.sum(chances * (1.0 - chances))))
        found.append(
            Achievement(
                "sweeping",
                group[0].start_s,
                end_of_lasting(track, group[-1].end_s, parameters.pause_s),
                surely,
                {
                    "duration_s": Amount(seconds, 0.2),
                    "area_m2": area,
                    "stroke_count": Amount(float(np.sum(chances > 0.5)), by_chance),
                },
                {"height_m": float(np.mean([stroke.height_m for stroke in group]))},
                lasting=True,
            )
        )
    return found


def strokes(
    track: Track, thing: Thing, parameters: SweepingParameters = DEFAULT_SWEEPING
) -> list[Stroke]:
    """Find the passes that may be strokes in order of time, with all that a map needs of them.

    Without a floor, heights mean nothing but beside each other, and there are none.
    """
    if not track.floor or len(track) < 8 or track.seen.sum() < 8:
        return []
    footprint = footprint_of(thing)
    at = np.arange(track.times[0], track.times[-1], parameters.step_s)
    head, widths = track.points(footprint.middle), track.directions(footprint.across)
    upright = track.directions(np.array([0.0, 0.0, 1.0]))[:, 2]
    both = np.column_stack([head, widths, upright])
    smoothed = smooth(track.times, both, track.seen, at, parameters.half_width_s)
    path = smooth(track.times, both, track.seen, at, parameters.path_half_width_s, order=2)
    level_errors, height_errors = _errors(track, footprint.middle)
    averaged = np.sqrt(np.maximum(smoothed.averaged, 1.0))
    errors = np.interp(at, track.times, level_errors) / averaged
    high = np.interp(at, track.times, height_errors) / averaged
    places = smoothed.values[:, :3]
    there = np.flatnonzero(np.isfinite(places[:, 0] + path.values[:, 0]))
    leans = np.cos(np.radians(parameters.broom_upright_deg))
    passes = [
        one
        for one in _passes(at, places, high, there, parameters)
        if np.nanmean(smoothed.values[one.first : one.last + 1, 6]) > leans
    ]
    chances = _chances(passes, parameters)
    return [
        Stroke(
            float(at[one.first]),
            float(at[one.last]),
            chance,
            one.height_m,
            one.way,
            path.values[one.rows, :2],
            path.values[one.rows, 3:5],
            errors[one.rows],
        )
        for one, chance in zip(passes, chances, strict=True)
        if chance > 0.05
    ]


def _errors(track: Track, point: Array) -> tuple[Array, Array]:
    """Deviations (T,) of a point (3,) of the thing along a level axis, and of its height, metres.

    A broom that stands upright is turned about level axes by errors that leave its height.
    """
    arms = track.points(point) - track.positions
    zero, one = np.zeros(len(track)), np.ones(len(track))
    x, y, z = arms.T
    ways = np.stack(
        [
            np.stack([one, zero, zero, zero, z, -y], axis=1),
            np.stack([zero, one, zero, -z, zero, x], axis=1),
            np.stack([zero, zero, one, y, -x, zero], axis=1),
        ]
    )
    variances = np.einsum("kti,tij,ktj->kt", ways, track.covariances, ways)
    return np.sqrt(variances[:2].mean(axis=0)), np.sqrt(variances[2])


def _passes(
    at: Array, places: Array, errors: Array, there: Indices, parameters: SweepingParameters
) -> list[Pass]:
    """The ways between turns that are long, quick and low enough to be strokes."""
    turns = ways_of(at[there], places[there, :2], parameters.turn_m, parameters.halting)
    found = []
    for begin, end in pairwise(turns):
        rows = there[begin : end + 1]
        way = places[rows[-1], :2] - places[rows[0], :2]
        length = float(np.linalg.norm(way))
        if length < parameters.shortest_m:
            continue
        gone = (places[rows, :2] - places[rows[0], :2]) @ way / length**2
        whole, rows = rows, rows[moving_part(gone)]
        if len(rows) < 3 or at[rows[-1]] - at[rows[0]] > parameters.longest_s:
            continue
        middle = rows[len(rows) // 4 : len(rows) - len(rows) // 4]
        height = float(np.median(places[middle, 2]))
        deviation = float(np.hypot(np.mean(errors[middle]) / 1.4, parameters.height_m))
        found.append(
            Pass(int(rows[0]), int(rows[-1]), whole, height, deviation, length, way / length)
        )
    return found


def _chances(passes: Sequence[Pass], parameters: SweepingParameters) -> list[float]:
    """How surely the head is on the floor in each pass."""
    if not passes:
        return []
    heights = np.array([one.height_m for one in passes])
    ways = np.array([one.way for one in passes])
    limit = _lifted_from(heights, parameters)
    chances = []
    for number, one in enumerate(passes):
        near = np.abs(np.arange(len(passes)) - number) <= 6
        alike = near & (ways @ one.way > 0.5)
        alike[number] = False
        height, share = one.height_m, parameters.alike
        deviation = one.deviation_m
        if alike.any():
            height = (1.0 - share) * height + share * float(np.median(heights[alike]))
            deviation /= np.sqrt(1.0 + alike.sum()) if alike.sum() < 4 else np.sqrt(5.0)
        on = normal_share(np.array((limit - height) / deviation))
        reached = normal_share(
            np.array((parameters.highest_floor_m + 0.03 - abs(one.height_m)) / one.deviation_m)
        )
        chances.append(float(on * reached))
    return chances


def _lifted_from(heights: Array, parameters: SweepingParameters) -> float:
    """Height from which a head is lifted, by the heights (N,) of the passes.

    Where they fall into two kinds it is between these; floor and tracker shift both alike.
    """
    low = np.sort(heights[np.abs(heights) < parameters.highest_floor_m + parameters.floor_m])
    if len(low) == 0:
        return parameters.floor_m
    splits = np.arange(1, len(low))
    within = [low[:at].var() * at + low[at:].var() * (len(low) - at) for at in splits]
    if len(low) > 1:
        at = int(splits[int(np.argmin(within))])
        beneath, above = float(low[:at].mean()), float(low[at:].mean())
        if above - beneath > 0.7 * parameters.floor_m:
            between = 0.5 * (above - beneath)
            return beneath + min(max(between, 0.5 * parameters.floor_m), parameters.floor_m)
    return float(np.median(low)) + parameters.floor_m


def groups_of(
    found: Sequence[Stroke], parameters: SweepingParameters = DEFAULT_SWEEPING
) -> list[list[Stroke]]:
    """The strokes that follow each other, without the ways to the place of work and back."""
    groups: list[list[Stroke]] = []
    for stroke in found:
        if stroke.probability <= 0.5:
            continue
        if groups and stroke.start_s - groups[-1][-1].end_s <= parameters.pause_s:
            groups[-1].append(stroke)
        else:
            groups.append([stroke])
    return [_without_ways_there(group, parameters) for group in groups]


def _without_ways_there(group: list[Stroke], parameters: SweepingParameters) -> list[Stroke]:
    """Strokes without the first and the last where these go across the others."""
    ways = np.array([stroke.way for stroke in group])
    if len(group) == 2 and abs(ways[0] @ ways[1]) < parameters.along:
        return group[:1]
    if len(group) < 3:
        return group
    kept = list(range(len(group)))
    for end in (0, -1):
        others = [number for number in kept if number != kept[end]]
        near = others[:3] if end == 0 else others[-3:]
        if np.median(np.abs(ways[near] @ ways[kept[end]])) < parameters.along:
            del kept[end]
    return [group[number] for number in kept]


def _area(group: Sequence[Stroke], footprint: Footprint) -> Amount:
    """Area under the head in some strokes, with what its errors make of the edge."""
    cells = swept_cells(
        [(s.places, s.widths, s.deviations, s.probability) for s in group], footprint
    )
    chances = cells.chances
    area = float(np.sum(chances > 0.5)) * cells.cell_m**2
    edge = float(np.sum(chances * (1.0 - chances))) * cells.cell_m**2
    return Amount(area, max(edge, 0.05 * area))
