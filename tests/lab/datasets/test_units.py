"""Joints and labels in another unit than metres are refused by the unit's name."""

from pathlib import Path

import pytest
from changed_recordings import Change, scaled, with_joints, with_labels, write_recording
from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.datasets.recorded_frames import load_frames
from inhand_schemas.messages import Message, Skeletons

UNITS = {
    "millimetres": 1000.0,
    "centimetres": 100.0,
    "inches": 39.37,
    "decimetres": 10.0,
    "feet": 3.281,
    "kilometres": 0.001,
}


def joints_in(factor: float) -> Change:
    return with_joints(lambda metres: factor * metres)


def labels_in(factor: float) -> Change:
    return with_labels(lambda label: scaled(label, factor))


@pytest.mark.parametrize("unit", UNITS)
def test_a_person_whom_no_room_holds_names_the_unit_of_the_joints(
    unit: str, tmp_path: Path
) -> None:
    path = write_recording(tmp_path / "a.mcap", joints_in(UNITS[unit]))
    with pytest.raises(DatasetError, match=rf"a person .* m tall: joints .*in {unit}; write metr"):
        load_frames(path, "box")


@pytest.mark.parametrize("unit", ["millimetres", "centimetres", "inches"])
def test_joints_and_labels_in_one_wrong_unit_are_named_together(unit: str, tmp_path: Path) -> None:
    def change(message: Message) -> Message:
        other = joints_in if isinstance(message, Skeletons) else labels_in
        changed = other(UNITS[unit])(message)
        assert changed is not None
        return changed

    path = write_recording(tmp_path / "a.mcap", change)
    with pytest.raises(DatasetError, match=f"joints and labels are in {unit}; write metres"):
        load_frames(path, "box")


@pytest.mark.parametrize("unit", ["millimetres", "centimetres", "inches", "decimetres", "feet"])
def test_labels_far_from_everybody_name_the_unit_that_brings_them_near(
    unit: str, tmp_path: Path
) -> None:
    path = write_recording(tmp_path / "a.mcap", labels_in(UNITS[unit]))
    with pytest.raises(DatasetError, match=rf"labels are .* m away from everybody, .*in {unit}"):
        load_frames(path, "box")


def test_one_frame_in_another_unit_is_named(tmp_path: Path) -> None:
    change = with_joints(lambda metres: 100.0 * metres, frames=[7])
    path = write_recording(tmp_path / "a.mcap", change)
    with pytest.raises(
        DatasetError, match=r"72.8 m long in frame 7, and 0.73 m elsewhere: 1 of 30 .*in centimetr"
    ):
        load_frames(path, "box")


@pytest.mark.parametrize("factor", [0.5, 1.3])
def test_small_and_tall_people_are_accepted(factor: float, tmp_path: Path) -> None:
    load_frames(write_recording(tmp_path / "a.mcap", joints_in(factor)), "box")
