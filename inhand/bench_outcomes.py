"""``inhand bench outcomes``: what is said to be achieved, beside what truly was, of people unseen.

Datasets of people are simulated, a rig is taught all objects by others, the people are tracked from
their images, and what outcomes make of these poses is held against the simulation's truth.
Whatever of it stands in the folder already is used again.
"""

from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import msgspec
import numpy as np
from inhand_lab.achieved.sweeping import PIXEL_M, swept_floor
from inhand_lab.achieved.true_achievement import TrueAchievement
from inhand_lab.achieved.truths import TRUTHS
from inhand_lab.motions.performance import ContactKind
from inhand_lab.world.interactions import INTERACTIONS
from inhand_lab.world.simulation import Simulation, simulate
from inhand_outcomes.floor_map import empty_map
from inhand_outcomes.floor_watch import FloorWatch
from inhand_outcomes.measures.footprint import CELL_M
from inhand_outcomes.outcome import Outcome
from inhand_outcomes.things import load_things
from inhand_outcomes.watching import Watcher
from inhand_runtime.errors import InhandError
from inhand_runtime.recording import read_recording
from inhand_schemas.messages import CameraInfo, ObjectPose, RgbdFrame, Skeletons

from inhand.bench_outcomes_people import FRAMES, SUFFIX, teach, tracked_people

SURE = 0.5
"""Probability from which an outcome counts, as the settings have it unless they say otherwise."""
CENTIMETRES = 100.0


@dataclass(frozen=True)
class Compared:
    """One kind in one recording: how often it was said and how often it was, the error of all its
    durations together, and its amounts, said and true."""

    interaction: str
    kind: str
    said: int
    true: int
    seconds_off: float
    amounts: Mapping[str, tuple[float, float]] = field(default_factory=dict)


@dataclass(frozen=True)
class Handled:
    """Where a thing was put down in one recording, centimetres off; None where nobody said so."""

    interaction: str
    place_off_cm: float | None


@dataclass(frozen=True)
class Swept:
    """Intersection over union of the floor that was said to be swept in one recording and the
    floor that was, in the map's cells."""

    interaction: str
    iou: float


@dataclass(frozen=True)
class Mistaken:
    """How often something was said of an object that was not there, in one recording."""

    interaction: str
    object: str
    kind: str
    said: int


@dataclass(frozen=True)
class OutcomesCheck:
    """All recordings of all seeds; ``skeletons`` says whose they were."""

    skeletons: str
    recordings: int
    compared: Sequence[Compared]
    handled: Sequence[Handled]
    swept: Sequence[Swept]
    mistaken: Sequence[Mistaken]


def check_outcomes(
    folder: Path,
    seeds: Sequence[int],
    participants: int,
    advance: Callable[[], object],
    *,
    estimated: bool = False,
) -> OutcomesCheck:
    """Make what is missing in the folder, and compare each recording; raises InhandError.

    Skeletons are a Kinect's, or ``estimated`` from the images, of those who teach and of those who
    are watched; the rig knows all objects.
    """
    folder.mkdir(parents=True, exist_ok=True)
    taught = teach(folder, estimated=estimated)
    compared: list[Compared] = []
    handled: list[Handled] = []
    swept: list[Swept] = []
    mistaken: list[Mistaken] = []
    count = 0
    for seed in seeds:
        tracked = tracked_people(folder, seed, participants, taught, estimated=estimated)
        for interaction in INTERACTIONS:
            for participant in range(participants):
                path = tracked / f"{interaction}_p{participant:02}.mcap"
                simulation = simulate(interaction, participant, seed, FRAMES)
                said, watcher = said_of(path, taught.files)
                name = simulation.object_model.name
                outcomes = [one for one in said if one.object == name]
                compared += list(_compare(simulation, outcomes))
                handled += list(_places(simulation, outcomes))
                swept += list(_swept(simulation, watcher))
                others = Counter((one.object, one.kind) for one in said if one.object != name)
                mistaken += [Mistaken(interaction, *key, times) for key, times in others.items()]
                count += 1
                advance()
    skeletons = "estimated skeletons" if estimated else "a Kinect's skeletons"
    return OutcomesCheck(skeletons, count, compared, handled, swept, mistaken)


def steps(seeds: Sequence[int], participants: int) -> int:
    """Number of recordings that ``check_outcomes`` compares."""
    return len(seeds) * participants * len(INTERACTIONS)


Told = tuple[str, CameraInfo | RgbdFrame | Skeletons | ObjectPose]
"""A message with the camera or object that it is of."""


