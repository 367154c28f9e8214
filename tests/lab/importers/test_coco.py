"""COCO's key points in space."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from foreign_data import messages_of
from foreign_skeletons import as_nulls, coco_values, person_of, save_json, save_npz
from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.importers.coco import COCO, import_coco, read_coco
from inhand_lab.importers.joint_tables import INFERRED, MISSING, TRACKED
from inhand_schemas.joints import Joint
from inhand_schemas.messages import Skeletons

WRIST = COCO.joints.index("left_wrist")


def test_json_says_the_same_as_npz_with_null_for_what_is_not_seen(tmp_path: Path) -> None:
    values = coco_values()
    values["keypoints"][4, WRIST] = np.nan
    npz = read_coco(save_npz(tmp_path / "a.npz", values))
    lists = {name: as_nulls(array.tolist()) for name, array in values.items()}
    json = read_coco(save_json(tmp_path / "b.json", lists))
    np.testing.assert_array_equal(npz.joints.places, json.joints.places)
    np.testing.assert_array_equal(npz.joints.states, json.joints.states)
    assert npz.joints.states[4, Joint.WRIST_LEFT] == MISSING
    assert npz.joints.states[4, Joint.HAND_LEFT] == MISSING
    assert npz.joints.states[5, Joint.WRIST_LEFT] == TRACKED


def test_several_people_are_told_apart_by_their_place_in_the_array(tmp_path: Path) -> None:
    values = coco_values(3, people=2)
    values["keypoints"][1, 0] = np.nan
    dataset = import_coco([save_npz(tmp_path / "two.npz", values)], tmp_path / "out")
    skeletons = [one for one in messages_of(dataset) if isinstance(one, Skeletons)]
    assert [[person.id for person in one.people] for one in skeletons] == [[0, 1], [1], [0, 1]]


def test_a_nose_alone_is_nobody(tmp_path: Path) -> None:
    values = coco_values(3)
    values["keypoints"][1, 1:] = np.nan
    assert read_coco(save_npz(tmp_path / "a.npz", values)).frames.tolist() == [0, 2]
    values["keypoints"][:, 1:] = np.nan
    with pytest.raises(DatasetError, match="no frame with a body"):
        read_coco(save_npz(tmp_path / "b.npz", values))


def test_scores_say_what_is_tracked(tmp_path: Path) -> None:
    values = coco_values(2) | {"scores": np.full((2, 17), 0.9)}
    values["scores"][1, WRIST] = 0.1
    joints = read_coco(save_npz(tmp_path / "a.npz", values)).joints
    assert joints.states[:, Joint.WRIST_LEFT].tolist() == [TRACKED, INFERRED]
    assert joints.confidences[:, Joint.WRIST_LEFT].tolist() == [0.9, 0.1]


PIXELS = 100.0 * person_of(COCO)[:, :2] + 300.0
SCORED = np.hstack((PIXELS, np.full((17, 1), 0.8)))


@pytest.mark.parametrize(
    "keypoints",
    [
        PIXELS[None],
        SCORED[None],
        SCORED[None, None],
        SCORED[None] / [640.0, 480.0, 1.0],
        SCORED[None] - [300.0, 0.0, 0.0],
    ],
    ids=["pixels", "pixels and scores", "of people", "shares of the picture", "out of the picture"],
)
def test_key_points_in_pixels_are_refused_with_what_gives_them_depth(
    keypoints: np.ndarray, tmp_path: Path
) -> None:
    source = save_npz(tmp_path / "flat.npz", {"keypoints": keypoints, "times": np.zeros(1)})
    with pytest.raises(DatasetError, match=r"no depths: .*`inhand recording skeletons`"):
        import_coco([source], tmp_path / "out")


@pytest.mark.parametrize(
    "values",
    [
        [{"image_id": 1, "category_id": 1, "keypoints": SCORED.ravel().tolist(), "score": 0.9}],
        {"annotations": [{"keypoints": SCORED.ravel().tolist(), "num_keypoints": 17}]},
        {"meta_info": {}, "instance_info": [{"frame_id": 0, "instances": []}]},
    ],
    ids=["results", "annotations", "a pose library's predictions"],
)
def test_results_of_pictures_are_refused_with_what_gives_them_depth(
    values: Any, tmp_path: Path
) -> None:
    with pytest.raises(DatasetError, match=r"results of pictures.*`inhand recording skeletons`"):
        import_coco([save_json(tmp_path / "flat.json", values)], tmp_path / "out")


def test_a_person_near_and_to_the_right_of_the_camera_is_no_picture(tmp_path: Path) -> None:
    values = coco_values()
    values["keypoints"] = values["keypoints"] + [2.0, 1.0, -1.2]
    assert values["keypoints"].min() > 0.0
    import_coco([save_npz(tmp_path / "near.npz", values)], tmp_path / "out")


@pytest.mark.parametrize(
    ("changes", "complaint"),
    [
        ({"keypoints": np.zeros((12, 25, 3))}, "a body has 25 joints, and COCO's have 17; 25"),
        ({"keypoints": np.zeros((17, 3))}, r"keypoints are \(17, 3\), and should be \(frames"),
        ({"keypoints": np.ones((12, 17, 5))}, "have 5 numbers"),
        ({"keypoints": np.array(["a"])}, "keypoints are no numbers"),
        ({"keypoints": None}, "has no 'keypoints'"),
        ({"times": None}, "has no 'times'"),
        ({"times": np.arange(11.0)}, "for each of 12 frames"),
        ({"scores": np.ones((12, 16))}, "scores are"),
        ({"scores": np.full((12, 17), 80.0)}, "scores go from 80 to 80; write 0 to 1"),
        ({"keypoints": np.array([{}], object)}, "no NPZ that can be read"),
    ],
)
def test_a_bad_file_is_refused_in_one_line(
    changes: dict[str, Any], complaint: str, tmp_path: Path
) -> None:
    values = {name: one for name, one in (coco_values() | changes).items() if one is not None}
    with pytest.raises(DatasetError, match=complaint) as caught:
        import_coco([save_npz(tmp_path / "bad.npz", values)], tmp_path / "out")
    assert "\n" not in str(caught.value)
    assert not (tmp_path / "out").exists()
