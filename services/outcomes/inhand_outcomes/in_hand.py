"""Whether a thing was in a hand while it was used: what lies on a table is not used."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from inhand_outcomes.achievement import Achievement
from inhand_outcomes.arrays import Array
from inhand_outcomes.hands import hand_distances
from inhand_outcomes.normal import normal_share
from inhand_outcomes.stillness import frames_apart
from inhand_outcomes.thing import Thing
from inhand_outcomes.track import Track


@dataclass(frozen=True)
class InHandParameters:
    """When a hand holds a thing."""

    reach_m: float = 0.25
    """Distance of a hand's joint from a thing's surface beyond which it does not hold it, metres:
    held things are measured at 2 to 12 cm, the stick of a broom at up to 20."""
    deviation_m: float = 0.03
    """Standard deviation of the usual distance over some frames: a skeleton's hands are off by 3
    cm, and poses by 2, alike for a third of a second."""
    share: float = 0.35
    """Share of the frames in which the hand is as near: both are misread now and then, and what was
    held before and after was held between."""
    step_s: float = 0.05
    """Seconds between the frames that are looked at."""
    least_frames: int = 2
    """Frames with hands below which nothing is known of them."""


DEFAULT_IN_HAND = InHandParameters()


def in_hand(
    found: Sequence[Achievement],
    track: Track,
    thing: Thing,
    parameters: InHandParameters = DEFAULT_IN_HAND,
) -> list[Achievement]:
    """The achievements as probable as it is that a hand held the thing meanwhile.

    Where no hand is known they stay as they are.
    """
    return [_judged(one, track, thing, parameters) for one in found]


def _judged(
    achievement: Achievement, track: Track, thing: Thing, parameters: InHandParameters
) -> Achievement:
    first, end = np.searchsorted(track.times, [achievement.start_s, achievement.end_s + 1e-6])
    frames = np.arange(first, end)
    if len(frames) > 1:
        frames = frames[frames_apart(track.times[frames], parameters.step_s)]
    frames = frames[track.seen[frames]]
    looked = np.zeros(len(track), bool)
    looked[frames] = True
    nearest = _nearest(hand_distances(track[looked], thing))
    if len(nearest) < parameters.least_frames:
        return achievement
    distance = float(np.quantile(nearest, parameters.share))
    held = float(normal_share((parameters.reach_m - distance) / parameters.deviation_m))
    return replace(
        achievement,
        probability=achievement.probability * held,
        evidence={**achievement.evidence, "hand_to_thing_m": distance},
    )


def _nearest(hands: Array) -> Array:
    """Distances (N,) of the nearer hand, of (T, 2), where one is known."""
    known = hands[np.isfinite(hands).any(axis=1)]
    return np.asarray(np.nanmin(known, axis=1)) if len(known) else np.zeros(0)
