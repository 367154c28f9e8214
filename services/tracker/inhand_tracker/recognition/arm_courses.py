"""Judges which action the arms do by following them along the courses they took in recordings.

What is seen is aligned with every recording as it comes, from anywhere in the recording on, faster
or slower (local alignment: Smith and Waterman 1981). Each observation adds how much likelier it is
there than of arms that hang or are anywhere, and the sum fades. So a score says that a movement was
made in the taught order. An observation is worth as much as somebody moves: who stands still in a
taught pose proves nothing by it. The faster a recording is, the farther others may be from it.
"""

from collections import deque
from dataclasses import dataclass

import numpy as np

from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.recognition.arm_movement import MOVED, UPPER_ARMS, WRISTS, ArmReader
from inhand_tracker.recognition.parameters import (
    DEFAULT_RECOGNITION,
    ArmParameters,
    RecognitionParameters,
)

MIRROR = np.array([-1.0, 1.0, 1.0])
"""Makes a left arm's place or direction of a right one's."""
FARTHEST = 3
"""Number of observations of a recording that may go by in one step."""


@dataclass(frozen=True)
class ArmCourses:
    """Courses of the arms in C recordings: ``observations`` (J, 18) of all, one after the other,
    the ``lengths`` (C,) of each, and the numbers of their actions, ``owners`` (C,)."""

    observations: Array
    lengths: Indices
    owners: Indices


class CourseFollower:
    """Follows one person's arms along the courses of K actions.

    Observations are only kept until ``evidence`` is asked for: most bodies never need it.
    """

    def __init__(
        self,
        courses: ArmCourses,
        actions: int,
        parameters: RecognitionParameters = DEFAULT_RECOGNITION,
    ) -> None:
        self._parameters = parameters
        self._owners = courses.owners
        self._actions = actions
        starts = np.cumsum(courses.lengths) - courses.lengths
        # Before each course stand rows that no score enters, so that none leaves another course.
        number = np.repeat(np.arange(1, len(starts) + 1), courses.lengths)
        rows = np.arange(len(courses.observations)) + FARTHEST * number
        self._firsts = starts + FARTHEST * np.arange(len(starts))
        count = len(rows) + FARTHEST * len(starts)
        self._constants = np.full(count, -np.inf)
        self._weights = np.zeros((count, 2 * courses.observations.shape[1]))
        self._constants[rows], self._weights[rows] = _likelihood_terms(
            courses.observations, parameters.arms
        )
        self.restart()

    def restart(self) -> None:
        """Start anew: somebody else comes into view."""
        self._reader = ArmReader(self._parameters)
        self._waiting: deque[Array] = deque()
        self._scores = np.zeros(len(self._constants) + FARTHEST)

    def add(self, time_ns: int, pose: Array) -> None:
        """Take the body pose (60,) of a frame."""
        self._waiting.extend(self._reader.read(time_ns, pose))
        longest = round(self._parameters.arms.remembered_s * self._parameters.arms.rate_hz)
        if len(self._waiting) > longest:
            self._scores[:] = 0.0
        while len(self._waiting) > longest:
            self._waiting.popleft()

    def evidence(self) -> Array:
        """Log evidence (K + 1,) of a frame for each action and, last, for none."""
        arms = self._parameters.arms
        return np.clip(self._beyond(), -arms.most_against, arms.most_for)

    def doubts(self) -> Array:
        """Log evidence (K + 1,) against each action, however little its arms move alike."""
        return np.minimum(self._beyond(), 0.0)

    def _beyond(self) -> Array:
        """By how much (K + 1,) the scores exceed what speaks for an action, as log evidence."""
        arms = self._parameters.arms
        return np.append(arms.gain * (self.scores() - arms.score), 0.0)

    def scores(self) -> Array:
        """Scores (K,) of the actions up to now."""
        while self._waiting:
            self._advance(self._waiting.popleft())
        best = np.zeros(self._actions)
        if len(self._firsts):
            by_course = np.maximum.reduceat(self._scores[FARTHEST:], self._firsts)
            np.maximum.at(best, self._owners, by_course)
        return best

    def _advance(self, observation: Array) -> None:
        """Align one more observation (18,)."""
        arms = self._parameters.arms
        old = self._scores
        reached = np.maximum(old[2:-1], old[3:] - arms.waiting)
        np.maximum(reached, old[1:-2] - arms.skipping, out=reached)
        np.maximum(reached, old[:-3] - 2.0 * arms.skipping, out=reached)
        terms = np.concatenate((observation, np.square(observation)))
        ratios = self._constants + self._weights @ terms - _usual_log(observation, arms)
        moved = np.linalg.norm(observation[MOVED].reshape(2, 3), axis=1).max()
        worth = min(1.0, arms.still_worth + moved / arms.moved)
        ratios = np.where(ratios > 0.0, worth * ratios, ratios)
        self._scores[FARTHEST:] = np.maximum(arms.kept * reached + ratios, 0.0)


def _likelihood_terms(observations: Array, arms: ArmParameters) -> tuple[Array, Array]:
    """Terms of the log-likelihood of an observation x at each of J places: constants (J,), and
    weights (J, 36) of x and of its squares."""
    speeds = np.square(observations[:, MOVED]).reshape(-1, 2, 3).sum(axis=2)
    variances = np.empty_like(observations)
    for part, (spread, share) in (
        (WRISTS, arms.wrist_spread),
        (MOVED, arms.moved_spread),
        (UPPER_ARMS, arms.upper_spread),
    ):
        variances[:, part] = np.repeat(spread**2 + share**2 * speeds, 3, axis=1)
    constants = -0.5 * (np.log(variances) + np.square(observations) / variances).sum(axis=1)
    return constants, np.hstack((observations / variances, -0.5 / variances))


def _usual_log(observation: Array, arms: ArmParameters) -> float:
    """Log density of an observation (18,) where nothing is in use: each arm hangs or is anywhere.

    Factors of 2 π are left out, here as in the courses.
    """
    total = 0.0
    for arm, sides in ((0, np.ones(3)), (1, MIRROR)):
        wrist, moved, upper = (
            sides * observation[part].reshape(2, 3)[arm] for part in (WRISTS, MOVED, UPPER_ARMS)
        )
        slow = _log_density(moved, 0.0, arms.slow_spread)
        fast = _log_density(moved, 0.0, arms.fast_spread)
        hanging = slow + _log_density(wrist, arms.hanging_wrist, arms.hanging_wrist_spread)
        hanging += _log_density(upper, arms.hanging_upper, arms.hanging_upper_spread)
        anywhere = np.logaddexp(slow, fast) - np.log(2.0)
        anywhere += _log_density(wrist, arms.any_wrist, arms.any_wrist_spread)
        anywhere += _log_density(upper, arms.any_upper, arms.any_upper_spread)
        total += float(np.logaddexp(hanging, anywhere) - np.log(2.0))
    return total


def _log_density(values: Array, middle: tuple[float, ...] | float, spread: float) -> float:
    """Log density of (3,) numbers under a normal distribution, but for factors of 2 π."""
    apart = (values - np.asarray(middle)) / spread
    return float(-0.5 * apart @ apart - 3.0 * np.log(spread))
