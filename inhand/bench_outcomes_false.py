"""What outcomes say where nothing happens, for ``inhand bench outcomes --idle-minutes``.

A rig that knows all objects watches simulated people who use nothing, where nothing is in sight and
where one of the objects lies at hand; and, with one object left out of what it was taught, people
who use that.
"""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from inhand_lab.datasets.dataset import load_dataset
from inhand_lab.training.presence_training import NEEDS, look_around, presence_of
from inhand_lab.training.recogniser_training import train_recogniser
from inhand_lab.workers import in_processes, usable_cores
from inhand_lab.world.idle_people import (
    IDLENESS,
    Idleness,
    simulate_idle,
    simulate_idle_beside,
)
from inhand_lab.world.interactions import INTERACTIONS
from inhand_lab.world.messages import camera_info, person_message, pixels_message
from inhand_lab.world.simulation import Simulation
from inhand_schemas.conventions import SIMULATED
from inhand_schemas.messages import Skeletons
from inhand_tracker.loading import load_watcher
from inhand_tracker.model.model_file import load_model
from inhand_tracker.people.watching import CameraFrame
from inhand_tracker.recognition.recogniser_file import save_recogniser
from inhand_tracker.settings import TrackerSettings
from inhand_tracker.wire.conversion import image_of, joints_of
from inhand_tracker.wire.poses import SourceFrame, object_pose_message
from rich.table import Table

from inhand.bench_outcomes import Told, said_by, said_of
from inhand.bench_outcomes_people import (
    FRAMES,
    TAUGHT_BY,
    Taught,
    is_left_handed,
    recorded_people,
    teach,
    track,
)
from inhand.progress import progress_bar

NOTHING_THERE, AT_HAND, NEVER_TAUGHT = "nothing in sight", "an object at hand", "never taught"
SPELL_S = 60.0
"""Seconds for which one person is idle in one way."""
IDLE_HZ = 10.0
"""Frames a second: a third of a camera's, so that three times as much is seen in the same time."""
STANDING = tuple(one for one in IDLENESS if one != "walkAbout")
"""The ways of being idle before furniture: who walks about would walk through it."""
RECORDED_HZ = 30.0
"""Frames a second of recordings of simulated people."""
CAMERA = "bench"


@dataclass(frozen=True)
class FalseOutcomes:
    """How often each kind was said of each object in so many hours of one situation; what is said
    ``handled`` of an object that was there and was not touched counts as well."""

    situation: str
    hours: float
    said: Mapping[str, int]


@dataclass(frozen=True)
class _Spell:
    """One person who is idle; ``beside`` names the interaction whose object lies at hand."""

    number: int
    seed: int
    beside: str | None
    taught: Taught


