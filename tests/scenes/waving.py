"""A small dataset of people who wave a box about, written as recordings are."""

from collections.abc import Collection, Iterator
from pathlib import Path

import numpy as np
import trimesh
from inhand_lab.datasets.dataset import CAMERA, Dataset, DatasetEntry
from inhand_lab.datasets.dataset_writer import DatasetWriter
from inhand_runtime.pixels import encode_colour
from inhand_schemas.messages import (
    CameraInfo,
    Message,
    ObjectPose,
    Person,
    Pose,
    RgbdFrame,
    Skeletons,
)
from inhand_tracker.shape.shape import ObjectShape
from scipy.spatial.transform import Rotation

FRAME_NS = 33_333_333
START_NS = 10**18
WIDTH, HEIGHT = 160, 120
ELBOW, WRIST, HAND = 9, 10, 11

STANDING = np.array(
    [
        (0.00, 0.00, 2.50),
        (0.00, -0.20, 2.50),
        (0.00, -0.45, 2.50),
        (0.00, -0.73, 2.50),
        (0.20, -0.42, 2.50),
        (0.25, -0.15, 2.52),
        (0.27, 0.08, 2.42),
        (0.28, 0.16, 2.38),
        (-0.20, -0.42, 2.50),
        (-0.26, -0.16, 2.45),
        (-0.22, -0.12, 2.20),
        (-0.20, -0.13, 2.12),
        (0.10, 0.03, 2.50),
        (0.10, 0.47, 2.50),
        (0.10, 0.91, 2.50),
        (0.11, 0.95, 2.38),
        (-0.10, 0.03, 2.50),
        (-0.10, 0.47, 2.50),
        (-0.10, 0.91, 2.50),
        (-0.11, 0.95, 2.38),
    ]
)


def box() -> ObjectShape:
    """A box of 6 × 10 × 24 cm."""
    mesh = trimesh.creation.box((0.06, 0.10, 0.24))
    vertices = np.array(mesh.vertices)
    return ObjectShape("box", vertices, np.array(mesh.faces), vertices, np.array([1.0, 0.0, 0.0]))


def waving(frames: int, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Joints (T, 20, 3), and the box's (T, 3) and (T, 4), in the right hand."""
    random = np.random.default_rng(seed)
    swing = 0.7 * np.sin((0.2 + 0.02 * seed) * np.arange(frames) + seed)
    turns = Rotation.from_rotvec(np.outer(swing, [1.0, 0.0, 0.0]))
    joints = np.repeat(STANDING[None], frames, axis=0)
    for joint in (WRIST, HAND):
        joints[:, joint] = STANDING[ELBOW] + turns.apply(STANDING[joint] - STANDING[ELBOW])
    places = joints[:, HAND] + turns.apply([0.0, 0.0, -0.1])
    joints = joints + 0.003 * random.normal(size=joints.shape)
    return joints, places, turns.as_quat(scalar_first=True)


def info() -> CameraInfo:
    """A small camera's description."""
    return CameraInfo(
        sequence=0,
        time_ns=START_NS,
        width=WIDTH,
        height=HEIGHT,
        fx=130.0,
        fy=130.0,
        cx=79.5,
        cy=59.5,
    )


def messages(
    frames: int,
    seed: int,
    *,
    images: bool = False,
    camera: str = CAMERA,
    missing: Collection[int] = (),
) -> Iterator[Message]:
    """A recording's messages; the joints that are missing are so throughout."""
    yield info()
    random = np.random.default_rng(seed)
    joints, places, turns = waving(frames, seed)
    for frame in range(frames):
        times = {"sequence": frame, "time_ns": START_NS + frame * FRAME_NS}
        yield Skeletons(**times, people=(person(joints[frame], missing),))
        yield ObjectPose(
            **times,
            object="box",
            camera=camera,
            state="tracked",
            confidence=1.0,
            camera_from_object=Pose(tuple(places[frame].tolist()), tuple(turns[frame].tolist())),
        )
        if images:
            colour = random.integers(0, 255, (HEIGHT, WIDTH, 3)).astype(np.uint8)
            yield RgbdFrame(**times, colour=encode_colour(colour))


def person(joints: np.ndarray, missing: Collection[int] = ()) -> Person:
    """Somebody whose joints are all tracked, but for those that are missing."""
    shown = [0.0 if index in missing else 1.0 for index in range(20)]
    return Person(
        id=1,
        joints=tuple(tuple(joint) for joint in (joints * np.array(shown)[:, None]).tolist()),
        states=tuple("tracked" if share else "missing" for share in shown),
        confidences=(1.0,) * 20,
    )


def entry_of(participant: str, interaction: str = "wave") -> DatasetEntry:
    """A participant's only recording."""
    return DatasetEntry(
        file=f"recordings/{participant}.mcap",
        interaction=interaction,
        participant=participant,
        object="box",
    )


def write_dataset(
    folder: Path,
    participants: int = 3,
    *,
    frames: int = 30,
    images: bool = False,
    first: int = 0,
    missing: Collection[int] = (),
) -> Dataset:
    """One recording a participant."""
    writer = DatasetWriter(folder)
    writer.add_shape(box())
    for seed in range(first, first + participants):
        recorded = messages(frames, seed, images=images, missing=missing)
        writer.add_recording(entry_of(f"p{seed}"), recorded)
    return writer.finish({"name": "waving"})
