"""Datasets of simulated people."""

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from inhand_runtime.pixels import encode_colour, encode_depth
from inhand_schemas.messages import Message, RgbdFrame, Skeletons

from inhand_lab.dataset import CAMERA, Dataset, DatasetWriter, Entry
from inhand_lab.simulated_messages import camera_info, label_message, person_message, shape_of
from inhand_lab.world import VERSION, Simulation, simulate

FRAME_RATE = 30
START_NS = 1_000_000_000_000_000_000


def generate(
    folder: Path,
    interactions: Sequence[str],
    participants: int,
    seed: int,
    frames: int,
    *,
    images: bool,
    on_progress: Callable[[], None],
) -> Dataset:
    """Write a dataset of every participant doing every interaction.

    ``on_progress`` is called once a recording. Raises DatasetError or RecordingError.
    """
    writer = DatasetWriter(folder)
    for interaction in interactions:
        for participant in range(participants):
            simulation = simulate(interaction, participant, seed, frames, FRAME_RATE)
            writer.add_shape(shape_of(simulation.object_model))
            entry = Entry(
                file=f"recordings/{interaction}_p{participant:02}.mcap",
                interaction=interaction,
                object=simulation.object_model.name,
                participant=f"p{participant:02}",
                handedness=simulation.person.handedness,
                frame_rate=FRAME_RATE,
            )
            writer.add_recording(entry, _messages(simulation, images=images))
            on_progress()
    return writer.finish(
        {
            "name": "inhand simulate",
            "version": VERSION,
            "seed": seed,
            "participants": participants,
            "frames": frames,
            "images": images,
        }
    )


def _messages(simulation: Simulation, *, images: bool) -> Iterator[Message]:
    yield camera_info(simulation.intrinsics, simulation.frame_rate, START_NS)
    for frame in range(simulation.frames):
        time_ns = START_NS + round(frame * 1_000_000_000 / FRAME_RATE)
        yield Skeletons(
            sequence=frame, time_ns=time_ns, people=(person_message(simulation, frame),)
        )
        yield label_message(simulation, frame, sequence=frame, time_ns=time_ns, camera=CAMERA)
        if images:
            seen = simulation.render(frame)
            yield RgbdFrame(
                sequence=frame,
                time_ns=time_ns,
                colour=encode_colour(seen.colour),
                depth=encode_depth(seen.depth),
            )
