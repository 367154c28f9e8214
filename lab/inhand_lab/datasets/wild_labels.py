"""Finds single labels that are somewhere else than those before and after them.

A label is wild where the object would have to go or turn faster than anything in hands does, and
would not without it. Of a recording at 240 Hz one frame of a fast club is enough.
"""

import logging
from collections.abc import Sequence

import numpy as np
from inhand_runtime.wording import counted
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Flags, Indices

from inhand_lab.datasets.parameters import DEFAULT_DATASET, DatasetParameters
from inhand_lab.datasets.tracks import Track

log = logging.getLogger(__name__)


def without_wild_labels(
    name: str, truth: Track, times_ns: Indices, parameters: DatasetParameters = DEFAULT_DATASET
) -> Track:
    """Leave wild labels out of a recording's; a warning names the recording and their frames."""
    wild = wild_labels(truth, times_ns, parameters)
    frames = np.flatnonzero(wild).tolist()
    if not frames:
        return truth
    log.warning(
        "%s: %s left out, for the object cannot have been there between the others: %s",
        name,
        counted(len(frames), "label is", "labels are"),
        named_frames(frames, parameters.most_named),
    )
    kept = ~wild[:, None]
    return Track(
        np.where(kept, truth.translations, np.nan), np.where(kept, truth.rotations, np.nan)
    )


def named_frames(frames: Sequence[int], most: int = DEFAULT_DATASET.most_named) -> str:
    """Name the first frames of some: ``frame 7``, or ``frames 3, 4 and 9 more``."""
    shown = ", ".join(map(str, frames[:most]))
    more = f" and {len(frames) - most} more" if len(frames) > most else ""
    return f"frame{'s' if len(frames) > 1 else ''} {shown}{more}"


def wild_labels(
    truth: Track, times_ns: Indices, parameters: DatasetParameters = DEFAULT_DATASET
) -> Flags:
    """Flag (T,) labels that are wild; nothing where too many are, or none can be told from others.

    As few as can be are left out for the others to follow from each other. Times (T,) are
    nanoseconds.
    """
    given = np.flatnonzero(truth.given)
    nothing = np.zeros(len(truth.given), bool)
    if len(given) < 2 or _possible(truth, times_ns, given[:-1], given[1:], parameters).all():
        return nothing
    kept = _longest_chain(truth, times_ns, given, parameters)
    most = max(1.0, parameters.most_wild_share * len(given))
    if len(given) - len(kept) > most:
        return nothing
    wild = truth.given.copy()
    wild[kept] = False
    return wild


def _longest_chain(
    truth: Track, times_ns: Indices, given: Indices, parameters: DatasetParameters
) -> Indices:
    """Return the most of the labelled frames (N,) of which each can follow from the one before."""
    rate = 1e9 / max(float(np.median(np.diff(times_ns))), 1.0)
    reach = 1 + max(1, int(parameters.wild_run_s * rate))
    lengths = np.ones(len(given), int)
    before = np.full(len(given), -1)
    lengths[reach:] = 0  # nothing but a short run of wild labels may come before the first
    possible = {
        lag: _possible(truth, times_ns, given[:-lag], given[lag:], parameters)
        for lag in range(1, min(reach, len(given) - 1) + 1)
    }
    for place in range(len(given)):
        for lag, follows in possible.items():
            earlier = place - lag
            if earlier < 0 or not lengths[earlier] or not follows[earlier]:
                continue
            if lengths[earlier] + 1 > lengths[place]:
                lengths[place], before[place] = lengths[earlier] + 1, earlier
    ends = np.arange(max(0, len(given) - reach), len(given))
    place = int(ends[np.argmax(lengths[ends])])
    chain = []
    while place >= 0 and lengths[place]:
        chain.append(place)
        place = int(before[place])
    return given[chain[::-1]]


def _possible(
    truth: Track, times_ns: Indices, first: Indices, then: Indices, parameters: DatasetParameters
) -> Flags:
    """Flag (N,) pairs of frames between which an object can have moved as its labels say.

    Where frames between them have no label it may have gone anywhere.
    """
    unlabelled = np.cumsum(~truth.given)
    gap = unlabelled[then] > unlabelled[first]
    moved = np.linalg.norm(truth.translations[then] - truth.translations[first], axis=1)
    turned = rotations.angle_between(truth.rotations[first], truth.rotations[then])
    # A flip that lasts would be possible over a longer time.
    seconds = (times_ns[then] - times_ns[first]) / 1e9
    step_s = np.median(np.diff(times_ns)) / 1e9
    seconds = np.minimum(seconds, max(step_s, parameters.wild_bridge_s))
    slow = (moved <= parameters.fastest_m_per_s * seconds) & (
        turned <= parameters.fastest_rad_per_s * seconds
    )
    return np.asarray(slow | gap)
