"""Prepares a demonstration: a learned model, and the settings of its rig."""

import socket
from collections.abc import Callable
from pathlib import Path

from inhand_tracker.model.model import Model
from inhand_tracker.model.model_file import save_model

from inhand_lab.datasets.generation import GenerationSettings, generate
from inhand_lab.demonstration.parameters import DEFAULT_DEMONSTRATION
from inhand_lab.training.model_training import train


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


def write_rig_file(folder: Path, interaction: str, model: Path, skeletons: str = "source") -> Path:
    """Write the settings of a rig with a simulated camera, on a free port of this machine; its
    ``skeletons`` are the source's, or estimated from its pictures."""
    path = folder / "rig.toml"
    lines = [
        'rig = "demo"',
        "[zenoh]",
        f'meeting = "tcp/127.0.0.1:{_free_port()}"',
        "[log]",
        'level = "warning"',
        "[capture.camera]",
        'source = "simulator"',
        f'skeletons = "{skeletons}"',
        "wait_for_reader_s = 30",
        "[capture.camera.options]",
        f'interaction = "{interaction}"',
        f"participant = {DEFAULT_DEMONSTRATION.unseen_participant}",
        f"seed = {DEFAULT_DEMONSTRATION.seed}",
        "[tracker.follower]",
        'camera = "camera"',
        f'model = "{model}"',
        "[recorder.disk]",
        f'folder = "{folder / "recordings"}"',
    ]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])
