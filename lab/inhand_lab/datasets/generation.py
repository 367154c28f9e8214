"""Datasets of simulated people."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from inhand_schemas.conventions import SIMULATED
from inhand_schemas.messages import Message, Skeletons

from inhand_lab.datasets.dataset import CAMERA, START_NS, Dataset, DatasetEntry
from inhand_lab.datasets.dataset_writer import DatasetWriter
from inhand_lab.people.person import USUAL_PEOPLE, People
from inhand_lab.sensing.cameras import KINECT, Camera
from inhand_lab.world.messages import (
    camera_info,
    label_message,
    person_message,
    pixels_message,
    shape_of,
)
from inhand_lab.world.parameters import USUAL_VIEWS
from inhand_lab.world.random_streams import GENERATOR_VERSION
from inhand_lab.world.simulation import Casting, Simulation, simulate_cast

GENERATED_RATE = 30
"""Frames a second of generated datasets."""


@dataclass(frozen=True)
class GenerationSettings:
    """Settings of a dataset in which every participant does every interaction.

    ``images`` leaves nothing out but pictures if it is false. ``views`` names
    one of CAMERA_PLACINGS, and ``people`` who lives there.
    """

    interactions: Sequence[str]
    participants: int
    seed: int
    frames: int
    images: bool = True
    camera: Camera = KINECT
    views: str = USUAL_VIEWS
    people: People = USUAL_PEOPLE


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
    camera = replace(settings.camera, frame_rate=GENERATED_RATE)
    takes = (
        Take(
            f"{interaction}_p{participant:02}",
            f"p{participant:02}",
            simulate_cast(
                Casting(
                    interaction,
                    participant,
                    settings.seed,
                    views=settings.views,
                    people=settings.people,
                ),
                settings.frames,
                camera,
            ),
        )
        for interaction in settings.interactions
        for participant in range(settings.participants)
    )
    return write_takes(
        folder,
        takes,
        {
            "seed": settings.seed,
            "participants": settings.participants,
            "frames": settings.frames,
            "camera": settings.camera.name,
            "images": settings.images,
            "views": settings.views,
            "people": settings.people,
        },
        images=settings.images,
        on_progress=on_progress,
    )


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
        simulation = take.simulation
        writer.add_shape(shape_of(simulation.object_model))
        entry = DatasetEntry(
            file=f"recordings/{take.name}.mcap",
            interaction=simulation.interaction,
            object=simulation.object_model.name,
            participant=take.participant,
            handedness=simulation.person.handedness,
            frame_rate=simulation.frame_rate,
        )
        writer.add_recording(entry, _messages(take, images=images))
        on_progress()
    return writer.finish({"name": "inhand simulate", "version": GENERATOR_VERSION, **settings})


def _messages(take: Take, *, images: bool) -> Iterator[Message]:
    simulation = take.simulation
    yield camera_info(simulation.intrinsics, simulation.frame_rate, START_NS)
    for frame in range(simulation.frames):
        time_ns = START_NS + round(frame * 1_000_000_000 / simulation.frame_rate)
        yield Skeletons(
            sequence=frame,
            time_ns=time_ns,
            people=(person_message(simulation, frame),),
            convention=take.convention,
        )
        seen = simulation.render(frame) if images else None
        yield label_message(
            simulation,
            frame,
            sequence=frame,
            time_ns=time_ns,
            camera=CAMERA,
            visible_fraction=seen.visible_fraction if seen else simulation.visible_fraction(frame),
        )
        if seen is not None:
            yield pixels_message(seen, sequence=frame, time_ns=time_ns)
