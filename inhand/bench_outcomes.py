"""``inhand bench outcomes``: what is said to be achieved, beside what truly was, of people unseen.

Datasets of people are simulated, objects' models are learned from others, the people are tracked
from their images, and what outcomes make of these poses is held against the simulation's truth.
Whatever of it stands in the folder already is used again.
"""

import subprocess
import sys
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import msgspec
import numpy as np
from inhand_lab.achieved.sweeping import PIXEL_M, swept_floor
from inhand_lab.achieved.true_achievement import TrueAchievement
from inhand_lab.achieved.truths import TRUTHS
from inhand_lab.motions.performance import ContactKind
from inhand_lab.people.person import USUAL_PEOPLE, sample_person
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
from rich.table import Table

TAUGHT_BY = 5150
"""Seed of the people who teach the models."""
TEACHERS = 3
TAUGHT_FRAMES = 300
FRAMES = 360
SUFFIX = "_retrack"
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
class OutcomesCheck:
    """All recordings of all seeds."""

    recordings: int
    compared: Sequence[Compared]
    handled: Sequence[Handled]
    swept: Sequence[Swept]


def check_outcomes(
    folder: Path, seeds: Sequence[int], participants: int, advance: Callable[[], object]
) -> OutcomesCheck:
    """Make what is missing in the folder, and compare each recording; raises InhandError."""
    folder.mkdir(parents=True, exist_ok=True)
    models = _models(folder)
    compared: list[Compared] = []
    handled: list[Handled] = []
    swept: list[Swept] = []
    count = 0
    for seed in seeds:
        tracked = _tracked(folder, seed, participants, models)
        for interaction in INTERACTIONS:
            for participant in range(participants):
                path = tracked / f"{interaction}_p{participant:02}.mcap"
                simulation = simulate(interaction, participant, seed, FRAMES)
                outcomes, watcher = said_of(path, models[interaction])
                compared += list(_compare(simulation, outcomes))
                handled += list(_places(simulation, outcomes))
                swept += list(_swept(simulation, watcher))
                count += 1
                advance()
    return OutcomesCheck(count, compared, handled, swept)


def steps(seeds: Sequence[int], participants: int) -> int:
    """Number of recordings that ``check_outcomes`` compares."""
    return len(seeds) * participants * len(INTERACTIONS)


def said_of(recording: Path, model: Path) -> tuple[list[Outcome], Watcher]:
    """Watch a tracked recording as the daemon does; all that it says of the model's object, and who
    has watched."""
    things, problems = load_things([model], {})
    if problems:
        raise InhandError(problems[0])
    watcher = Watcher(things, "bench")
    floors = FloorWatch(watcher.floors.see)
    outcomes: list[Outcome] = []
    for one in read_recording(recording, streams=("info", "rgbd", "skeletons", "pose")):
        message = one.message()
        if isinstance(message, CameraInfo):
            watcher.hear_info(one.name, message)
            floors.hear_info(one.name, message)
        elif isinstance(message, RgbdFrame):
            floors.hear_frame(one.name, message)
        elif isinstance(message, Skeletons):
            floors.hear_skeletons(one.name, message)
            outcomes += watcher.hear_skeletons(one.name, message)
        elif isinstance(message, ObjectPose) and message.object.endswith(SUFFIX):
            name = message.object.removesuffix(SUFFIX)
            outcomes += watcher.hear_pose(msgspec.structs.replace(message, object=name))
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


def _models(folder: Path) -> dict[str, Path]:
    """The models by interaction, learned where they are missing."""
    taught = folder / f"people_{TAUGHT_BY}"
    _simulate(taught, TAUGHT_BY, TEACHERS, TAUGHT_FRAMES)
    models = {}
    for interaction, done in INTERACTIONS.items():
        name = done.object_model().name
        models[interaction] = folder / f"{name}.model"
        if not models[interaction].exists():
            _inhand("train", taught, "--object", name, "-o", models[interaction])
    return models


def _tracked(folder: Path, seed: int, participants: int, models: Mapping[str, Path]) -> Path:
    """The folder of the tracked recordings of a seed's people."""
    people, tracked = folder / f"people_{seed}", folder / f"tracked_{seed}"
    _simulate(people, seed, participants, FRAMES)
    for number in range(participants):
        left_handed = sample_person(seed, number, USUAL_PEOPLE).handedness == "left"
        for interaction, model in models.items():
            path = people / "recordings" / f"{interaction}_p{number:02}.mcap"
            if not (tracked / path.name).exists():
                config = _settings(model, left_handed=left_handed)
                _inhand("recording", "retrack", "--config", config, "-o", tracked, path)
    return tracked


