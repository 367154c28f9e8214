"""How much left a vessel at each tilt, from what it can hold at the deepest ones so far.

Liquid reaches the lip of what is drunk or poured from, so after an act a vessel holds what it can
hold at the act's deepest tilt, and the act took what it held before less that. Before the first
act that is known of, and after a refill, it held more by an amount that only literature tells.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import exp, hypot, pi, sqrt

import numpy as np

from inhand_outcomes.achievement import Achievement, Amount
from inhand_outcomes.arrays import Array, Flags
from inhand_outcomes.measures.spells import Spell
from inhand_outcomes.measures.vessels import Inside
from inhand_outcomes.track import Track

HOLDS, HOLDS_DEVIATION, FULL = "holds_ml", "holds_deviation_ml", "full_ml"
"""Evidence of an act: what the vessel holds at its deepest tilt, and upright."""
LEFT, LEFT_DEVIATION = "left_ml", "left_deviation_ml"
"""Evidence of an act: what is left in the vessel after it."""


@dataclass(frozen=True)
class EmptyingParameters:
    """What is known of acts that empty a vessel."""

    kind: str
    """Kind of the acts."""
    usual: Amount
    """Volume of one whose beginning is not known, millilitres."""
    refill_kind: str = "refill"
    """Kind of what fills the vessel again."""
    tilt_deviation: float = 0.05
    """Standard deviation of the difference of two tilts of one vessel, radians, at the least.

    Poses err in tilt by 2 to 5 degrees, but for as long as a vessel is looked at from one side by
    much the same, so that the difference of two tilts is better than either."""
    alone: float = 0.5
    """Share of the deviation of a tilt that it does not have in common with other tilts."""
    refill_s: float = 5.0
    """Least time between two acts in which a vessel can be filled, seconds."""
    refills: float = 0.15
    """Share of acts before which the vessel was filled again, of those that come late enough: a mug
    gives some seven sips."""
    least_refill: float = 0.3
    """Probability of a refill below which it is not worth telling."""
    refill_act_s: float = 0.5
    """Seconds that a refill is said to take, up to the act that shows it."""
    known_s: float = 3600.0
    """Time for which what was left in a vessel is known, seconds: later it was filled or washed
    out of sight."""
    least_probability: float = 0.5
    """Probability of an earlier act below which it tells nothing of what is left."""


@dataclass(frozen=True)
class Tilt:
    """The deepest tilt of an act: how far and in which direction of the object, radians."""

    deepest: float
    towards: float
    deviation: float


def tilt_evidence(
    inside: Inside | None, tilt: Tilt, parameters: EmptyingParameters
) -> dict[str, float]:
    """Evidence of an act by which its volume is told later."""
    evidence = {"tilt_rad": tilt.deepest, "tilt_deviation_rad": tilt.deviation}
    if inside is None:
        return evidence
    alone = max(parameters.alone * tilt.deviation, parameters.tilt_deviation)
    deviation = hypot(
        alone * inside.ml_per_radian(tilt.deepest, tilt.towards), 0.01 * inside.full_ml
    )
    return evidence | {
        HOLDS: inside.holds(tilt.deepest, tilt.towards),
        HOLDS_DEVIATION: deviation,
        FULL: inside.full_ml,
        "share_deviation": inside.deviation,
        "solid": float(inside.solid),
    }


def with_volumes(
    found: Sequence[Achievement], earlier: Sequence[Achievement], parameters: EmptyingParameters
) -> list[Achievement]:
    """Acts with their volumes, and the refills between them.

    ``found`` are those of a window in order of time; ``earlier`` are outcomes of the same object
    that were told before, which may be among them.
    """
    told = sorted(
        (
            one
            for one in earlier
            if one.kind == parameters.kind and one.probability >= parameters.least_probability
        ),
        key=lambda one: one.end_s,
    )
    result: list[Achievement] = []
    last: Achievement | None = None
    for act in found:
        if act.kind != parameters.kind or HOLDS not in act.evidence:
            result.append(act)
            continue
        same = next((one for one in told if _overlap(one, act)), None)
        if same is not None and LEFT in same.evidence:
            last = same
            result.append(replace(act, amounts=same.amounts, evidence=same.evidence))
            continue
        before = [one for one in told if one.end_s <= act.start_s and LEFT in one.evidence]
        if before and (last is None or before[-1].end_s > last.end_s):
            last = before[-1]
        if last is not None and act.start_s - last.end_s > parameters.known_s:
            last = None
        refilled = 0.0 if last is None else refill_probability(last, act, parameters)
        if last is not None and refilled >= parameters.least_refill:
            result.append(_refill(last, act, refilled, parameters))
        whole = _with_volume(last, act, refilled, parameters)
        result.append(whole)
        if whole.probability >= parameters.least_probability:
            last = whole
    return result


def refill_probability(
    last: Achievement, act: Achievement, parameters: EmptyingParameters
) -> float:
    """Probability that a vessel was refilled between two acts, by Bayes.

    Without a refill the act takes a usual amount, more or less, so that the vessel can hold less by
    that than was left in it; after one it can hold anything.
    """
    if act.start_s - last.end_s < parameters.refill_s:
        return 0.0
    usual = parameters.usual
    taken = last.evidence[LEFT] - act.evidence[HOLDS]
    deviation = hypot(act.evidence[HOLDS_DEVIATION], last.evidence[LEFT_DEVIATION], usual.deviation)
    away = min(taken - usual.value, 0.0) / deviation
    emptied = exp(-0.5 * away**2) / (sqrt(2.0 * pi) * deviation)
    filled = 1.0 / max(act.evidence[FULL], 1.0)
    share = parameters.refills
    return share * filled / (share * filled + (1.0 - share) * emptied)


def _with_volume(
    last: Achievement | None, act: Achievement, refilled: float, parameters: EmptyingParameters
) -> Achievement:
    """An act with the volume that it took from what the last one left, if that is known.

    Where a refill is likely it is the mean of both.
    """
    holds, deviation = act.evidence[HOLDS], act.evidence[HOLDS_DEVIATION]
    most = max(act.evidence[FULL] - holds, 0.0)
    fresh = Amount(min(parameters.usual.value, most), parameters.usual.deviation)
    taken, left = fresh, Amount(holds, deviation)
    if last is not None:
        before = Amount(last.evidence[LEFT], last.evidence[LEFT_DEVIATION])
        value = min(max(before.value - holds, 0.0), before.value)
        spread = hypot(deviation, before.deviation, act.evidence["share_deviation"] * value)
        rest = before.value - value
        if holds > before.value:  # then it held more than was thought
            trust = before.deviation**2 / (before.deviation**2 + deviation**2)
            rest += trust * (holds - before.value)
        taken = _mixed(Amount(value, spread), fresh, refilled)
        left = _mixed(Amount(rest, deviation), left, refilled)
    return replace(
        act,
        amounts={**act.amounts, "volume_ml": taken},
        evidence={
            **act.evidence,
            LEFT: left.value,
            LEFT_DEVIATION: left.deviation,
            "refilled": refilled,
            "began_known": float(last is not None),
        },
    )


def _mixed(first: Amount, second: Amount, share: float) -> Amount:
    """The mean and the deviation of what is the second with a probability, else the first."""
    mean = (1.0 - share) * first.value + share * second.value
    variance = (1.0 - share) * (first.deviation**2 + (first.value - mean) ** 2)
    variance += share * (second.deviation**2 + (second.value - mean) ** 2)
    return Amount(mean, sqrt(variance))


def _refill(
    last: Achievement, act: Achievement, refilled: float, parameters: EmptyingParameters
) -> Achievement:
    """The refill that an act shows: what the vessel held before it more than the last one left."""
    more = act.evidence[HOLDS] + parameters.usual.value - last.evidence[LEFT]
    deviation = hypot(
        act.evidence[HOLDS_DEVIATION], last.evidence[LEFT_DEVIATION], parameters.usual.deviation
    )
    return Achievement(
        parameters.refill_kind,
        max(act.start_s - parameters.refill_act_s, last.end_s),
        act.start_s,
        refilled * act.probability,
        amounts={"volume_ml": Amount(max(more, 0.0), deviation)},
        evidence={HOLDS: act.evidence[HOLDS], LEFT: last.evidence[LEFT]},
    )


def _overlap(one: Achievement, other: Achievement) -> bool:
    return one.start_s < other.end_s and other.start_s < one.end_s


def tilts(track: Track) -> tuple[Array, Array, Array]:
    """How far (T,) the object's z axis is from the vertical, in which direction of the object from
    x to y it is low (T,), and the tilt's standard deviation (T,), all radians."""
    matrices = track.matrices
    up = matrices[:, 2, :]
    tilt = np.arccos(np.clip(up[:, 2], -1.0, 1.0))
    level = np.cross(matrices[:, :, 2], [0.0, 0.0, 1.0])
    lengths = np.linalg.norm(level, axis=1, keepdims=True)
    level = np.where(lengths > 1e-6, level / np.maximum(lengths, 1e-6), [1.0, 0.0, 0.0])
    turning = np.einsum("ti,tij,tj->t", level, track.covariances[:, 3:, 3:], level)
    return tilt, np.arctan2(-up[:, 1], -up[:, 0]), np.sqrt(np.maximum(turning, 0.0))


