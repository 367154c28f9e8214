"""Trains what a tracker's support is worth: that of objects which are there, and are not.

Every object is looked for in some frames of every recording, whichever is in use in it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.methods.object_tracker import ObjectTracker
from inhand_tracker.methods.registry import DEFAULT_METHOD, METHODS, new_tracker
from inhand_tracker.model.model import Model
from inhand_tracker.recognition.parameters import DEFAULT_RECOGNITION
from inhand_tracker.recognition.presence import Presence
from inhand_tracker.sight.support import PARTS, Support
from numpy.typing import ArrayLike

from inhand_lab.datasets.dataset import Dataset, DatasetEntry
from inhand_lab.datasets.observations import observe
from inhand_lab.datasets.stretches import entry_frames
from inhand_lab.training.parameters import DEFAULT_TRAINING

NEEDS = METHODS[DEFAULT_METHOD].needs(METHODS[DEFAULT_METHOD].usual_terms)
"""What of a frame the trackers of objects look at."""


@dataclass(frozen=True)
class SupportSample:
    """The ``supports`` of objects, by their actions, in one look where somebody does ``action``.

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
    """Look for the objects of ``models``, which are those of ``actions``, and learn their presence.

    Raises RecordingError.
    """
    return presence_of(look_around(dataset, entries, actions, models), actions)


def look_around(
    dataset: Dataset,
    entries: Sequence[DatasetEntry],
    actions: Sequence[str],
    models: Sequence[Model],
) -> list[SupportSample]:
    """Look for every object several times in each recording; raises RecordingError."""
    return [
        SupportSample(entry.interaction, supports)
        for entry in entries
        for supports in _look_in(dataset, entry, dict(zip(actions, models, strict=True)))
    ]


def presence_of(samples: Sequence[SupportSample], actions: Sequence[str]) -> Presence:
    """Learn the presence of the objects of ``actions`` from looks at them."""
    supports, spreads, parts, part_spreads = [], [], [], []
    for action in actions:
        by_action = {done: _supports(samples, action, done) for done in actions}
        values = {done: [one.log_likelihood for one in some] for done, some in by_action.items()}
        supports.append(_mean_supports(values, action))
        spreads.append(_spread(values, action))
        means, deviations = _parts(by_action[action])
        parts.append(means)
        part_spreads.append(deviations)
    return Presence(*map(np.array, (supports, spreads, parts, part_spreads)))


def _look_in(
    dataset: Dataset, entry: DatasetEntry, models: Mapping[str, Model]
) -> Iterator[dict[str, Support]]:
    """Yield, for each look in a recording, the support of each object that has one."""
    path = dataset.path(entry)
    frames = entry_frames(dataset, entry)
    steps = DEFAULT_TRAINING.look_frames
    firsts = [int(share * (len(frames) - steps)) for share in DEFAULT_TRAINING.looks_at]
    looked_at = [frames[first + step] for first in firsts for step in range(steps)]
    images = {seen.time_ns: seen.image for seen in observe(path, looked_at, NEEDS)}
    trackers = {
        action: new_tracker(model, DEFAULT_METHOD, left_handed=entry.handedness == "left")
        for action, model in models.items()
    }
    reader = next(iter(trackers.values())).new_reader()
    for index, seen in enumerate(observe(path, frames)):
        body = None if seen.joints is None else reader.read(seen.joints, seen.convention)
        if body is None:
            continue
        image = images.get(seen.time_ns)
        for tracker in trackers.values():
            if image is None:
                tracker.remember(body, seen.time_ns)
            else:
                tracker.step_body(body, seen.time_ns, image)
        if index - steps + 1 in firsts:
            yield _supports_of(trackers)


def _supports_of(trackers: Mapping[str, ObjectTracker]) -> dict[str, Support]:
    """Return what the last image says for each object, by its action, where it says anything."""
    supports = {action: tracker.support for action, tracker in trackers.items()}
    return {action: support for action, support in supports.items() if support is not None}


def _supports(samples: Sequence[SupportSample], action: str, done: str) -> list[Support]:
    """Return the supports of an action's object where somebody does ``done``."""
    return [
        sample.supports[action]
        for sample in samples
        if sample.action == done and action in sample.supports
    ]


def _mean_supports(values: Mapping[str, Sequence[float]], action: str) -> list[float]:
    """Mean support (K,) of an action's object in images of each object.

    Images of an object without any, or with few, are taken to be like those of the others.
    """
    others = [value for done, some in values.items() if done != action for value in some]
    expected = dict.fromkeys(values, _mean(others, DEFAULT_RECOGNITION.usual_support_absent))
    expected[action] = DEFAULT_RECOGNITION.usual_support_present
    return [_mean(some, expected[done]) for done, some in values.items()]


def _mean(values: Sequence[float], expected: float) -> float:
    """Mean of values, as if the prior looks had shown the expected one."""
    prior = DEFAULT_TRAINING.prior_looks
    return (sum(values) + prior * expected) / (len(values) + prior)


def _spread(values: Mapping[str, Sequence[float]], action: str) -> float:
    """Standard deviation within images of one object; the object's own weigh as all others'."""
    usual = DEFAULT_RECOGNITION.usual_support_spread
    squares = {
        done: np.square(np.array(some) - np.mean(some)) for done, some in values.items() if some
    }
    own = squares.pop(action, np.empty(0))
    others = np.concatenate([np.empty(0), *squares.values()])
    variances = [
        _variance(some, usual, DEFAULT_TRAINING.prior_looks) for some in (own, others) if len(some)
    ]
    variance = np.mean(variances) if variances else usual**2
    return float(max(np.sqrt(variance), DEFAULT_TRAINING.least_support_spread))


def _parts(own: Sequence[Support]) -> tuple[Array, Array]:
    """Return the means and spreads (4,) of the parts of an object's own supports."""
    usual = DEFAULT_RECOGNITION.usual_part_spreads
    if not own:
        return np.full(PARTS, -np.inf), np.array(usual)
    parts = np.array([one.parts for one in own])
    means = parts.mean(axis=0)
    squares = np.square(parts - means)
    return means, np.sqrt(_variance(squares, usual, DEFAULT_TRAINING.prior_part_looks))


def _variance(squares: Array, usual_spreads: ArrayLike, prior_looks: float) -> Array:
    """Mean of squared deviations (N, ...), as if the prior looks had the usual spreads (...)."""
    usual = prior_looks * np.square(usual_spreads)
    return np.asarray((squares.sum(axis=0) + usual) / (len(squares) + prior_looks))