def said_of(recording: Path, models: Sequence[Path]) -> tuple[list[Outcome], Watcher]:
    """Watch a tracked recording as the daemon does; all that is said, and who has watched."""
    return said_by(_told(recording), models)


def _told(recording: Path) -> Iterator[Told]:
    for one in read_recording(recording, streams=("info", "rgbd", "skeletons", "pose")):
        message = one.message()
        if isinstance(message, CameraInfo | RgbdFrame | Skeletons):
            yield one.name, message
        elif isinstance(message, ObjectPose) and message.object.endswith(SUFFIX):
            name = message.object.removesuffix(SUFFIX)
            yield name, msgspec.structs.replace(message, object=name)


def said_by(told: Iterable[Told], models: Sequence[Path]) -> tuple[list[Outcome], Watcher]:
    """Watch what a rig tells as the daemon does; all that is said, and who has watched."""
    things, problems = load_things(models, {})
    if problems:
        raise InhandError(problems[0])
    watcher = Watcher(things, "bench")
    floors = FloorWatch(watcher.floors.see)
    outcomes: list[Outcome] = []
    for name, message in told:
        if isinstance(message, CameraInfo):
            watcher.hear_info(name, message)
            floors.hear_info(name, message)
        elif isinstance(message, RgbdFrame):
            floors.hear_frame(name, message)
        elif isinstance(message, Skeletons):
            floors.hear_skeletons(name, message)
            outcomes += watcher.hear_skeletons(name, message)
        else:
            outcomes += watcher.hear_pose(message)
        if floors.room is not None:
            watcher.room = floors.room
    sure = [one for one in outcomes + watcher.end_all() if one.probability >= SURE]
    return sure, watcher


def _compare(simulation: Simulation, outcomes: Sequence[Outcome]) -> Iterator[Compared]:
    true: dict[str, list[TrueAchievement]] = defaultdict(list)
    for one in TRUTHS[simulation.interaction](simulation):
        true[one.kind].append(one)
    said: dict[str, list[Outcome]] = defaultdict(list)
    for outcome in outcomes:
        said[outcome.kind].append(outcome)
    for kind in sorted({*true, *said} - HANDLING):
        seconds = sum(one.seconds for one in said[kind])
        true_seconds = sum(one.end_s - one.start_s for one in true[kind])
        yield Compared(
            simulation.interaction,
            kind,
            len(said[kind]),
            len(true[kind]),
            seconds - true_seconds,
            dict(_amounts(said[kind], true[kind])),
        )


HANDLING = {"taken_up", "put_down", "dropped", "left_in_use", "handed_over"}


def _amounts(
    said: Sequence[Outcome], true: Sequence[TrueAchievement]
) -> Iterator[tuple[str, tuple[float, float]]]:
    """Sums of each amount over a recording, said and true."""
    for name in sorted({name for one in true for name in one.amounts}):
        here = [one.amounts[name].value for one in said if name in one.amounts]
        yield name, (sum(here), sum(one.amounts.get(name, 0.0) for one in true))


def _places(simulation: Simulation, outcomes: Sequence[Outcome]) -> Iterator[Handled]:
    """Where what lies at the end was put down."""
    resting = simulation.contact == ContactKind.RESTING
    if not resting[-1] or resting.all():
        return
    put = [one for one in outcomes if one.kind == "put_down" and one.rig_from_object is not None]
    if not put or put[-1].rig_from_object is None:
        yield Handled(simulation.interaction, None)
        return
    off = np.array(put[-1].rig_from_object.translation) - simulation.translations[-1]
    yield Handled(simulation.interaction, CENTIMETRES * float(np.linalg.norm(off)))


def _swept(simulation: Simulation, watcher: Watcher) -> Iterator[Swept]:
    """How well the map of what was swept agrees, where anything was."""
    points = swept_floor(simulation) if simulation.interaction == "sweepFloor" else np.empty((0, 3))
    if len(points) == 0:
        return
    maps = watcher.floors.maps()
    said = maps[0].is_swept() if maps else np.zeros(empty_map().size, bool)
    level = (points @ watcher.room.matrix.T + watcher.room.translation)[:, :2]
    cells = np.floor((level - empty_map().corner) / CELL_M).astype(int)
    covered = np.zeros(said.shape)
    np.add.at(covered, tuple(cells.T), PIXEL_M**2)
    true = covered >= 0.5 * CELL_M**2
    yield Swept(simulation.interaction, float((said & true).sum() / (said | true).sum()))
