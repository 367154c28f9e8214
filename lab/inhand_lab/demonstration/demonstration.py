"""The demonstration: a model of simulated people, and a rig that meets somebody new."""

import socket
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
from inhand_runtime.errors import InhandError
from inhand_runtime.pixels import decode_colour
from inhand_runtime.recording import read_recording
from inhand_schemas.messages import RgbdFrame, Skeletons
from inhand_schemas.topics import RGBD, SKELETONS
from inhand_tracker.model.model import Model
from inhand_tracker.model.model_file import save_model
from inhand_tracker.people.following import Follower
from inhand_tracker.wire.conversion import joints_of

from inhand_lab.datasets.generation import generate
from inhand_lab.datasets.recorded_frames import load_camera
from inhand_lab.demonstration.review import Review
from inhand_lab.report.picture import TRACKED, TRUE, picture_of
from inhand_lab.training.model_training import train

SEED = 7
TRAINED_PARTICIPANTS = 12
UNSEEN_PARTICIPANT = 100
TRAINED_FRAMES = 360


def train_demonstration(
    folder: Path, interaction: str, on_progress: Callable[[], None]
) -> tuple[Model, Path]:
    """Simulate participants, learn from them, and save the model."""
    dataset = generate(
        folder / "dataset",
        [interaction],
        TRAINED_PARTICIPANTS,
        SEED,
        TRAINED_FRAMES,
        images=False,
        on_progress=on_progress,
    )
    model = train(dataset, dataset.entries)
    path = folder / f"{interaction}.model"
    save_model(model, path)
    return model, path


def write_rig_file(folder: Path, interaction: str, model: Path) -> Path:
    """Settings of a rig with a simulated camera, on a free port of this machine."""
    path = folder / "rig.toml"
    lines = [
        'rig = "demo"',
        "[zenoh]",
        f'meeting = "tcp/127.0.0.1:{_free_port()}"',
        "[log]",
        'level = "warning"',
        "[capture.camera]",
        'source = "simulator"',
        "wait_for_reader_s = 30",
        "[capture.camera.options]",
        f'interaction = "{interaction}"',
        f"participant = {UNSEEN_PARTICIPANT}",
        f"seed = {SEED}",
        "[tracker.follower]",
        'camera = "camera"',
        f'model = "{model}"',
        "[recorder.disk]",
        f'folder = "{folder / "recordings"}"',
    ]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def draw_picture(recording: Path, seen: Review, model: Model, path: Path) -> None:
    """Draw the frame of the median error: the skeleton, the true and the tracked object."""
    order = np.argsort(seen.vertex_errors_m)
    by_typicality = order[np.argsort(np.abs(np.arange(len(order)) - len(order) // 2))]
    errors = dict(
        zip(
            seen.sequences[by_typicality].tolist(),
            seen.vertex_errors_m[by_typicality].tolist(),
            strict=True,
        )
    )
    frame, skeletons = _find_frame(recording, list(errors)[:30])
    camera = load_camera(recording)
    if camera is None or frame.colour is None:
        raise InhandError(f"{recording} holds no picture to draw on")
    picture = picture_of(decode_colour(frame.colour), camera)
    person = Follower().choose(skeletons.people, skeletons.time_ns)
    if person is not None:
        picture.draw_skeleton(joints_of(person))
    for text, messages, colour in (
        ("true", seen.labels, TRUE),
        ("tracked", seen.poses, TRACKED),
    ):
        pose = messages[frame.sequence].camera_from_object
        if pose is not None:
            picture.draw_object(model.shape, pose, colour)
        picture.write(f"{text} {model.shape.name}", 1 if colour == TRUE else 2, colour)
    picture.write(f"vertex error {100 * errors[frame.sequence]:.1f} cm", 0, (255, 255, 255))
    if not cv2.imwrite(str(path), cv2.cvtColor(picture.pixels, cv2.COLOR_RGB2BGR)):
        raise InhandError(f"cannot write {path}")


def _find_frame(recording: Path, wanted: list[int]) -> tuple[RgbdFrame, Skeletons]:
    """The first wanted frame, in the order of wishes, that has picture and skeletons."""
    frames: dict[int, RgbdFrame] = {}
    skeletons: dict[int, Skeletons] = {}
    for sample in read_recording(recording, streams=(RGBD.stream, SKELETONS.stream)):
        if sample.sequence in wanted:
            message = sample.message()
            if isinstance(message, RgbdFrame):
                frames[message.sequence] = message
            elif isinstance(message, Skeletons):
                skeletons[message.sequence] = message
    for sequence in wanted:
        if sequence in frames and sequence in skeletons:
            return frames[sequence], skeletons[sequence]
    raise InhandError(f"{recording} holds no frame with both a picture and a pose")


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])
