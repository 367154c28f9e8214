"""Makes motion archives of a handover: two people's upper bodies and a baton, as CSV files.

``python tests/scenes/handover_archives.py FOLDER OUT`` reads what
``inhand_lab.importers.measured_handovers`` does, writes ``giver.npz`` and ``taker.npz``, each with
the frames in which that one has the baton; ``inhand import motion OUT DATASET`` takes them. One
archive holds one person: an object that passes on is a recording of each.
"""

import argparse
from pathlib import Path

import numpy as np
from inhand_lab.importers.measured_handovers import MEASURED, RATE_HZ, read_measured_handover
from inhand_schemas.joints import JOINT_NAMES, Joint

MARKS = 0.1 * np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], float)
"""Points of the baton in metres, in its axes: its shape is not told."""


def main() -> None:
    parser = argparse.ArgumentParser(prog="handover_archives.py", description=__doc__)
    parser.add_argument("folder", type=Path, metavar="FOLDER", help="of the CSV files")
    parser.add_argument("out", type=Path, metavar="OUT", help="a new folder for the archives")
    arguments = parser.parse_args()
    arguments.out.mkdir()
    measured = read_measured_handover(arguments.folder)
    away = [
        np.linalg.norm(joints[:, Joint.WRIST_RIGHT] - measured.translations, axis=1)
        for joints in measured.joints.values()
    ]
    passed = int(np.flatnonzero(away[1] < away[0])[0])
    x, w = measured.translations, measured.rotations
    for who, frames in (("giver", slice(None, passed)), ("taker", slice(passed, None))):
        np.savez(
            arguments.out / f"{who}.npz",
            joints=measured.joints[who][frames][:, MEASURED],
            joint_names=np.array([JOINT_NAMES[joint] for joint in MEASURED]),
            object_pose=np.concatenate([x, w], axis=1)[frames],
            vertices=MARKS,
            fps=np.array(RATE_HZ),
            interaction=np.array("handOver"),
            object=np.array("baton"),
            participant=np.array(who),
            handedness=np.array("right"),
        )
        print(f"{who}: {len(x[frames])} frames")


if __name__ == "__main__":
    main()
