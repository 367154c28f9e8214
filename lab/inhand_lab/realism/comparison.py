"""How near the simulated sensors are to real ones, property by property.

The real ones are the Kinect skeletons and depth of UTD-MHAD: eight people who mime six actions of
the arms. The simulated ones are seen with the Kinect preset in every interaction there is. Nobody
does quite the same in both, so that properties are compared at the same pace of the same joint.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from inhand_tracker.geometry.arrays import Array
from numpy.typing import NDArray
from scipy.ndimage import binary_dilation

from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.geometry.transforms import Transform
from inhand_lab.importers import utd_mhad
from inhand_lab.realism.depth import DepthPair, SeenDepth, measure_depth, observe_depth
from inhand_lab.realism.repeatability import joints_again, poses_of
from inhand_lab.realism.skeletons import (
    FRAME_RATE,
    GROUPS,
    Figure,
    Observed,
    measure_skeletons,
)
from inhand_lab.sensing.render import ROOM
from inhand_lab.world.interactions import INTERACTIONS
from inhand_lab.world.simulation import Simulation, simulate

WITHIN = 1.5
"""A simulated figure should not differ by more than this factor from the real one."""
RESAMPLES, CONFIDENCE = 200, 0.95
"""Draws of the real people, with replacement, and the share of them that an interval holds."""
PARTICIPANTS = 8
MIMED = ("armCurl", "knock", "drawX")
WORKED = ("liftWeights", "hammerNail", "drinkFromMug")
"""Actions, real and simulated, of arms while the body stands."""
DEPTH_EVERY = 6
"""Of the real depth every so many frames are measured, and of the simulated one as many."""
DEPTH_FRAMES, DEPTH_OF_EVERY = tuple(range(24, 355, 30)), 4

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
"""What the table does not tell, or the simulator does not do."""


@dataclass(frozen=True)
class Comparison:
    """A property as it really is and as it is simulated; nan where nothing was recorded.

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
        """Simulated over real; nan where there is nothing real to compare with."""
        return self.simulated / self.real if self.real > 0.0 else np.nan

    @property
    def told(self) -> bool:
        """Whether the real figure is itself known to within the factor WITHIN."""
        return 0.0 < self.real <= WITHIN * self.lowest and self.highest <= WITHIN * self.real

    @property
    def within(self) -> bool:
        """Whether the two are within the factor WITHIN of each other."""
        return 1.0 / WITHIN <= self.ratio <= WITHIN


@dataclass(frozen=True)
class Recorded:
    """What was recorded of one person; ``again`` (20,) tells how nearly each joint comes back, in
    body heights, in movements of the arms alone."""

    skeletons: list[Observed]
    depth: list[SeenDepth]
    again: Array


def compare(
    folder: Path,
    seed: int,
    on_progress: Callable[[], None] = lambda: None,
    participants: int = PARTICIPANTS,
) -> list[Comparison]:
    """Every property of the real recordings in a folder, beside the world of a seed.

    ``on_progress`` is called once for each of STAGES. Raises DatasetError where there are none.
    """
    files = sorted(folder.glob(f"*{utd_mhad.SKELETON_SUFFIX}"))
    if not files:
        raise DatasetError(f"{folder} has no recordings of UTD-MHAD: name their folder with --data")
    real = _real_people([utd_mhad.read_trial(file) for file in files])
    on_progress()
    lowest, highest = interval(real)
    on_progress()
    simulated = _simulated_people(seed, participants)
    on_progress()
    return [
        Comparison(
            truth.name, truth.unit, truth.on, truth.value, float(low), float(high), ours.value
        )
        for truth, low, high, ours in zip(
            figures_of(real), lowest, highest, figures_of(simulated), strict=True
        )
    ]


STAGES = 3


def figures_of(people: list[Recorded]) -> list[Figure]:
    """Every figure of these people together, the same in the same order for any people."""
    return [
        *measure_skeletons([one.skeletons for one in people]),
        *_returning([one.again for one in people]),
        *measure_depth([pair for one in people for pair in one.depth]),
    ]


def _returning(people: list[Array]) -> Iterator[Figure]:
    for group, joints in GROUPS.items():
        value = 1000.0 * float(np.mean(np.array(people)[:, joints]))
        yield Figure(f"{group}, how near it comes back", "‰ of stature", "arms at work", value)


