"""A learned recogniser of actions, and what it makes of one person's movement."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inhand_tracker.body_reader import Body
from inhand_tracker.class_filter import ClassFilter
from inhand_tracker.movement import Movement
from inhand_tracker.movement_classes import MovementClasses
from inhand_tracker.pairwise_svm import PairwiseSvm
from inhand_tracker.presence import Presence

Array = NDArray[np.float64]


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

        ``seen`` (K + 1,) is further log evidence, from an image; None where there is none.
        """
        self._movement.add(time_ns, body.pose)
        features = self._movement.features()[None]
        evidence = self._classes.evidence(features)[0]
        further = self._classes.doubts(features)[0] if seen is None else seen
        return self._filter.step(time_ns, evidence + further)
