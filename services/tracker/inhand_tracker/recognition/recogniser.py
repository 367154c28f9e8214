"""A learned recogniser of actions, and what it makes of one person's movement."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from inhand_tracker.body.reader import Body
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.recognition.class_filter import ClassFilter
from inhand_tracker.recognition.movement import Movement
from inhand_tracker.recognition.movement_classes import MovementClasses
from inhand_tracker.recognition.pairwise_svm import PairwiseSvm
from inhand_tracker.recognition.presence import Presence

AT_ONCE = 2.5
"""So many looks' worth are the last ones together."""


@dataclass(frozen=True)
class Recogniser:
    """``actions`` (K) are interactions; ``body_poses`` (M, 60) are some of the people learned from.

    ``svm`` reads body poses one by one (Darby et al. 2012), ``movements`` the last seconds;
    ``temper`` is how much of each frame's evidence is new; ``presence`` is what images say of
    the actions' objects.
    """

    actions: tuple[str, ...]
    body_poses: Array
    svm: PairwiseSvm
    movements: MovementClasses
    temper: float
    presence: Presence


class LearnedCascade(Protocol):
    """What `cascade` needs of a recogniser: all but the support vector machine."""

    @property
    def body_poses(self) -> Array:
        """(M, 60), of some of the people learned from."""

    @property
    def movements(self) -> MovementClasses:
        """What the last seconds say."""

    @property
    def temper(self) -> float:
        """How much of each frame's evidence is new."""

    @property
    def presence(self) -> Presence:
        """What images say of the actions' objects."""


class MovementRecogniser:
    """Follows one person's action by the last seconds of movement."""

    def __init__(self, classes: MovementClasses, temper: float) -> None:
        self._classes = classes
        self._filter = ClassFilter(classes.actions, temper)
        self.restart()

    def restart(self) -> None:
        """Somebody else comes into view."""
        self._movement = Movement()
        self._filter.restart()

    def step(self, time_ns: int, body: Body, seen: Array | None = None) -> Array:
        """The probabilities (K + 1,) of the actions and, last, of none or an unknown one.

        ``seen`` (K + 1,) is log evidence of the last looks at images, None where there is none.
        It counts at once, and as any other evidence over time.
        """
        self._movement.add(time_ns, body.pose)
        features = self._movement.features()[None]
        doubts = self._classes.doubts(features, seeing=seen is not None)
        evidence = (self._classes.evidence(features) + doubts)[0]
        if seen is None:
            return self._filter.step(time_ns, evidence)
        probabilities = self._filter.step(time_ns, evidence + seen)
        logs = np.log(np.maximum(probabilities, 1e-300)) + AT_ONCE * seen
        weights = np.exp(logs - logs.max())
        return np.asarray(weights / weights.sum())