def interval(people: list[Recorded]) -> tuple[Array, Array]:
    """Lowest and highest of each figure (F,) by the bootstrap over people (Efron & Tibshirani,
    *An Introduction to the Bootstrap*, 1993, section 13.3): recordings of one person are alike.

    A figure that some draws cannot tell may be anything there.
    """
    random = np.random.default_rng(0)
    draws = np.array(
        [
            [figure.value for figure in figures_of([people[number] for number in chosen])]
            for chosen in random.integers(len(people), size=(RESAMPLES, len(people)))
        ]
    )
    aside = 0.5 * (1.0 - CONFIDENCE)
    least, most = np.nan_to_num(draws, nan=0.0), np.nan_to_num(draws, nan=np.inf)
    return (
        np.quantile(least, aside, axis=0, method="lower"),
        np.quantile(most, 1.0 - aside, axis=0, method="higher"),
    )


def _real_people(trials: list[utd_mhad.UtdMhadTrial]) -> list[Recorded]:
    return [
        Recorded(
            [Observed.of(trial.joints_in_camera) for trial in own],
            [observe_depth(pair) for trial in own for pair in _real_pairs(trial)],
            _returns([trial for trial in own if trial.interaction in MIMED]),
        )
        for name in sorted({trial.participant for trial in trials})
        for own in [[trial for trial in trials if trial.participant == name]]
    ]


def _simulated_people(seed: int, participants: int) -> list[Recorded]:
    """Everybody does everything; as many frames of depth are measured as there are real ones."""
    people = []
    for participant in range(participants):
        done = [simulate(interaction, participant, seed) for interaction in INTERACTIONS]
        shown = done[participant % DEPTH_OF_EVERY :: DEPTH_OF_EVERY]
        people.append(
            Recorded(
                [Observed.of(one.joints_in_camera) for one in done],
                [observe_depth(pair) for one in shown for pair in _simulated_pairs(one)],
                _returns([one for one in done if one.interaction in WORKED]),
            )
        )
    return people


def _returns(recordings: Sequence[utd_mhad.UtdMhadTrial] | Sequence[Simulation]) -> Array:
    """How nearly each joint (20,) of one person comes back in doing the same, in body heights."""
    actions = sorted({one.interaction for one in recordings})
    return np.mean(
        [
            joints_again(
                [
                    poses_of("", FRAME_RATE, "right", one.joints_in_camera)
                    for one in recordings
                    if one.interaction == action
                ]
            )
            for action in actions
        ],
        axis=0,
    )


def _real_pairs(trial: utd_mhad.UtdMhadTrial) -> Iterator[DepthPair]:
    if trial.depth_file is None:
        return
    depth = utd_mhad.read_depth(trial.depth_file)
    count = min(len(depth), len(trial.joints_in_camera))
    centre = (utd_mhad.WIDTH - 1 - utd_mhad.MIRRORED_CX, utd_mhad.CY)
    for frame in range(2, count - 1, DEPTH_EVERY):
        yield DepthPair(
            (depth[frame], depth[frame + 1]),
            (trial.joints_in_camera[frame], trial.joints_in_camera[frame + 1]),
            utd_mhad.FOCAL_LENGTH,
            centre,
        )


def _simulated_pairs(simulation: Simulation) -> Iterator[DepthPair]:
    """Without object and furniture, for the real people mime."""
    behind = Transform(np.array([0.0, 0.0, -9.0]), np.eye(3)).repeated(simulation.frames)
    simulation = replace(simulation, camera_from_object=behind, furniture=())
    intrinsics, joints = simulation.intrinsics, simulation.joints_in_camera
    for frame in DEPTH_FRAMES:
        yield DepthPair(
            (_person_alone(simulation, frame), _person_alone(simulation, frame + 1)),
            (joints[frame], joints[frame + 1]),
            0.5 * intrinsics.fx,
            (0.5 * intrinsics.cx, 0.5 * intrinsics.cy),
        )


def _person_alone(simulation: Simulation, frame: int) -> NDArray[np.uint16]:
    """The person at half the resolution, cut out as the recordings are: by depth,
    before what is behind."""
    drawing, seen = simulation.draw(frame), simulation.render(frame)
    true_depth = drawing.canvas.depth_in_millimetres()
    person = drawing.canvas.labels > ROOM
    near = binary_dilation(person, iterations=3) & (seen.depth < true_depth[person].max() + 150)
    return np.where(near, seen.depth, 0)[::2, ::2].astype(np.uint16)
