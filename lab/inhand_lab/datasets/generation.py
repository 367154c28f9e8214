"""Datasets of simulated people."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from inhand_runtime.recording.part_file import PART_SUFFIX
from inhand_schemas.conventions import SIMULATED
from inhand_schemas.messages import Message, Person, Skeletons
from inhand_tracker.shape.shape import ObjectShape
from msgspec.structs import replace as replace_fields

from inhand_lab.cluster import current_cluster
from inhand_lab.datasets.dataset import CAMERA, START_NS, Dataset, DatasetEntry, DatasetError
from inhand_lab.datasets.dataset_writer import DatasetWriter, write_messages, write_received
from inhand_lab.people.person import USUAL_PEOPLE, People
from inhand_lab.sensing.cameras import KINECT, Camera
from inhand_lab.workers import in_processes
from inhand_lab.world.handover import HandoverSimulation
from inhand_lab.world.messages import (
    camera_info,
    label_message,
    person_message,
    pixels_message,
    shape_of,
)
from inhand_lab.world.parameters import USUAL_VIEWS
from inhand_lab.world.random_streams import GENERATOR_VERSION
from inhand_lab.world.rigs import RigSimulation, simulate_rig_cast
from inhand_lab.world.simulation import Casting, Simulation, simulate_cast

GENERATED_RATE = 30
"""Frames a second of generated datasets."""


@dataclass(frozen=True)
class GenerationSettings:
    """Settings of a dataset in which every participant does every interaction.

    ``images`` leaves nothing out but pictures if it is false. ``views`` names
    one of CAMERA_PLACINGS, and ``people`` who lives there; who is ``roaming`` walks about. With
    several ``cameras`` each recording holds what all of a rig saw, but the frames that they lost.
    """

    interactions: Sequence[str]
    participants: int
    seed: int
    frames: int
    images: bool = True
    camera: Camera = KINECT
    views: str = USUAL_VIEWS
    people: People = USUAL_PEOPLE
    cameras: int = 1
    roaming: bool = False


@dataclass(frozen=True)
class Take:
    """A simulation to be written: the recording's name, the participant's, and that of the
    convention of the skeletons."""

    name: str
    participant: str
    simulation: Simulation
    convention: str | None = SIMULATED


def generate(
    folder: Path, settings: GenerationSettings, on_progress: Callable[[], None]
) -> Dataset:
    """Write a dataset of simulated people.

    ``on_progress`` is called once a recording. Raises DatasetError or RecordingError.
    """
    writer = DatasetWriter(folder)
    plans = [
        _Plan(writer.folder, settings, interaction, participant)
        for interaction in settings.interactions
        for participant in range(settings.participants)
    ]
    if current_cluster() is not None:
        _require_new(plans)
        plans = [replace(plan, anew=True) for plan in plans]
    # In this process, as people of one kind share what is costly of them, but on a cluster.
    for entry, shape in in_processes(_enact, plans, 1, lambda _: on_progress()):
        writer.add_shape(shape)
        writer.add_entry(entry)
    return _finished(
        writer,
        {
            "seed": settings.seed,
            "participants": settings.participants,
            "frames": settings.frames,
            "camera": settings.camera.name,
            "images": settings.images,
            "views": settings.views,
            "people": settings.people,
            **_of_rigs(settings),
        },
    )


def _of_rigs(settings: GenerationSettings) -> dict[str, int | bool]:
    """What is said of a dataset only where it has several cameras, or people who walk about."""
    said: dict[str, int | bool] = {}
    if settings.cameras > 1:
        said["cameras"] = settings.cameras
    if settings.roaming:
        said["roaming"] = settings.roaming
    return said


@dataclass(frozen=True)
class _Plan:
    """One recording of a dataset that is to be simulated."""

    folder: Path
    settings: GenerationSettings
    interaction: str
    participant: int
    anew: bool = False
    """Whether what another worker has left of it, before it was killed, is written anew."""

    @property
    def name(self) -> str:
        """The recording's name."""
        return f"{self.interaction}_p{self.participant:02}"

    def files(self) -> tuple[Path, Path]:
        """The recording's file, and what it grows as."""
        path = self.folder / f"recordings/{self.name}.mcap"
        return path, path.with_name(path.name + PART_SUFFIX)


def _require_new(plans: Iterable[_Plan]) -> None:
    """Raise DatasetError where there is a recording already that is to be written."""
    for path in (path for plan in plans for path in plan.files()):
        if path.exists():
            raise DatasetError(f"{path} is there already: choose another folder, or move it away")


def _enact(plan: _Plan) -> tuple[DatasetEntry, ObjectShape]:
    """Simulate one recording and write it, with what is in the hands."""
    settings = plan.settings
    casting = Casting(
        plan.interaction,
        plan.participant,
        settings.seed,
        views=settings.views,
        people=settings.people,
        roaming=settings.roaming,
    )
    camera = replace(settings.camera, frame_rate=GENERATED_RATE)
    if plan.anew:
        for path in plan.files():
            path.unlink(missing_ok=True)
    participant = f"p{plan.participant:02}"
    if settings.cameras > 1:
        rig = simulate_rig_cast(casting, settings.frames, camera, settings.cameras)
        first = rig.cameras[0]
        entry = replace_fields(_entry(plan.name, participant, first), cameras=rig.names)
        write_received(plan.folder / entry.file, rig_messages(rig, images=settings.images))
        return entry, shape_of(first.object_model)
    simulation = simulate_cast(casting, settings.frames, camera)
    take = Take(plan.name, participant, simulation)
    entry = _write_take(plan.folder, take, images=settings.images)
    return entry, shape_of(simulation.object_model)


