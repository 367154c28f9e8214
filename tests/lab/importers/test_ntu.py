"""Skeletons of NTU RGB+D."""

from pathlib import Path

import numpy as np
import pytest
from foreign_data import only_entry
from foreign_skeletons import ntu_text, save_text
from inhand_lab.datasets.dataset import DatasetEntry, DatasetError
from inhand_lab.importers.joint_tables import INFERRED, MISSING
from inhand_lab.importers.ntu import import_ntu, read_ntu

NAME = "S001C001P008R001A023.skeleton"


def test_the_entry_tells_what_the_name_does(tmp_path: Path) -> None:
    dataset = import_ntu([save_text(tmp_path / NAME, ntu_text())], tmp_path / "out")
    assert only_entry(dataset) == DatasetEntry(
        file="recordings/S001C001P008R001A023.mcap",
        interaction="A023",
        participant="P008",
        frame_rate=30.0,
    )


def test_a_file_of_another_name_is_its_own_participant(tmp_path: Path) -> None:
    dataset = import_ntu([save_text(tmp_path / "mine.skeleton", ntu_text())], tmp_path / "out")
    assert (only_entry(dataset).interaction, only_entry(dataset).participant) == ("mine", "mine")


def test_the_first_frame_shows_nobody_and_two_people_have_two_ids(tmp_path: Path) -> None:
    text = ntu_text(4, ids=(72057594037931101, 72057594037931202))
    bodies = read_ntu(save_text(tmp_path / NAME, text))
    assert len(bodies.times_ns) == 4
    assert bodies.frames.tolist() == [1, 1, 2, 2, 3, 3]
    assert bodies.ids.tolist() == [0, 1, 0, 1, 0, 1]


def test_states_are_kinects(tmp_path: Path) -> None:
    inferred = read_ntu(save_text(tmp_path / NAME, ntu_text(2, state=1))).joints
    assert set(inferred.states[0]) == {INFERRED}
    assert set(inferred.confidences[0]) == {0.5}
    lines = ntu_text(2).splitlines()
    lines[-1] = "nan" + lines[-1][lines[-1].index(" ") :]  # ThumbRight, which we do not have
    lines[8] = lines[8][:-1] + "0"  # Head
    joints = read_ntu(save_text(tmp_path / NAME, "\n".join(lines))).joints
    assert (joints.states[0] == MISSING).nonzero()[0].tolist() == [3]


def test_a_rate_that_does_not_divide_30_is_refused(tmp_path: Path) -> None:
    source = save_text(tmp_path / NAME, ntu_text())
    with pytest.raises(DatasetError, match="recorded at 30 Hz"):
        import_ntu([source], tmp_path / "out", frame_rate=7.0)


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("", "ends at its start: it is cut off"),
        ("a movie", "is 'a', and no whole number: this is no skeleton file"),
        ("-3", "number of frames at its start is -3"),
        (ntu_text().replace("\n25\n", "\n20\n"), "a body has 20 joints, and NTU RGB.D's have 25"),
        (ntu_text(frames=12)[:-300], "ends in frame 11 of 12: it is cut off; fetch it again"),
        (ntu_text() + "7 7 7", "goes on for 3 numbers after its 12 frames"),
        (ntu_text(state=3), "state in frame 1 of 12 is none of 0, 1 and 2"),
        (ntu_text().replace("-0.2 0.05", "-0.2 0,05").replace(" 2.5 ", " 2,5 "), "could not conv"),
        (ntu_text(ids=(5, 5)), "two bodies in frame 1 have the id 5"),
        ("0\n", "has no frame"),
    ],
)
def test_a_bad_file_is_refused_in_one_line(text: str, complaint: str, tmp_path: Path) -> None:
    with pytest.raises(DatasetError, match=complaint) as caught:
        import_ntu([save_text(tmp_path / NAME, text)], tmp_path / "out")
    assert "\n" not in str(caught.value)
    assert not (tmp_path / "out").exists()


def test_a_picture_is_no_skeleton_file(tmp_path: Path) -> None:
    (tmp_path / NAME).write_bytes(np.random.default_rng(0).bytes(1000))
    with pytest.raises(DatasetError, match="is no text"):
        import_ntu([tmp_path / NAME], tmp_path / "out")
