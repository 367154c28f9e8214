"""Painting a wall: strokes of the bristles along a plane, and how much of it they covered.

The wall is found from the strokes themselves: an upright plane in which most of the ways of the
bristles to and fro lie. Ways to the pot and back leave it.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
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

TO_BRISTLES = np.array([0.0, 0.0, -1.0])
"""Where the bristles are, in a brush's frame."""


@dataclass(frozen=True)
class PaintingParameters:
    """What a stroke on a wall is."""

    half_width_s: float = 0.15
    """Time on either side over which the bristles' place is smoothed."""
    step_s: float = 0.04
    """Time between the places that are looked at."""
    turn_m: float = 0.06
    """Way back after which the bristles have turned."""
    halting: Halting = DEFAULT_HALTING
    """Where a way from turn to turn is two movements."""
    shortest_m: float = 0.10
    """Length of a stroke, at least."""
    longest_s: float = 4.0
    """Time of a stroke, at most."""
    wall_m: float = 0.02
    """Deviation of the bristles from the wall, by their bending."""
    off_wall_m: float = 0.035
    """Distance from the wall, on average over a way, up to which it is a stroke."""
    slope_m: float = 0.07
    """Distance by which a way may come nearer to the wall, or leave it: more is a way to it."""
    towards: float = 0.15
    """Cosine of the angle, at least, between the brush and the way into the wall."""
    back: float = 0.85
    """Cosine of the angle between a stroke to and one fro, at least."""
    long: float = 0.6
    """Share of the longest stroke's length, at least, of those by which the wall is found."""
    pointing_deg: float = 25.0
    """Deviation of where a brush points, seen from above, from square to the wall."""
    pause_s: float = 4.5
    """Time between strokes, at most, in one painting: brushes are dipped meanwhile. Until it is
    over painting is under way."""
    least_strokes: float = 2.5
    """Strokes of a painting, at least, each counted as surely as it is one."""
    cell_m: float = 0.02
    """Side of the cells of the wall."""
    bent_m: float = 0.02
    """Depth of the bristles on the wall, at least: they bend."""


DEFAULT_PAINTING = PaintingParameters()


@dataclass(frozen=True)
class Wall:
    """An upright plane: ``into @ p == distance`` for its points p; ``into`` (3,) is level, away
    from who paints."""

    into: Array
    distance: float

    @property
    def along(self) -> Array:
        """The level direction (3,) in the wall."""
        return np.array([-self.into[1], self.into[0], 0.0])


@dataclass(frozen=True)
class _Way:
    """A movement: the indices (N,) of all of it and of its moving part, and its length."""

    whole: Indices
    moving: Indices
    length_m: float


@dataclass(frozen=True)
class _Stroke:
    start_s: float
    end_s: float
    probability: float
    places: Array
    widths: Array
    deviations: Array


def painting(
    track: Track, thing: Thing, parameters: PaintingParameters = DEFAULT_PAINTING
) -> list[Achievement]:
    """Find stretches of painting; area is that of the wall under the bristles in each of them."""
    found = []
    footprint = footprint_of(thing)
    footprint = replace(footprint, depth_m=max(footprint.depth_m, parameters.bent_m))
    for group in _groups(_strokes(track, footprint, parameters), parameters):
        chances = np.array([stroke.probability for stroke in group])
        if chances.sum() < parameters.least_strokes:
            continue
        end = group[-1].end_s
        found.append(
            Achievement(
                "painting",
                group[0].start_s,
                end_of_lasting(track, end, parameters.pause_s),
                1.0 - float(np.prod(1.0 - np.sort(chances)[1:])),
                {
                    "duration_s": Amount(end - group[0].start_s, 0.3),
                    "area_m2": _area(group, footprint, parameters),
                    "stroke_count": Amount(
                        float(np.sum(chances > 0.5)),
                        float(np.sqrt(np.sum(chances * (1.0 - chances)))),
                    ),
                },
                {"least": float(chances.min())},
                lasting=True,
            )
        )
    return found


def _strokes(track: Track, footprint: Footprint, parameters: PaintingParameters) -> list[_Stroke]:
    """Ways of the bristles along the wall, in order of time."""
    if track.seen.sum() < 8:
        return []
    at = np.arange(track.times[0], track.times[-1], parameters.step_s)
    both = np.column_stack(
        [
            track.points(footprint.middle),
            track.directions(footprint.across),
            track.directions(TO_BRISTLES),
        ]
    )
    path = smooth(track.times, both, track.seen, at, parameters.half_width_s, order=2)
    places = path.values[:, :3]
    errors = np.interp(at, track.times, track.point_deviations(footprint.middle))
    ways = _ways(at, places, parameters)
    brushes = path.values[:, 6:9]
    wall = find_wall(
        [places[way.moving] for way in ways],
        [brushes[way.moving].mean(axis=0) for way in ways],
        parameters,
    )
    if wall is None:
        return []
    pointing = brushes @ wall.into
    found = []
    for way in ways:
        off = places[way.moving] @ wall.into - wall.distance
        error = float(np.hypot(errors[way.moving].mean() / np.sqrt(2.0), 0.5 * parameters.wall_m))
        scores = (
            (parameters.off_wall_m - abs(float(np.median(off)))) / error,
            (parameters.slope_m - abs(float(off[-1] - off[0]))) / (1.4 * error),
            (float(np.mean(pointing[way.moving])) - parameters.towards) / 0.1,
        )
        chance = float(np.prod(normal_share(np.array(scores))))
        if chance > 0.05:
            found.append(_stroke(at, path.values, errors, way, wall, chance))
    return found


