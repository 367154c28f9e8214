"""A person who stands before a camera, as other skeletons' conventions and programs write them."""

import json
import math
import re
from pathlib import Path
from typing import Any

import numpy as np
from foreign_data import standing
from inhand_lab.importers.azure_kinect import AZURE_KINECT
from inhand_lab.importers.coco import COCO
from inhand_lab.importers.coordinates import AXES
from inhand_lab.importers.joint_tables import TRACKED, JointSets, JointTable
from inhand_lab.importers.ntu import NTU
from inhand_lab.importers.zed import ZED
from inhand_schemas.joints import JOINT_NAMES, Joint

TABLES = (AZURE_KINECT, ZED, NTU, COCO)
START_MS = 1_680_100_601_285
"""A time of ZED's, in milliseconds since the epoch."""


def standing_before_camera() -> np.ndarray:
    """Kinect's joints (20, 3), metres, in OpenCV's frame: 2.5 m away, facing the camera."""
    return (standing() - [0.0, 1.0, 0.0]) * [1.0, -1.0, -1.0] + [0.0, 0.0, 2.5]


def person_of(table: JointTable) -> np.ndarray:
    """The same person's joints (J, 3) in a convention, metres, in OpenCV's frame."""
    places = _places()
    return np.array([places[_words(name)] for name in table.joints])


def seen(places: np.ndarray) -> JointSets:
    """Bodies (N, J, 3) that are tracked as well as can be."""
    shape = places.shape[:2]
    return JointSets(places, np.full(shape, TRACKED, np.uint8), np.ones(shape))


def _words(name: str) -> frozenset[str]:
    """The words of a joint's name, whatever their order and case."""
    apart = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name.replace("HandTip", "Handtip"))
    return frozenset(apart.upper().split("_"))


def _places() -> dict[frozenset[str], np.ndarray]:
    joints = standing_before_camera()
    places = {_words(name): joints[i] for i, name in enumerate(JOINT_NAMES)}
    hips = joints[[Joint.HIP_LEFT, Joint.HIP_RIGHT]].mean(axis=0)
    neck, head = joints[Joint.SHOULDER_CENTER], joints[Joint.HEAD]
    shares = {
        "SPINE_NAVEL": 1 / 3,
        "NAVAL_SPINE": 1 / 3,
        "SPINE_CHEST": 2 / 3,
        "CHEST_SPINE": 2 / 3,
    }
    shares |= {"PELVIS": 0.0, "SPINE_BASE": 0.0, "SPINE_MID": 0.58, "NECK": 1.0}
    shares |= {"SPINE_SHOULDER": 1.0}
    places |= {_words(name): hips + share * (neck - hips) for name, share in shares.items()}
    places[_words("NOSE")] = head + np.array([0.0, 0.0, -0.1])
    for side, left in (("LEFT", 1.0), ("RIGHT", -1.0)):
        for name, beside in (("CLAVICLE", neck), ("EAR", head), ("EYE", places[_words("NOSE")])):
            places[_words(f"{name}_{side}")] = beside + np.array([0.07 * left, 0.0, 0.0])
        hand, ankle = joints[Joint[f"HAND_{side}"]], joints[Joint[f"ANKLE_{side}"]]
        places[_words(f"HANDTIP_{side}")] = hand + np.array([0.0, 0.05, 0.0])
        places[_words(f"THUMB_{side}")] = hand + np.array([0.0, 0.0, -0.05])
        places[_words(f"{side}_HEEL")] = ankle + np.array([0.0, 0.05, 0.05])
    return places


def azure_kinect_values(frames: int = 12, *, bodies: int = 1) -> dict[str, Any]:
    """What offline_processor writes: millimetres, and a clock of the device's own."""
    body = (1000.0 * person_of(AZURE_KINECT)).tolist()
    turns = [[1.0, 0.0, 0.0, 0.0]] * len(AZURE_KINECT.joints)
    shown = [
        {"body_id": 7 + i, "joint_positions": body, "joint_orientations": turns}
        for i in range(bodies)
    ]
    return {
        "k4abt_sdk_version": "1.1.2",
        "source_file": "walk.mkv",
        "joint_names": list(AZURE_KINECT.joints),
        "bone_list": [["SPINE_CHEST", "SPINE_NAVEL"]],
        "frames": [
            {
                "timestamp_usec": 1_500_000 + 1_000_000 * i // 30,
                "frame_id": i,
                "num_bodies": bodies,
                "bodies": shown,
            }
            for i in range(frames)
        ],
    }


def zed_values(
    frames: int = 12, system: str = "RIGHT_HANDED_Y_UP", scale: float = 1.0
) -> dict[str, Any]:
    """What the sample in C++ writes, its first entry, without anything, as well."""
    places = scale * in_system(person_of(ZED), system)
    body = {
        "id": 3,
        "tracking_state": 1,
        "keypoint": places.tolist(),
        "keypoint_confidence": [80.0] * len(ZED.joints),
    }
    entries: dict[str, Any] = {"0": {"is_new": False, "is_tracked": False, "timestamp": 0}}
    for i in range(frames):
        time_ms = START_MS + 1000 * i // 30
        entries[str(time_ms)] = {
            "is_new": True,
            "is_tracked": True,
            "timestamp": 1_000_000 * time_ms,
            "body_list": [body],
        }
    return entries


def in_system(places: np.ndarray, system: str) -> np.ndarray:
    """Places (..., 3) of OpenCV's frame in one of ZED's coordinate systems, axis by axis."""
    written = np.empty_like(places)
    for ours, axis in enumerate(AXES[system]):
        theirs = "xyz".index(axis[-1])
        written[..., theirs] = -places[..., ours] if axis[0] == "-" else places[..., ours]
    return written


def coco_values(frames: int = 12, people: int | None = None) -> dict[str, Any]:
    """Key points in space of one person, or of several who stand beside each other."""
    one = np.repeat(person_of(COCO)[None], frames, axis=0)
    if people is not None:
        aside = np.arange(people)[:, None, None] * [1.0, 0.0, 0.0]
        one = one[:, None] + aside
    return {"keypoints": one, "times": np.arange(frames) / 30.0}


def ntu_text(frames: int = 12, ids: tuple[int, ...] = (72057594037931101,), state: int = 2) -> str:
    """A .skeleton file; nobody is in its first frame."""
    places = person_of(NTU) * [-1.0, -1.0, 1.0]
    joints = "".join(
        f"{x:.7g} {y:.7g} {z:.7g} 277.4 191.8 1036.2 519.2 -0.2 0.05 0.97 -0.12 {state}\n"
        for x, y, z in places
    )
    body = f"0 1 1 1 1 0 0.0276 0.0575 2\n25\n{joints}"
    shown = f"{len(ids)}\n" + "".join(f"{number} {body}" for number in ids)
    return f"{frames}\n0\n" + shown * (frames - 1)


def save_json(path: Path, values: Any) -> Path:
    path.write_text(json.dumps(values))
    return path


def save_npz(path: Path, values: dict[str, Any]) -> Path:
    np.savez(path, **values)
    return path


def save_text(path: Path, text: str) -> Path:
    path.write_text(text)
    return path


def as_nulls(value: Any) -> Any:
    """The value with null for NaN, as some programs write it."""
    if isinstance(value, list):
        return [as_nulls(one) for one in value]
    return None if isinstance(value, float) and math.isnan(value) else value
