"""Makes motion archives of a handover: two people's upper bodies and a baton, as CSV files.

``python tests/scenes/handover_archives.py FOLDER OUT`` reads ``giver_chest_pose_saved.csv`` and
so on, writes ``giver.npz`` and ``taker.npz``, each with the frames in which that one has the baton;
``inhand import motion OUT DATASET`` takes them. One archive holds one person: an object that passes
on is a recording of each.

A segment's pose is x, y, z and a quaternion of its near end. Of the right hands nothing was
measured (their file is the left hand's), so that a right wrist is where the forearm points, as far
as the left one is; hands and legs are left out.
"""

import argparse
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

RATE_HZ = 120.0
JOINTS = {
    "HipCenter": "hip",
    "Spine": "ab",
    "ShoulderCenter": "neck",
    "Head": "head",
    "ShoulderLeft": "LUArm",
    "ElbowLeft": "LFArm",
    "WristLeft": "LHand",
    "ShoulderRight": "RUArm",
    "ElbowRight": "RFArm",
}
"""Joints by the segment at whose near end they are."""
MARKS = 0.1 * np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], float)
"""Points of the baton in metres, in its axes: its shape is not told."""


def read_segment(folder: Path, name: str) -> np.ndarray:
    """Poses (T, 7) of a segment: x, y, z, then w, x, y, z."""
    rows = np.genfromtxt(folder / f"{name}_pose_saved.csv", delimiter=",", skip_header=1)
    return rows[:, [0, 1, 2, 6, 3, 4, 5]]


def joints_of(folder: Path, who: str) -> np.ndarray:
    """Joints (T, 10, 3) of somebody in metres, the right wrist last."""
    segments = {name: read_segment(folder, f"{who}_{part}") for name, part in JOINTS.items()}
    left, right = segments["ElbowLeft"], segments["ElbowRight"]
    ahead = turns_of(left).inv().apply(segments["WristLeft"][:, :3] - left[:, :3])
    mirrored = np.median(ahead, axis=0) * [-1.0, 1.0, 1.0]
    wrist = right[:, :3] + turns_of(right).apply(mirrored)
    return np.stack([*(one[:, :3] for one in segments.values()), wrist], axis=1)


def turns_of(poses: np.ndarray) -> Rotation:
    return Rotation.from_quat(poses[:, 3:], scalar_first=True)


def main() -> None:
    parser = argparse.ArgumentParser(prog="handover_archives.py", description=__doc__)
    parser.add_argument("folder", type=Path, metavar="FOLDER", help="of the CSV files")
    parser.add_argument("out", type=Path, metavar="OUT", help="a new folder for the archives")
    arguments = parser.parse_args()
    arguments.out.mkdir()
    baton = read_segment(arguments.folder, "baton")
    joints = {who: joints_of(arguments.folder, who) for who in ("giver", "taker")}
    away = [np.linalg.norm(one[:, -1] - baton[:, :3], axis=1) for one in joints.values()]
    passed = int(np.flatnonzero(away[1] < away[0])[0])
    for who, frames in (("giver", slice(None, passed)), ("taker", slice(passed, None))):
        np.savez(
            arguments.out / f"{who}.npz",
            joints=joints[who][frames],
            joint_names=np.array([*JOINTS, "WristRight"]),
            object_pose=baton[frames],
            vertices=MARKS,
            fps=np.array(RATE_HZ),
            interaction=np.array("handOver"),
            object=np.array("baton"),
            participant=np.array(who),
            handedness=np.array("right"),
        )
        print(f"{who}: {len(baton[frames])} frames")


if __name__ == "__main__":
    main()
