"""Maps one person's joints from their source's convention to that of what was learned.

The measures of both (``convention_table``) differ by as much as joints are moved. A convention that
is tabulated has the table's; of any other one they are read from the person, as from those whom a
model was learned from. People differ too: what is within that is no convention, and stays.
"""

from functools import cached_property

import numpy as np
from inhand_runtime.running_medians import RunningMedians

from inhand_tracker.body.convention_table import (
    CANONICAL,
    MEASURES,
    OF_THE_TRUNK,
    PEOPLE_DIFFER,
    TABLE,
)
from inhand_tracker.body.kernels import conventions as kernels
from inhand_tracker.body.parameters import DEFAULT_BODY, BodyParameters
from inhand_tracker.body.skeleton import RunningHeight, stature_of
from inhand_tracker.geometry.arrays import Array

_TWELVE = np.zeros(len(MEASURES))
"""It tells the kernel how many measures there are."""


def measure_bodies(
    joints: Array, height: Array | float, parameters: BodyParameters = DEFAULT_BODY
) -> Array:
    """Measure bodies (..., 20, 3) of people of a height: (..., 12) in body heights, as ``MEASURES``
    has them; NaN where a joint is missing, or a posture shows nothing of a convention."""
    return kernels.measure(joints, height, parameters.upright_cosine, _TWELVE)


def median_measures(measures: Array, least: int) -> Array:
    """The medians (12,) of measures (T, 12); NaN where fewer frames than the least have one."""
    median = np.full(len(MEASURES), np.nan)
    enough = np.isfinite(measures).sum(axis=0) >= least
    if enough.any():
        median[enough] = np.nanmedian(measures[:, enough], axis=0)
    return median


def move_joints(joints: Array, differences: Array, height: Array | float) -> Array:
    """Move the joints of people (..., 20, 3) by differences (12,) of their measures."""
    return kernels.move(joints, np.nan_to_num(differences), height)


def are_apart(differences: Array, parameters: BodyParameters = DEFAULT_BODY) -> bool:
    """Whether differences (12,) are more than those between people of one convention; what is 0 is
    not known."""
    apart = differences[differences != 0.0] / PEOPLE_DIFFER[differences != 0.0]
    return bool(np.square(apart).sum() > parameters.apart_deviations**2 * max(len(apart), 1))


def canonical_joints(joints: Array, convention: str | None) -> Array:
    """Give one person's joints (T, 20, 3) as the canonical body has them.

    Those of a convention that is not tabulated, or not named, stay as they are.
    """
    if convention not in TABLE or convention == CANONICAL:
        return joints
    return move_joints(joints, TABLE[CANONICAL] - TABLE[convention], stature_of(joints))


class ConventionMap:
    """Maps one person's joints to the convention ``name`` of what was ``learned``, poses (N, 60).

    ``proportions`` (19,) are usual lengths of parts. Joints of a source that names the same
    convention, or says as little as the model, stay as they are.
    """

    def __init__(
        self,
        name: str | None,
        learned: Array,
        proportions: Array,
        parameters: BodyParameters = DEFAULT_BODY,
    ) -> None:
        self._name = name
        self._learned = learned
        self._proportions = proportions
        self._parameters = parameters
        self._begin(name)

    def _begin(self, source: str | None) -> None:
        """Forget the person, and take joints of a source from here on."""
        self._source = source
        self._frames = 0
        self._stature = float("nan")
        self._height = RunningHeight(self._proportions, self._parameters)
        self._medians = RunningMedians(len(MEASURES), self._parameters.height_frames)
        self._differences = np.zeros(len(MEASURES))
        if source in TABLE and source != self._name:
            self._differences = self._differences_from(TABLE[source])

    @property
    def trouble(self) -> str | None:
        """What is wrong with skeletons that name their convention; None where nothing is."""
        source, parameters = self._source, self._parameters
        if source in (None, self._name) or source in TABLE or self._frames < parameters.patience:
            return None
        if self._medians.counts[:OF_THE_TRUNK].max() >= parameters.least_measured:
            return None
        learned = "of a convention it does not name" if self._name is None else repr(self._name)
        return (
            f"skeletons are {source!r} and the model is {learned}: poses are less sure until "
            "somebody stands before the camera for two seconds, arms down, and shows the difference"
        )

    def apply(self, joints: Array, source: str | None) -> Array:
        """Map joints (20, 3), NaN where missing, of a source that says it is of a convention."""
        if source != self._source:
            self._begin(source)
        if source == self._name:
            return joints
        # Nobody grows: after the first second a frame in fifteen says how tall they are.
        parameters = self._parameters
        is_due = self._frames % parameters.measured_every == 0
        if is_due or self._frames < parameters.least_measured:
            self._stature = self._height.update(joints)
        self._frames += 1
        if source not in TABLE:
            self._read(joints, is_due=is_due)
        return kernels.move(joints, self._differences, self._stature)

    def _read(self, joints: Array, *, is_due: bool) -> None:
        """Read the convention of a source that is not tabulated from a frame of the person."""
        medians = self._medians.update(measure_bodies(joints, self._stature, self._parameters))
        if is_due:
            seldom = self._medians.counts < self._parameters.least_measured
            self._differences = self._differences_from(np.where(seldom, np.nan, medians))

    def _differences_from(self, measured: Array) -> Array:
        """The differences (12,) of a source's measures; zeros where they are people's own."""
        differences: Array = np.nan_to_num(self._target - measured)
        if self._name in TABLE and self._source in TABLE:
            return differences
        return differences if are_apart(differences, self._parameters) else 0.0 * differences

    @cached_property
    def _target(self) -> Array:
        """The measures (12,) of what was learned."""
        if self._name in TABLE:
            return TABLE[self._name]
        poses = self._learned.reshape(-1, 20, 3)
        return median_measures(measure_bodies(poses, 1.0), self._parameters.least_measured)