def _settings(model: Path, *, left_handed: bool) -> Path:
    """The settings of a tracker for somebody, as they would write them."""
    config = model.with_suffix(".left.toml" if left_handed else ".right.toml")
    hand = str(left_handed).lower()
    config.write_text(f'[tracker.{SUFFIX[1:]}]\nmodel = "{model.name}"\nleft_handed = {hand}\n')
    return config


def _simulate(out: Path, seed: int, participants: int, frames: int) -> None:
    if not (out / "dataset.toml").exists():
        numbers = {"participants": participants, "seed": seed, "frames": frames}
        wanted = (part for name, one in numbers.items() for part in (f"--{name}", str(one)))
        _inhand("simulate", out, *wanted)


def _inhand(*arguments: str | Path) -> None:
    command = [sys.executable, "-m", "inhand", *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise InhandError(f"inhand {arguments[0]}: {done.stderr.strip()}")


def counts_table(check: OutcomesCheck) -> Table:
    """How often each kind was counted right."""
    table = Table(title=f"what was achieved in {check.recordings} recordings, beside the truth")
    for column in ("interaction", "kind"):
        table.add_column(column)
    for column in ("true", "said", "exact", "within one", "seconds off"):
        table.add_column(column, justify="right")
    rows: dict[tuple[str, str], list[Compared]] = defaultdict(list)
    for one in check.compared:
        rows[one.interaction, one.kind].append(one)
    for (interaction, kind), ones in rows.items():
        off = Counter(abs(one.said - one.true) for one in ones)
        table.add_row(
            interaction,
            kind,
            str(sum(one.true for one in ones)),
            str(sum(one.said for one in ones)),
            f"{off[0]}/{len(ones)}",
            f"{off[0] + off[1]}/{len(ones)}",
            f"{np.median(np.abs([one.seconds_off for one in ones])):.2f}",
        )
    return table


def amounts_table(check: OutcomesCheck) -> Table:
    """How far sums of amounts are from the truth."""
    table = Table(title="amounts of a recording together, beside the truth")
    for column in ("interaction", "kind", "amount"):
        table.add_column(column)
    for column in ("true, mean", "median error", "within 25 %"):
        table.add_column(column, justify="right")
    rows: dict[tuple[str, str, str], list[tuple[float, float]]] = defaultdict(list)
    for one in check.compared:
        for name, pair in one.amounts.items():
            rows[one.interaction, one.kind, name].append(pair)
    for key, pairs in rows.items():
        said, true = np.array(pairs).T
        near = np.abs(said - true) <= 0.25 * np.abs(true)
        table.add_row(
            *key,
            f"{true.mean():.3g}",
            f"{np.median(np.abs(said - true)):.3g}",
            f"{near.sum()}/{len(pairs)}",
        )
    return table


def swept_table(check: OutcomesCheck) -> Table:
    """How well maps of the swept floor agree with what truly was."""
    table = Table(title="the floor that was swept, intersection over union")
    for column in ("recordings", "mean", "least"):
        table.add_column(column, justify="right")
    shares = [one.iou for one in check.swept]
    if shares:
        table.add_row(str(len(shares)), f"{np.mean(shares):.2f}", f"{min(shares):.2f}")
    return table


def places_table(check: OutcomesCheck) -> Table:
    """How far from where it lies a thing was said to be put down."""
    table = Table(title="where things were put down")
    table.add_column("interaction")
    for column in ("put down", "said", "within 5 cm", "median, cm"):
        table.add_column(column, justify="right")
    rows: dict[str, list[Handled]] = defaultdict(list)
    for one in check.handled:
        rows[one.interaction].append(one)
    for interaction, ones in rows.items():
        off = [one.place_off_cm for one in ones if one.place_off_cm is not None]
        table.add_row(
            interaction,
            str(len(ones)),
            str(len(off)),
            str(sum(one <= 5.0 for one in off)),
            f"{np.median(off):.1f}" if off else "",
        )
    return table
