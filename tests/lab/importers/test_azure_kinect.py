"""Skeletons of Azure Kinect."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from foreign_data import messages_of
from foreign_skeletons import azure_kinect_values, save_json
from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.importers.azure_kinect import import_azure_kinect, read_azure_kinect
from inhand_lab.importers.joint_tables import MISSING
from inhand_schemas.joints import Joint
from inhand_schemas.messages import Skeletons


def test_joints_are_found_by_name_in_any_order_and_by_the_documentations_names(
    tmp_path: Path,
) -> None:
    values = azure_kinect_values()
    plain = read_azure_kinect(save_json(tmp_path / "plain.json", values))
    order = np.random.default_rng(3).permutation(32)
    names = [values["joint_names"][i].replace("NAVEL", "NAVAL") for i in order]
    body = values["frames"][0]["bodies"][0]
    body["joint_positions"] = [body["joint_positions"][i] for i in order]
    other = save_json(tmp_path / "other.json", values | {"joint_names": names})
    np.testing.assert_array_equal(read_azure_kinect(other).joints.places[0], plain.joints.places[0])


def test_several_people_keep_their_ids_in_the_order_they_come(tmp_path: Path) -> None:
    values = azure_kinect_values(bodies=2)
    values["frames"][0]["bodies"] = values["frames"][0]["bodies"][1:]
    values["frames"][5]["bodies"] = []
    dataset = import_azure_kinect([save_json(tmp_path / "two.json", values)], tmp_path / "out")
    ids = [[p.id for p in one.people] for one in messages_of(dataset) if isinstance(one, Skeletons)]
    # The file's 8 came first, and is 0.
    assert ids[:6] == [[0], [1, 0], [1, 0], [1, 0], [1, 0], []]


@pytest.mark.parametrize("unknown", [None, np.nan])
def test_joints_that_are_no_numbers_are_missing(unknown: float | None, tmp_path: Path) -> None:
    values = azure_kinect_values(1)
    wrist = values["joint_names"].index("WRIST_LEFT")
    values["frames"][0]["bodies"][0]["joint_positions"][wrist] = [unknown, 1.0, 2.0]
    (states,) = read_azure_kinect(save_json(tmp_path / "nan.json", values)).joints.states
    assert [joint for joint in Joint if states[joint] == MISSING] == [Joint.WRIST_LEFT]


def test_a_body_of_zeros_is_nobody(tmp_path: Path) -> None:
    values = azure_kinect_values(3)
    zeros = values["frames"][1]["bodies"][0] | {"joint_positions": [[0.0, 0.0, 0.0]] * 32}
    values["frames"][1]["bodies"] = [zeros]
    bodies = read_azure_kinect(save_json(tmp_path / "zeros.json", values))
    assert bodies.frames.tolist() == [0, 2]


def broken(change: str) -> Any:
    values = azure_kinect_values()
    body = values["frames"][4]["bodies"][0]
    match change:
        case "25 joints":
            body["joint_positions"] = body["joint_positions"][:25]
        case "25 names":
            values["joint_names"] = values["joint_names"][:25]
        case "other names":
            values["joint_names"][0] = "TAIL"
        case "no frames":
            del values["frames"]
        case "pixels":
            body["joint_positions"] = [[1.0, 2.0]] * 32
        case "metres":
            # All frames share their body.
            body["joint_positions"] = (0.001 * np.array(body["joint_positions"])).tolist()
        case "same ids":
            values["frames"][4]["bodies"] = [body, body]
        case "a list":
            return [values]
    return values


@pytest.mark.parametrize(
    ("change", "complaint"),
    [
        ("25 joints", "a body has 25 joints, and Azure Kinect's have 32; 25 are those of Kinect 2"),
        ("25 names", "a body has 25 joints"),
        ("other names", "joint_names has no PELVIS"),
        ("no frames", "not as offline_processor writes it: .*frames"),
        ("pixels", "not as offline_processor writes it: .*joint_positions"),
        ("metres", "Azure Kinect's are in millimetres"),
        ("same ids", "two bodies in frame 4 have the id 7"),
        ("a list", "not as offline_processor writes it"),
    ],
)
def test_a_bad_file_is_refused_in_one_line(change: str, complaint: str, tmp_path: Path) -> None:
    source = save_json(tmp_path / "bad.json", broken(change))
    with pytest.raises(DatasetError, match=complaint) as caught:
        import_azure_kinect([source], tmp_path / "out")
    assert "\n" not in str(caught.value)
    assert not (tmp_path / "out").exists()
