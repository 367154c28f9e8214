"""Prepares a demonstration: a learned model, and the settings of its rig."""

import socket
import time
from collections.abc import Callable
from pathlib import Path

from inhand_tracker.model.model import Model
from inhand_tracker.model.model_file import save_model

from inhand_lab.datasets.generation import GenerationSettings, generate
from inhand_lab.demonstration.parameters import DEFAULT_DEMONSTRATION
from inhand_lab.training.model_training import train
from inhand_lab.world.parameters import RIG_CAMERAS
from inhand_lab.world.roaming import ROAMING_INTERACTIONS


def train_demonstration(
    folder: Path, interaction: str, on_progress: Callable[[], None]
) -> tuple[Model, Path]:
    """Simulate participants, learn from them, and save the model."""
    dataset = generate(
        folder / "dataset",
        GenerationSettings(
            [interaction],
            DEFAULT_DEMONSTRATION.trained_participants,
            DEFAULT_DEMONSTRATION.seed,
            DEFAULT_DEMONSTRATION.trained_frames,
            images=False,
        ),
        on_progress,
    )
    model = train(dataset, dataset.entries)
    path = folder / f"{interaction}.model"
    save_model(model, path)
    return model, path


def write_rig_file(
    folder: Path, interaction: str, model: Path, skeletons: str = "source", cameras: int = 1
) -> Path:
    """Write the settings of a rig with simulated cameras, on a free port of this machine; their
    ``skeletons`` are the source's, or estimated from their pictures."""
    path = folder / "rig.toml"
    meeting = f'[zenoh]\nmeeting = "tcp/127.0.0.1:{free_port()}"'
    tables = rig_tables(folder, interaction, model, skeletons)
    if cameras > 1:
        tables |= tables_of_several(interaction, model, skeletons, cameras)
    lines = ['rig = "demo"', meeting, '[log]\nlevel = "warning"', *tables.values()]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def rig_tables(
    folder: Path, interaction: str, model: Path, skeletons: str = "source"
) -> dict[str, str]:
    """Return the tables of the settings by service: a simulated camera, which waits for a reader, a
    tracker of its person, and a recorder into the folder."""
    return {
        "capture": (
            f'[capture.camera]\nsource = "simulator"\nskeletons = "{skeletons}"\n'
            "wait_for_reader_s = 30\n[capture.camera.options]\n"
            f'interaction = "{interaction}"\n'
            f"participant = {DEFAULT_DEMONSTRATION.unseen_participant}\n"
            f"seed = {DEFAULT_DEMONSTRATION.seed}"
        ),
        "tracker": f'[tracker.follower]\ncamera = "camera"\nmodel = "{model}"',
        "recorder": f'[recorder.disk]\nfolder = "{folder / "recordings"}"',
    }


def tables_of_several(
    interaction: str, model: Path, skeletons: str, cameras: int
) -> dict[str, str]:
    """Return the tables of several simulated cameras that show the same, from now on, and of a
    tracker that sees by all of them; people walk about where the interaction lets them."""
    names = [named.name for named in RIG_CAMERAS[:cameras]]
    start, roaming = int(time.time()), interaction in ROAMING_INTERACTIONS
    captures = [
        f'[capture.{name}]\nsource = "simulator"\nskeletons = "{skeletons}"\n'
        f"wait_for_reader_s = 30\n[capture.{name}.options]\n"
        f'interaction = "{interaction}"\n'
        f"participant = {DEFAULT_DEMONSTRATION.unseen_participant}\n"
        f"seed = {DEFAULT_DEMONSTRATION.seed}\n"
        f"cameras = {cameras}\nview = {view}\nstart = {start}\nroaming = {str(roaming).lower()}"
        for view, name in enumerate(names)
    ]
    listed = ", ".join(f'"{name}"' for name in names)
    return {
        "capture": "\n".join(captures),
        "tracker": f'[tracker.follower]\ncameras = [{listed}]\nmodel = "{model}"',
    }


def free_port() -> int:
    """Return a port of this machine that nobody listens on."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])
