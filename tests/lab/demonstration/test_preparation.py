"""The settings of a demonstration's rig."""

import tomllib
from pathlib import Path

import pytest
from inhand_lab.demonstration.preparation import write_rig_file
from inhand_lab.world.simulator import SimulatorOptions


@pytest.mark.parametrize(("interaction", "roaming"), [("sweepFloor", True), ("pourCream", False)])
def test_several_cameras_show_the_same_from_one_start_and_one_tracker_follows_all(
    tmp_path: Path, interaction: str, roaming: bool
) -> None:
    path = write_rig_file(tmp_path, interaction, tmp_path / "some.model", "estimated", cameras=3)
    tables = tomllib.loads(path.read_text())
    assert list(tables["capture"]) == ["front", "left", "right"]
    options = [SimulatorOptions(**one["options"]) for one in tables["capture"].values()]
    assert [one.view for one in options] == [0, 1, 2]
    assert {one.roaming for one in options} == {roaming}
    assert len({one.start for one in options}) == 1
    assert {one["skeletons"] for one in tables["capture"].values()} == {"estimated"}
    (tracker,) = tables["tracker"].values()
    assert tracker["cameras"] == ["front", "left", "right"]
    assert "camera" not in tracker


def test_a_single_camera_is_followed_as_ever(tmp_path: Path) -> None:
    tables = tomllib.loads(
        write_rig_file(tmp_path, "drinkFromMug", tmp_path / "some.model").read_text()
    )
    assert list(tables["capture"]) == ["camera"]
    assert "cameras" not in tables["capture"]["camera"]["options"]
    assert tables["tracker"]["follower"]["camera"] == "camera"
