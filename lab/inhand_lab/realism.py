"""How near the simulated sensors are to real ones, property by property.

The real ones are the Kinect skeletons and depth of UTD-MHAD: eight people who mime six actions of
the arms. The simulated ones are seen with the Kinect preset in every interaction there is. Nobody
does quite the same in both, so that properties are compared at the same pace of the same joint.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_dilation

from inhand_lab.dataset import DatasetError
from inhand_lab.importers import utd_mhad
from inhand_lab.realism_depth import DepthPair, measure_depth
from inhand_lab.realism_skeletons import Figure, measure_skeletons
from inhand_lab.render import ROOM
from inhand_lab.transforms import Transform
from inhand_lab.world import INTERACTIONS, Simulation, simulate

WITHIN = 1.5
"""A simulated figure should not differ by more than this factor from the real one."""
PARTICIPANTS = 8
SEED = 1402
DEPTH_EVERY = 6
"""Of the real depth every so many frames are measured, and of the simulated one as many."""
DEPTH_FRAMES = tuple(range(24, 355, 30))

LEFT_OUT = (
    "confidences and tracking states: the recordings have none; ours are assumed",
    "losses of the whole person: the recordings have none; ours come once in two minutes",
    "the error that all joints share, and any bias: they need a truth beside the skeleton",
    "how much the length of a bone differs between one stretch of 1.5 s and another of the same "
    "person: 5 to 14 mm there, where people stand and repeat one action, and 10 to 24 mm ours, "
    "where they do fifteen things",
    "what rests on too few real frames to tell: fast trunks and legs, and wrists that go 0.2 to "
    "1 m in 1.5 s (where their forearms vary by 1.6 times too much)",
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
    """A property as it really is and as it is simulated; nan where too little was simulated."""

    name: str
    unit: str
    on: str
    real: float
    simulated: float

    @property
    def ratio(self) -> float:
        """Simulated over real."""
        return self.simulated / self.real

    @property
    def within(self) -> bool:
        """Whether the two are within the factor WITHIN of each other."""
        return 1.0 / WITHIN <= self.ratio <= WITHIN


def compare(
    folder: Path, on_progress: Callable[[], None] = lambda: None, participants: int = PARTICIPANTS
) -> list[Comparison]:
    """Every property that the real recordings in a folder tell.

    ``on_progress`` is called once for each of STAGES. Raises DatasetError where there are none.
    """
    files = sorted(folder.glob(f"*{utd_mhad.SKELETON_SUFFIX}"))
    if not files:
        raise DatasetError(f"{folder} has no recordings of UTD-MHAD: name their folder with --data")
    trials = [utd_mhad.read_trial(file) for file in files]
    real = measure_skeletons([trial.joints_in_camera for trial in trials])
    on_progress()
    real += measure_depth(pair for trial in trials for pair in _real_pairs(trial))
    on_progress()
    people = [
        simulate(interaction, participant, SEED)
        for interaction in INTERACTIONS
        for participant in range(participants)
    ]
    simulated = measure_skeletons([one.joints_in_camera for one in people])
    on_progress()
    shown = people[:: max(1, participants // 2)]
    simulated += measure_depth(pair for one in shown for pair in _simulated_pairs(one))
    on_progress()
    return list(_compared(real, simulated))


STAGES = 4


def _compared(real: list[Figure], simulated: list[Figure]) -> Iterator[Comparison]:
    for truth, ours in zip(real, simulated, strict=True):
        if np.isfinite(truth.value):
            yield Comparison(truth.name, truth.unit, truth.on, truth.value, ours.value)


def _real_pairs(trial: utd_mhad.Trial) -> Iterator[DepthPair]:
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