def check_false(
    folder: Path, minutes: float, seeds: Sequence[int], participants: int
) -> list[FalseOutcomes]:
    """Watch people who use nothing for so many minutes, half of them beside an object, and those of
    the first seed use each object with a rig that was taught all others.

    Raises InhandError, DatasetError or RecordingError.
    """
    taught = teach(folder)
    count = 2 * max(round(30.0 * minutes / SPELL_S), 1)
    interactions = tuple(INTERACTIONS)
    spells = [
        _Spell(
            number, seeds[0], interactions[number % len(interactions)] if beside else None, taught
        )
        for number in range(count // 2)
        for beside in (False, True)
    ]
    with progress_bar("people who use nothing", count) as advance:
        told = in_processes(_idle, spells, usable_cores(), lambda _: advance())
    seconds = SPELL_S * count / 2
    return [
        _summed(NOTHING_THERE, seconds, told[::2]),
        _summed(AT_HAND, seconds, told[1::2]),
        _check_never_taught(folder, seeds[0], participants, taught),
    ]


def _summed(situation: str, seconds: float, told: Sequence[Mapping[str, int]]) -> FalseOutcomes:
    said: Counter[str] = Counter()
    for one in told:
        said.update(one)
    return FalseOutcomes(situation, seconds / 3600.0, dict(said))


def _idle(spell: _Spell) -> Counter[str]:
    frames = round(SPELL_S * IDLE_HZ)
    if spell.beside is None:
        kind = IDLENESS[spell.number % len(IDLENESS)]
        person = simulate_idle(kind, spell.number, spell.seed, frames, IDLE_HZ)
    else:
        kind = kind_beside(spell.number)
        person = simulate_idle_beside(spell.beside, kind, spell.number, spell.seed, frames, IDLE_HZ)
    said, _ = said_by(_seen(person, spell.taught), spell.taught.files)
    return Counter(f"{one.object} {one.kind}" for one in said)


def kind_beside(number: int) -> Idleness:
    """How somebody is idle beside the object of interaction ``number``, counted round and round:
    beside each object in each way in turn."""
    turn, interaction = divmod(number, len(INTERACTIONS))
    return STANDING[(interaction + turn) % len(STANDING)]


def _seen(person: Simulation, taught: Taught) -> Iterator[Told]:
    """What a camera and a tracker tell of somebody."""
    settings = TrackerSettings(
        camera=CAMERA,
        models=tuple(taught.files),
        recogniser=taught.recogniser,
        left_handed=person.person.handedness == "left",
    )
    tracker = load_watcher(CAMERA, settings)
    info = camera_info(person.intrinsics, person.frame_rate)
    yield CAMERA, info
    for frame in range(person.frames):
        time_ns = round(frame * 1e9 / person.frame_rate)
        message = person_message(person, frame)
        pixels = pixels_message(person.render(frame), sequence=frame, time_ns=time_ns)
        yield CAMERA, pixels
        yield CAMERA, Skeletons(sequence=frame, time_ns=time_ns, people=(message,))
        shown = CameraFrame(time_ns, image_of(pixels, info, NEEDS), convention=SIMULATED)
        for one in tracker.see(joints_of(message), shown, _fail):
            source = SourceFrame(frame, time_ns, CAMERA)
            yield (
                one.name,
                object_pose_message(
                    one.estimate,
                    source,
                    name=one.name,
                    person=message.id,
                    class_probabilities=one.class_probabilities,
                ),
            )


def _fail(name: str, error: Exception) -> None:
    raise error


def _check_never_taught(
    folder: Path, seed: int, participants: int, taught: Taught
) -> FalseOutcomes:
    recordings = recorded_people(folder, seed, participants)
    told = []
    with progress_bar("what nobody taught", participants * len(INTERACTIONS)) as advance:
        for interaction, rig in _without_each(folder, taught).items():
            tracked = folder / f"without_{interaction}_{seed}"
            for number in range(participants):
                name = f"{interaction}_p{number:02}.mcap"
                paths = [path for path in recordings if path.name == name]
                track(rig, paths, tracked, left_handed=is_left_handed(seed, number))
                said, _ = said_of(tracked / name, rig.files)
                told.append(Counter(f"{one.object} {one.kind}" for one in said))
                advance()
    return _summed(NEVER_TAUGHT, len(told) * FRAMES / RECORDED_HZ, told)


def _without_each(folder: Path, taught: Taught) -> dict[str, Taught]:
    """What a rig has learned that was taught all objects but one, by that one's interaction.

    A recogniser is learned where it is missing, from the same people without that interaction.
    """
    dataset = load_dataset(folder / f"people_{TAUGHT_BY}")
    rigs = {
        left_out: Taught(
            {one: model for one, model in taught.models.items() if one != left_out},
            folder / f"without_{left_out}.recogniser",
        )
        for left_out in taught.models
    }
    missing = [left_out for left_out, rig in rigs.items() if not rig.recogniser.exists()]
    if missing:
        actions = list(taught.models)
        models = [load_model(model) for model in taught.files]
        samples = look_around(dataset, dataset.entries, actions, models)
    for left_out in missing:
        entries = [entry for entry in dataset.entries if entry.interaction != left_out]
        recogniser = train_recogniser(dataset, entries)
        seen = [sample for sample in samples if sample.action != left_out]
        presence = presence_of(seen, recogniser.actions)
        save_recogniser(replace(recogniser, presence=presence), rigs[left_out].recogniser)
    return rigs


def false_table(found: Sequence[FalseOutcomes]) -> Table:
    """How much was said in each situation."""
    table = Table(title="said where nothing happened, or with what nobody taught")
    for column in ("situation", "hours", "events", "of which"):
        table.add_column(column, justify="right" if column in ("hours", "events") else "left")
    for one in found:
        kinds = ", ".join(f"{name} {times}" for name, times in Counter(one.said).most_common())
        table.add_row(one.situation, f"{one.hours:.2f}", str(sum(one.said.values())), kinds)
    return table
