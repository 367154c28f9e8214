"""Small inputs of every import: a person who stands, and files as each data set names them."""

from pathlib import Path
from typing import Any

import cv2
import msgspec
import numpy as np
import scipy.io
from inhand_lab.datasets.dataset import Dataset, DatasetEntry
from inhand_lab.importers.utd_mhad import JOINT_ORDER
from inhand_runtime.recording import read_recording
from inhand_schemas.joints import JOINT_NAMES, Joint
from scipy.spatial.transform import Rotation

# A person who stands and faces +z, with the left at +x and up at +y.
STANDING = {
    "HipCenter": (0.0, 1.0, 0.0),
    "Spine": (0.0, 1.15, 0.0),
    "ShoulderCenter": (0.0, 1.45, 0.0),
    "Head": (0.0, 1.65, 0.05),
    "Shoulder": (0.2, 1.4, 0.0),
    "Elbow": (0.25, 1.15, 0.02),
    "Wrist": (0.27, 0.95, 0.2),
    "Hand": (0.33, 0.9, 0.25),
    "Hip": (0.1, 0.98, 0.0),
    "Knee": (0.1, 0.5, 0.0),
    "Ankle": (0.1, 0.08, 0.0),
    "Foot": (0.12, 0.02, 0.12),
}
CUBE = 0.2 * np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)


def standing() -> np.ndarray:
    """The joints (20, 3), in the order of JOINT_NAMES."""
    return np.array([_standing_joint(name) for name in JOINT_NAMES])


def _standing_joint(name: str) -> tuple[float, float, float]:
    x, y, z = STANDING[name.removesuffix("Left").removesuffix("Right")]
    return (-x if name.endswith("Right") else x, y, z)


def walking(frames: int, turn: Rotation) -> np.ndarray:
    """Joints (T, 20, 3) of the person walking ahead, in a world frame turned by ``turn``."""
    steps = np.arange(frames)[:, None, None] * np.array([0.0, 0.0, 0.01])
    turned = turn.apply((standing() + steps).reshape(-1, 3)).reshape(frames, 20, 3)
    return turned + np.array([5.0, -2.0, 7.0])


def archive_values(frames: int = 48) -> dict[str, Any]:
    """A motion archive: the person carries a cube, in a world frame of no particular direction."""
    turn = Rotation.from_euler("xyz", (0.4, -1.1, 2.0))
    joints = walking(frames, turn)
    spin = Rotation.from_rotvec(np.linspace((0, 0, 0), (0, 1, 0), frames)) * turn
    return {
        "joints": joints,
        "joint_names": np.array(JOINT_NAMES),
        "object_pose": np.hstack(
            (joints[:, Joint.HAND_RIGHT], spin.as_quat(canonical=True, scalar_first=True))
        ),
        "vertices": CUBE,
        "fps": np.array(240.0),
        "interaction": np.array("carryCube"),
        "object": np.array("largeCube"),
        "participant": np.array("somebody"),
        "handedness": np.array("left"),
    }


def save_archive(path: Path, **changes: Any) -> Path:
    values = archive_values() | changes
    np.savez(path, **{name: value for name, value in values.items() if value is not None})
    return path


def skeleton_file(joints_in_kinect: np.ndarray) -> np.ndarray:
    """d_skel (20, 3, T) from joints (T, 20, 3) in the order of JOINT_NAMES."""
    order = [JOINT_NAMES.index(name) for name in JOINT_ORDER]
    return np.moveaxis(joints_in_kinect[:, order], 0, -1)


def save_trial(
    folder: Path, frames: int, depth_frames: int | None, stem: str = "a15_s3_t2"
) -> Path:
    """A person 2.5 m before a Kinect; each joint's depth is in the pixel that README computes."""
    joints = np.repeat(standing()[None], frames, axis=0)
    # Kinect's x is to the sensor's left, which is a facing person's right.
    joints = (joints - [0.0, 1.0, 0.0]) * [-1.0, 1.0, -1.0] + [0.3, 0.0, 2.5]
    path = folder / f"{stem}_skeleton.mat"
    scipy.io.savemat(path, {"d_skel": skeleton_file(joints)})
    if depth_frames is not None:
        depth = np.zeros((240, 320, depth_frames), np.uint16)
        for x, y, z in joints[0]:
            u, v = round(160 + 285.63 * x / z), round(120 - 285.63 * y / z)
            depth[v, u] = round(1000 * z)
        scipy.io.savemat(folder / f"{stem}_depth.mat", {"d_depth": depth})
    return path


K = [[100.0, 0.0, 15.5], [0.0, 101.0, 11.5], [0.0, 0.0, 1.0]]


def pose_matrix(z: float) -> list[list[float]]:
    turned = Rotation.from_euler("xyz", (0.3, 0.2, 0.1)).as_matrix()
    return np.hstack((turned, [[0.1], [0.2], [z]])).tolist()


def save_video(root: Path, numbers: tuple[int, ...] = (3, 4, 6)) -> Path:
    """An excerpt of frames of 32 × 24 with a mug and a brick, poses in ``poses.json``."""
    folder = root / "data" / "0000"
    folder.mkdir(parents=True)
    colour = np.zeros((24, 32, 3), np.uint8)
    colour[..., 2] = 200
    poses = {}
    for number in numbers:
        cv2.imwrite(str(folder / f"{number:06}-color.png"), colour)
        depth = np.full((24, 32), 10_000 + number, np.uint16)
        cv2.imwrite(str(folder / f"{number:06}-depth.png"), depth)
        poses[f"{number:06}"] = {
            "K": K,
            "depth_divisor": 10_000,
            "poses_3x4": {"14": pose_matrix(number), "21": pose_matrix(2.0)},
        }
    (root / "poses.json").write_bytes(msgspec.json.encode(poses))
    return root


def save_meta(root: Path, number: int) -> None:
    """The data set's own annotation of a frame: a mug whose surface fills half of the image."""
    stem = root / "data" / "0000" / f"{number:06}"
    rows, columns = np.mgrid[0:24, 0:32]
    surface = np.dstack((columns / 100.0, rows / 100.0, columns * rows / 10_000.0))
    labels = np.where(columns < 16, 14, 0).astype(np.uint8)
    cv2.imwrite(f"{stem}-label.png", labels)
    scipy.io.savemat(
        f"{stem}-meta.mat",
        {
            "cls_indexes": np.array([[14]]),
            "poses": np.array(pose_matrix(9.0))[..., None],
            "intrinsic_matrix": np.array(K),
            "factor_depth": np.array([[10_000]]),
            "vertmap": surface.astype(np.float32),
        },
    )


def only_entry(dataset: Dataset) -> DatasetEntry:
    (entry,) = dataset.entries
    return entry


def messages_of(dataset: Dataset) -> list[Any]:
    return [r.message() for r in read_recording(dataset.path(only_entry(dataset)))]