def _stroke(
    at: Array, values: Array, errors: Array, way: _Way, wall: Wall, chance: float
) -> _Stroke:
    axes = np.stack([wall.along, [0.0, 0.0, 1.0]], axis=1)
    return _Stroke(
        float(at[way.moving[0]]),
        float(at[way.moving[-1]]),
        chance,
        values[way.whole, :3] @ axes,
        values[way.whole, 3:6] @ axes,
        errors[way.whole],
    )


def _ways(at: Array, places: Array, parameters: PaintingParameters) -> list[_Way]:
    """The movements that are long and short enough to be strokes."""
    there = np.flatnonzero(np.isfinite(places[:, 0]))
    ends = ways_of(at[there], places[there], parameters.turn_m, parameters.halting)
    found = []
    for begin, end in pairwise(ends):
        rows = there[begin : end + 1]
        way = places[rows[-1]] - places[rows[0]]
        length = float(np.linalg.norm(way))
        if length < parameters.shortest_m:
            continue
        moving = rows[moving_part((places[rows] - places[rows[0]]) @ way / length**2)]
        if len(moving) >= 3 and at[moving[-1]] - at[moving[0]] <= parameters.longest_s:
            found.append(_Way(rows, moving, length))
    return found


def find_wall(
    ways: Sequence[Array],
    pointing: Sequence[Array],
    parameters: PaintingParameters = DEFAULT_PAINTING,
) -> Wall | None:
    """Find the upright plane in which the ways to and fro, of places (N, 3), lie.

    ``pointing`` (3,) is where the brush points in each: into the wall, more or less, which tells
    the wall where strokes are one above the other. None where nothing goes to and fro.
    """
    lengths = np.array([np.linalg.norm(way[-1] - way[0]) for way in ways])
    rubbing = [number for number in range(len(ways)) if _rubs(ways, number, parameters)]
    longest = max(lengths[rubbing], default=0.0)
    # A brush goes up and down in its pot as well, but not so far.
    rubbing = [number for number in rubbing if lengths[number] >= parameters.long * longest]
    wall = None
    for _ in range(3):
        if not rubbing:
            return wall
        points = np.concatenate([ways[number] for number in rubbing])
        usual = np.mean([pointing[number] for number in rubbing], axis=0)
        wall = _fitted(points, usual, 2 * len(rubbing), parameters)
        if wall is None:
            return None
        rubbing = [
            number
            for number in rubbing
            if abs(np.median(ways[number] @ wall.into) - wall.distance) < parameters.off_wall_m
        ]
    return wall


def _rubs(ways: Sequence[Array], number: int, parameters: PaintingParameters) -> bool:
    """Whether the way before or after goes back where a way came from."""
    way = ways[number][-1] - ways[number][0]
    for other in (number - 1, number + 1):
        if 0 <= other < len(ways):
            back = ways[other][-1] - ways[other][0]
            cosine = way @ back / (np.linalg.norm(way) * np.linalg.norm(back))
            if cosine < -parameters.back:
                return True
    return False


def _fitted(
    points: Array, pointing: Array, independent: int, parameters: PaintingParameters
) -> Wall | None:
    """The upright plane through points (N, 3), of which so many err apart, about square to where
    the brush points (3,); None where that is up or down."""
    level = pointing[:2] / max(float(np.linalg.norm(pointing[:2])), 1e-9)
    if np.linalg.norm(pointing[:2]) < parameters.towards:
        return None
    centre = np.median(points[:, :2], axis=0)
    spread = np.cov((points[:, :2] - centre).T)
    turns = np.radians(np.arange(-60.0, 61.0))
    cosines, sines = np.cos(turns), np.sin(turns)
    into = np.stack(
        [level[0] * cosines - level[1] * sines, level[0] * sines + level[1] * cosines], axis=1
    )
    off = np.einsum("ai,ij,aj->a", into, spread, into)
    doubt = independent * off / parameters.wall_m**2
    doubt += (turns / np.radians(parameters.pointing_deg)) ** 2
    best = into[int(np.argmin(doubt))]
    return Wall(np.array([best[0], best[1], 0.0]), float(best @ centre))


def _groups(found: Sequence[_Stroke], parameters: PaintingParameters) -> list[list[_Stroke]]:
    groups: list[list[_Stroke]] = []
    for stroke in found:
        if stroke.probability <= 0.5:
            continue
        if groups and stroke.start_s - groups[-1][-1].end_s <= parameters.pause_s:
            groups[-1].append(stroke)
        else:
            groups.append([stroke])
    return groups


def _area(group: Sequence[_Stroke], footprint: Footprint, parameters: PaintingParameters) -> Amount:
    """Area under the bristles in some strokes, with what errors make of its edge."""
    cells = swept_cells(
        [(one.places, one.widths, one.deviations, one.probability) for one in group],
        footprint,
        parameters.cell_m,
    )
    area = float(np.sum(cells.chances > 0.5)) * parameters.cell_m**2
    edge = float(np.sum(cells.chances * (1.0 - cells.chances))) * parameters.cell_m**2
    return Amount(area, max(edge, 0.1 * area))