def raises(spell: Spell, times: Array, tilt: Array, usable: Flags, again: float) -> list[Spell]:
    """A spell cut where its tilt (T,) falls by ``again`` radians and rises by as much."""
    known = [f for f in range(spell.first, spell.last + 1) if usable[f] and np.isfinite(tilt[f])]
    cuts: list[int] = []
    peak, valley, fell = -np.inf, np.inf, False
    at_valley = spell.first
    for frame in known:
        value = float(tilt[frame])
        if not fell:
            peak = max(peak, value)
            if peak - value >= again:
                fell, valley, at_valley = True, value, frame
            continue
        if value < valley:
            valley, at_valley = value, frame
        if value - valley >= again:
            cuts.append(at_valley)
            peak, fell = value, False
    if not cuts:
        return [spell]
    firsts, lasts = [spell.first, *cuts], [*cuts, spell.last]
    starts = [spell.start_s, *(float(times[cut]) for cut in cuts)]
    ends = [*starts[1:], spell.end_s]
    return [
        Spell(first, last, start, end, begun=True, ended=True)
        for first, last, start, end in zip(firsts, lasts, starts, ends, strict=True)
    ]


def deepest_tilt(
    act: Spell, times: Array, tilt: Array, low: Array, deviation: Array, usable: Flags
) -> Tilt:
    """The deepest of the smoothed tilts (T,) of an act, and in which direction (T,) it was."""
    values = np.where(usable[act.frames], tilt[act.frames], -np.inf)
    frame = act.first + int(np.nanargmax(values))
    near = usable & (np.abs(times - times[frame]) <= 0.2)
    towards = np.angle(np.mean(np.exp(1j * low[near])))
    return Tilt(float(tilt[frame]), float(towards), float(np.mean(deviation[near])))
