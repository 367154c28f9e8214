"""Compares the simulated sensors with real ones, property by property.

The real ones are the Kinect skeletons and depth of UTD-MHAD: eight people who mime six actions of
the arms. The simulated ones are seen with the Kinect preset in every interaction there is. Nobody
does quite the same in both, so that properties are compared at the same pace of the same joint.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.realism.depth_properties import depth_properties
from inhand_lab.realism.measured_people import MeasuredPerson, real_people, simulated_people
from inhand_lab.realism.parameters import DEFAULT_REALISM, RealismParameters
from inhand_lab.realism.skeleton_properties import (
    GROUPS,
    SensorProperty,
    skeleton_properties,
)

STEPS = 3
"""Number of steps of a comparison."""

LEFT_OUT = (
    "confidences and tracking states: the recordings have none; ours are assumed",
    "losses of the whole person: the recordings have none; ours come once in two minutes",
    "the error that all joints share, and any bias: they need a truth beside the skeleton",
    "how fast people move: empty-handed swings peak at 2.9 to 5.4 m/s at the wrist there, and ours "
    "with things in hand at 2.1 to 4.8 m/s, so that all is compared at the same pace",
    "skeletons of people who turn away or who hold real objects, which hide hands and are "
    "taken for a part of them",
    "colour: the recordings kept have none; blur and noise are modelled, not fitted",
    "depth of rooms and of objects: the recordings have the person cut out; which objects "
    "return nothing is decided by what they are made of",
    "depth in motion: the infrared exposure does not blur ours",
    "multipath, sunlight, other Kinects and lenses' distortion",
    "the OAK-D preset: nothing real to compare it with; its figures are the maker's",
)
"""What the table leaves out, or the simulator does not do."""


@dataclass(frozen=True)
class SensorComparison:
    """A property as it really is and as it is simulated; NaN where nothing was recorded.

    The real one would lie between lowest and highest, had eight other people been recorded.
    """

    name: str
    unit: str
    on: str
    real: float
    lowest: float
    highest: float
    simulated: float

    @property
    def ratio(self) -> float:
        """Simulated over real; NaN where there is nothing real to compare with."""
        return self.simulated / self.real if self.real > 0.0 else np.nan

    @property
    def judged(self) -> bool:
        """Whether eight other people would give the real property to within the factor."""
        factor = DEFAULT_REALISM.within
        return 0.0 < self.real <= factor * self.lowest and self.highest <= factor * self.real

    @property
    def within(self) -> bool:
        """Whether real and simulated are within the factor of each other."""
        return 1.0 / DEFAULT_REALISM.within <= self.ratio <= DEFAULT_REALISM.within


def compare_sensors(
    folder: Path,
    seed: int,
    on_progress: Callable[[], None] = lambda: None,
    parameters: RealismParameters = DEFAULT_REALISM,
) -> list[SensorComparison]:
    """Compare every property of the real recordings in a folder with the world of a seed.

    ``on_progress`` is called once for each of STEPS. Raises DatasetError where there are none.
    """
    real = real_people(folder)
    on_progress()
    lowest, highest = property_intervals(real, parameters)
    on_progress()
    simulated = simulated_people(seed, parameters.participants)
    on_progress()
    return [
        SensorComparison(
            truth.name, truth.unit, truth.on, truth.value, float(low), float(high), ours.value
        )
        for truth, low, high, ours in zip(
            sensor_properties(real), lowest, highest, sensor_properties(simulated), strict=True
        )
    ]


def sensor_properties(people: Sequence[MeasuredPerson]) -> list[SensorProperty]:
    """Measure these people together: the same properties in the same order for any people."""
    return [
        *skeleton_properties([one.skeletons for one in people]),
        *_returns([one.again for one in people]),
        *depth_properties([pair for one in people for pair in one.depth]),
    ]


def _returns(people: Sequence[Array]) -> Iterator[SensorProperty]:
    """Give how nearly joints (20,) of people come back, by kind of joint."""
    for group, joints in GROUPS.items():
        value = 1000.0 * float(np.mean(np.array(people)[:, joints]))
        name = f"{group}, how near it comes back"
        yield SensorProperty(name, "‰ of stature", "arms at work", value)


def property_intervals(
    people: Sequence[MeasuredPerson], parameters: RealismParameters = DEFAULT_REALISM
) -> tuple[Array, Array]:
    """Estimate the lowest and highest of each property (F,) by the bootstrap over people (Efron &
    Tibshirani, *An Introduction to the Bootstrap*, 1993, section 13.3): recordings of one person
    are alike.

    A property that some draws cannot measure may be anything there.
    """
    random = np.random.default_rng(parameters.seed)
    chosen = random.integers(len(people), size=(parameters.resamples, len(people)))
    draws = np.array(
        [[one.value for one in sensor_properties([people[n] for n in draw])] for draw in chosen]
    )
    aside = 0.5 * (1.0 - parameters.confidence)
    least, most = np.nan_to_num(draws, nan=0.0), np.nan_to_num(draws, nan=np.inf)
    return (
        np.quantile(least, aside, axis=0, method="lower"),
        np.quantile(most, 1.0 - aside, axis=0, method="higher"),
    )
