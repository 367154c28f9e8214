"""Recognises actions by one person's movement, and keeps what was learned to do it."""

from dataclasses import dataclass

import numpy as np

from inhand_tracker.body.reader import Body
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.recognition.arm_courses import CourseFollower
from inhand_tracker.recognition.class_filter import ClassFilter, reweighted
from inhand_tracker.recognition.movement_classes import MovementClasses
from inhand_tracker.recognition.movement_window import MovementWindow
from inhand_tracker.recognition.pairwise_svm import PairwiseSvm
from inhand_tracker.recognition.parameters import DEFAULT_RECOGNITION, RecognitionParameters
from inhand_tracker.recognition.presence import Presence


@dataclass(frozen=True)
class LearnedCascade:
    """What `cascade` needs of a recogniser: all but the actions' names and Darby's machine.

    ``body_poses`` (M, 60) are some of the people learned from. ``movements`` classify the last
    seconds; ``temper`` is the share of each frame's evidence that is new; ``presence`` is what
    images say of the actions' objects.
    """

    body_poses: Array
    movements: MovementClasses
    temper: float
    presence: Presence


@dataclass(frozen=True)
class Recogniser(LearnedCascade):
    """All that was learned to recognise ``actions`` (K), the names of interactions.

    ``svm`` classifies body poses one by one (Darby et al. 2012).
    """

    actions: tuple[str, ...]
    svm: PairwiseSvm


class MovementRecogniser:
    """Recognises one person's action by the last seconds of movement."""

    def __init__(
        self,
        classes: MovementClasses,
        temper: float,
        parameters: RecognitionParameters = DEFAULT_RECOGNITION,
    ) -> None:
        self._classes = classes
        self._parameters = parameters
        self._temper = temper
        self._filter = ClassFilter(classes.actions, temper, parameters)
        self._arms: CourseFollower | None = None
        if classes.arms is not None:
            self._arms = CourseFollower(classes.arms, classes.actions, parameters)
        self.restart()

    def restart(self) -> None:
        """Start anew: somebody else comes into view."""
        self._window = MovementWindow(self._parameters)
        if self._arms is not None:
            self._arms.restart()
        self._filter.restart()

    def step(self, time_ns: int, body: Body, seen: Array | None = None) -> Array:
        """Give the probabilities (K + 1,) of the actions and, last, of none or an unknown one.

        ``seen`` (K + 1,) is the log evidence of the last looks at images, None where there is
        none. It counts over time, as any other evidence, and at once: and so does then what the
        movement says against an action, so that what only looks like its object is none.
        """
        self.remember(time_ns, body)
        home, movement = self._movement_evidence(seeing=seen is not None)
        evidence = home * movement
        doubts = home * self._parameters.against_at_once * np.minimum(movement - movement[-1], 0.0)
        looks = self._parameters.looks_at_once
        if self._arms is not None and home < 1.0:
            # All of it is new: scores have added up what goes before.
            evidence = evidence + (1.0 - home) * self._arms.evidence() / self._temper
            doubts = doubts + (1.0 - home) * looks * self._arms.doubts()
        if seen is None:
            return self._filter.step(time_ns, evidence)
        return reweighted(self._filter.step(time_ns, evidence + seen), doubts + looks * seen)

    def remember(self, time_ns: int, body: Body) -> None:
        """Take a frame in which nothing is to be recognised; the movement counts later."""
        self._window.add(time_ns, body.pose)
        if self._arms is not None:
            self._arms.add(time_ns, body.pose)

    def _movement_evidence(self, *, seeing: bool) -> tuple[float, Array]:
        """How far the body is like the learned ones, 1 to 0, and the log evidence (K + 1,) of its
        movement; it counts in full where nothing was learned of arms."""
        features = self._window.features()[None]
        doubts = self._classes.doubts(features, seeing=seeing, parameters=self._parameters)
        evidence = (self._classes.evidence(features, self._parameters) + doubts)[0]
        if self._arms is None:
            return 1.0, evidence
        return float(self._classes.at_home(features, self._parameters)[0]), evidence
