"""A measured handover as CSV files, in a folder or in an archive."""

import tarfile
from pathlib import Path

import numpy as np
import pytest
from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.importers.measured_handovers import PEOPLE, read_measured_handover
from inhand_schemas.joints import Joint

SEGMENTS = ("hip", "ab", "neck", "head", "LUArm", "LFArm", "LHand", "RUArm", "RFArm")
FRAMES = 3


def written(folder: Path) -> Path:
    """People whose segments stand a metre apart, each with its forearms turned a quarter about z,
    and a baton that passes on."""
    folder.mkdir()
    quarter = (0.0, 0.0, np.sqrt(0.5), np.sqrt(0.5))
    for who in PEOPLE:
        for number, segment in enumerate(SEGMENTS):
            place = (float(number), 0.0, 1.0)
            if segment == "LHand":
                place = (5.0 - 0.05, 0.25, 1.0)
            write(folder / f"{who}_{segment}_pose_saved.csv", (*place, *quarter))
    write(folder / "baton_pose_saved.csv", (0.5, 0.6, 0.7, 1.0, 0.0, 0.0, 0.0))
    write(folder / "Wrench_giver_saved.csv", (0.0, 3.0, -4.0, 9.0, 9.0, 9.0))
    write(folder / "Wrench_taker_saved.csv", (0.0, 0.0, 0.0, 9.0, 9.0, 9.0))
    return folder


def write(path: Path, row: tuple[float, ...]) -> None:
    np.savetxt(path, np.tile(row, (FRAMES, 1)), delimiter=",", header="x,y,z,…")


@pytest.mark.parametrize("packed", [False, True])
def test_joints_the_baton_and_who_holds_it_are_read(tmp_path: Path, packed: bool) -> None:
    folder = written(tmp_path / "saved")
    if packed:
        with tarfile.open(tmp_path / "one.tar.xz", "w:xz") as archive:
            archive.add(folder, "one_saved_handover")
        folder = tmp_path
    read = read_measured_handover(folder)
    joints = read.joints["taker"][1]
    assert joints[Joint.HEAD] == pytest.approx([3.0, 0.0, 1.0])
    assert np.isnan(joints[[Joint.HAND_RIGHT, Joint.HIP_LEFT, Joint.FOOT_RIGHT]]).all()
    # The left wrist is 25 cm ahead of its forearm's root and 5 cm aside, the right one on the
    # other side.
    assert joints[Joint.WRIST_LEFT] == pytest.approx([4.95, 0.25, 1.0])
    assert joints[Joint.WRIST_RIGHT] == pytest.approx([7.95, -0.25, 1.0])
    assert read.translations[0] == pytest.approx([0.5, 0.6, 0.7])
    assert read.rotations[0] == pytest.approx([0.0, 1.0, 0.0, 0.0])
    assert [read.forces[who].tolist() for who in PEOPLE] == [[5.0] * FRAMES, [0.0] * FRAMES]


def test_what_is_no_measured_handover_is_refused(tmp_path: Path) -> None:
    with pytest.raises(DatasetError, match=r"baton_pose_saved.csv is missing: name a folder"):
        read_measured_handover(tmp_path)
    folder = written(tmp_path / "saved")
    (folder / "giver_neck_pose_saved.csv").write_text("x,y\nnone\n")
    with pytest.raises(DatasetError, match=r"giver_neck_pose_saved.csv is no table of numbers"):
        read_measured_handover(folder)
    (tmp_path / "one.tar.xz").write_bytes(b"nothing")
    with pytest.raises(DatasetError, match=r"one.tar.xz cannot be read"):
        read_measured_handover(tmp_path)
