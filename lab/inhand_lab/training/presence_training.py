"""What a tracker's support is worth: how well objects are seen that are there, and that are not.

Every object is looked for in some frames of every recording, whichever is in use in it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.methods.registry import DEFAULT_METHOD, METHODS, new_tracker
from inhand_tracker.model.model import Model
from inhand_tracker.recognition.parameters import DEFAULT_RECOGNITION
from inhand_tracker.recognition.presence import Presence
from inhand_tracker.sight.support import PARTS, Support
from numpy.typing import ArrayLike

from inhand_lab.datasets.dataset import Dataset, DatasetEntry
from inhand_lab.datasets.observations import observe
from inhand_lab.datasets.recorded_frames import load_frames

NEEDS = METHODS[DEFAULT_METHOD].needs(METHODS[DEFAULT_METHOD].usual_terms)
"""What of a frame the trackers of objects look at."""
PLACES = (0.02, 0.35, 0.7)
"""Where in a recording objects are looked for: at first most lie untouched."""
STEPS = 2
"""Frames one after the other: the second look finds more."""
PRIOR_COUNT = 4.0
"""So many looks are taken to have shown the usual support beforehand."""
PARTS_PRIOR_COUNT = 15.0
"""The same of the spreads of its parts."""
LEAST_SPREAD = 3.0


@dataclass(frozen=True)
class Look:
    """The ``supports`` of objects, by their actions, where somebody does ``action``.

    Objects of which the image says nothing have none.
    """

    action: str
    supports: dict[str, Support]


def learn_presence(
    dataset: Dataset,
    entries: Sequence[DatasetEntry],
    actions: Sequence[str],
    models: Sequence[Model],
) -> Presence:
    """Of the objects of ``models``, in the order of their actions; raises RecordingError."""
    return presence_of(look_around(dataset, entries, actions, models), actions)


def look_around(
    dataset: Dataset,
    entries: Sequence[DatasetEntry],
    actions: Sequence[str],
    models: Sequence[Model],
) -> list[Look]:
    """Look for every object at each place in each recording; raises RecordingError."""
    return [
        Look(entry.interaction, {actions[number]: support for number, support in told.items()})
        for entry in entries
        for told in _looks(dataset, entry, models)
    ]


def presence_of(looks: Sequence[Look], actions: Sequence[str]) -> Presence:
    """What looks say of the objects of ``actions``."""
    supports, spreads, parts, part_spreads = [], [], [], []
    for action in actions:
        found = {done: _supports(looks, action, done) for done in actions}
        told = {done: [one.log_likelihood for one in some] for done, some in found.items()}
        others = [support for done in actions if done != action for support in told[done]]
        expected = dict.fromkeys(actions, _mean(others, DEFAULT_RECOGNITION.usual_support_absent))
        expected[action] = DEFAULT_RECOGNITION.usual_support_present
        supports.append([_mean(told[done], expected[done]) for done in actions])
        spreads.append(_spread(told, action))
        means, deviations = _parts(found[action])
        parts.append(means)
        part_spreads.append(deviations)
    return Presence(*map(np.array, (supports, spreads, parts, part_spreads)))


def _supports(looks: Sequence[Look], action: str, done: str) -> list[Support]:
    """Those of an action's object where somebody does ``done``."""
    return [
        look.supports[action] for look in looks if look.action == done and action in look.supports
    ]


def _looks(
    dataset: Dataset, entry: DatasetEntry, models: Sequence[Model]
) -> list[dict[int, Support]]:
    """The support of each object that says anything, at each place in a recording."""
    path = dataset.path(entry)
    frames = load_frames(path, entry.object)
    firsts = [int(place * (len(frames) - STEPS)) for place in PLACES]
    looked_at = [frames[first + step] for first in firsts for step in range(STEPS)]
    images = {seen.time_ns: seen.image for seen in observe(path, looked_at, NEEDS)}
    trackers = [
        new_tracker(model, DEFAULT_METHOD, left_handed=entry.handedness == "left")
        for model in models
    ]
    reader = trackers[0].new_reader()
    found: list[dict[int, Support]] = []
    for index, seen in enumerate(observe(path, frames)):
        body = None if seen.joints is None else reader.read(seen.joints)
        if body is None:
            continue
        image = images.get(seen.time_ns)
        for tracker in trackers:
            if image is None:
                tracker.remember(body, seen.time_ns)
            else:
                tracker.step_body(body, seen.time_ns, image)
        if index - STEPS + 1 in firsts:
            told = {number: tracker.support for number, tracker in enumerate(trackers)}
            found.append({n: support for n, support in told.items() if support is not None})
    return found


def _mean(supports: Sequence[float], expected: float) -> float:
    return (sum(supports) + PRIOR_COUNT * expected) / (len(supports) + PRIOR_COUNT)


def _spread(found: Mapping[str, Sequence[float]], action: str) -> float:
    """That within images of one object, as much of the object's own as of all others'."""
    squares = {
        done: np.square(np.array(some) - np.mean(some)) for done, some in found.items() if some
    }
    own = squares.pop(action, np.empty(0))
    others = np.concatenate([np.empty(0), *squares.values()])
    usual = DEFAULT_RECOGNITION.usual_support_spread
    variances = [_variance(some, usual, PRIOR_COUNT) for some in (own, others) if len(some)]
    variance = np.mean(variances) if variances else usual**2
    return float(max(np.sqrt(variance), LEAST_SPREAD))


def _parts(own: Sequence[Support]) -> tuple[Array, Array]:
    """The means and spreads (4,) of the parts of an object's own supports."""
    if not own:
        return np.full(PARTS, -np.inf), np.array(DEFAULT_RECOGNITION.usual_part_spreads)
    told = np.array([one.parts for one in own])
    means = told.mean(axis=0)
    usual = DEFAULT_RECOGNITION.usual_part_spreads
    return means, np.sqrt(_variance(np.square(told - means), usual, PARTS_PRIOR_COUNT))


def _variance(squares: Array, usual_spreads: ArrayLike, prior_count: float) -> Array:
    """Of squared deviations (N, ...), as if so many had shown the usual spreads (...)."""
    usual = prior_count * np.square(usual_spreads)
    return np.asarray((squares.sum(axis=0) + usual) / (len(squares) + prior_count))