def write_takes(
    folder: Path,
    takes: Iterable[Take],
    settings: Mapping[str, str | int | float | bool],
    *,
    images: bool,
    on_progress: Callable[[], None],
) -> Dataset:
    """Write simulations as a dataset; ``settings`` say what they were made from.

    ``on_progress`` is called once a recording. Raises DatasetError or RecordingError.
    """
    writer = DatasetWriter(folder)
    for take in takes:
        writer.add_shape(shape_of(take.simulation.object_model))
        writer.add_entry(_write_take(folder, take, images=images))
        on_progress()
    return _finished(writer, settings)


def _write_take(folder: Path, take: Take, *, images: bool) -> DatasetEntry:
    entry = _entry(take.name, take.participant, take.simulation)
    write_messages(folder / entry.file, _messages(take, images=images))
    return entry


def _entry(name: str, participant: str, simulation: Simulation) -> DatasetEntry:
    return DatasetEntry(
        file=f"recordings/{name}.mcap",
        interaction=simulation.interaction,
        object=simulation.object_model.name,
        participant=participant,
        handedness=simulation.person.handedness,
        frame_rate=simulation.frame_rate,
    )


def _finished(writer: DatasetWriter, settings: Mapping[str, str | int | float | bool]) -> Dataset:
    return writer.finish({"name": "inhand simulate", "version": GENERATOR_VERSION, **settings})


def _messages(take: Take, *, images: bool) -> Iterator[Message]:
    simulation = take.simulation
    yield camera_info(simulation.intrinsics, simulation.frame_rate, START_NS)
    for frame in range(simulation.frames):
        time_ns = START_NS + round(frame * 1_000_000_000 / simulation.frame_rate)
        stamp = _Stamp(frame, time_ns, CAMERA, take.convention)
        yield from _frame_messages(simulation, stamp, images=images)


@dataclass(frozen=True)
class _Stamp:
    """Which frame of which camera is written, and whose joints its skeletons have.

    ``people`` are whom it shows, None for the simulation's person alone, and ``holder`` is the
    number of who has the object.
    """

    frame: int
    time_ns: int
    camera: str
    convention: str | None = SIMULATED
    people: tuple[Person, ...] | None = None
    holder: int | None = 0


def _frame_messages(simulation: Simulation, stamp: _Stamp, *, images: bool) -> Iterator[Message]:
    frame, time_ns = stamp.frame, stamp.time_ns
    yield Skeletons(
        sequence=frame,
        time_ns=time_ns,
        people=((person_message(simulation, frame),) if stamp.people is None else stamp.people),
        convention=stamp.convention,
    )
    seen = simulation.render(frame) if images else None
    label = label_message(
        simulation,
        frame,
        sequence=frame,
        time_ns=time_ns,
        camera=stamp.camera,
        visible_fraction=seen.visible_fraction if seen else simulation.visible_fraction(frame),
    )
    yield replace_fields(label, person=stamp.holder)
    if seen is not None:
        yield pixels_message(seen, sequence=frame, time_ns=time_ns)


def handover_messages(
    handover: HandoverSimulation, *, images: bool
) -> Iterator[tuple[str, int, Message]]:
    """Yield what all cameras send of two people who hand over a mug, as ``rig_messages`` does.

    A label's person is who has the mug, by that camera's number; None where it does not see them.
    """
    return rig_messages(handover.rig, images=images, handover=handover)


def rig_messages(
    rig: RigSimulation, *, images: bool, handover: HandoverSimulation | None = None
) -> Iterator[tuple[str, int, Message]]:
    """Yield what all cameras of a rig send, each with its camera and its time of reception.

    Frames have the times of their cameras' clocks, and are received when they truly are taken, by
    the rig's time, nanoseconds; those that a camera loses are left out.
    """
    for view in rig.views:
        seen = view.simulation
        info = camera_info(seen.intrinsics, seen.frame_rate, START_NS, view.rig_from_camera)
        yield view.name, START_NS, info
    taken = sorted(
        (START_NS + round(1e9 * time), number, frame)
        for number, view in enumerate(rig.views)
        for frame, time in enumerate(view.times_s())
        if not view.dropped[frame]
    )
    stamps = [START_NS + view.stamps_ns() for view in rig.views]
    for received_ns, number, frame in taken:
        view = rig.views[number]
        stamp = _Stamp(frame, int(stamps[number][frame]), view.name)
        if handover is not None:
            people, holder = handover.people(number, frame), handover.holder(number, frame)
            stamp = replace(stamp, people=people, holder=holder)
        for message in _frame_messages(view.simulation, stamp, images=images):
            yield view.name, received_ns, message
