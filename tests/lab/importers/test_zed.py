"""Skeletons of ZED cameras."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from foreign_data import messages_of
from foreign_skeletons import save_json, standing_before_camera, zed_values
from inhand_lab.datasets.dataset import DatasetError, load_dataset
from inhand_lab.importers.coordinates import AXES, Coordinates
from inhand_lab.importers.joint_tables import INFERRED, MISSING, TRACKED
from inhand_lab.importers.zed import ZED, import_zed, read_zed
from inhand_schemas.joints import Joint
from inhand_schemas.messages import Skeletons

from inhand.__main__ import main

HAND = Joint.HAND_LEFT
FORWARDS_AND_UP = {
    # What each system is called for: where forwards, upwards and to the right are in it.
    "IMAGE": ((0, 0, 1), (0, -1, 0), (1, 0, 0)),
    "LEFT_HANDED_Y_UP": ((0, 0, 1), (0, 1, 0), (1, 0, 0)),
    "RIGHT_HANDED_Y_UP": ((0, 0, -1), (0, 1, 0), (1, 0, 0)),
    "RIGHT_HANDED_Z_UP": ((0, 1, 0), (0, 0, 1), (1, 0, 0)),
    "LEFT_HANDED_Z_UP": ((1, 0, 0), (0, 0, 1), (0, 1, 0)),
    "RIGHT_HANDED_Z_UP_X_FWD": ((1, 0, 0), (0, 0, 1), (0, -1, 0)),
}


def body_of(values: dict[str, Any]) -> dict[str, Any]:
    """The body that all frames of ``zed_values`` share."""
    body: dict[str, Any] = next(e for e in values.values() if "body_list" in e)["body_list"][0]
    return body


@pytest.mark.parametrize("system", AXES)
def test_every_coordinate_system_and_unit_puts_the_person_at_the_same_place(
    system: str, tmp_path: Path
) -> None:
    forwards, upwards, right = FORWARDS_AND_UP[system]
    values, out = zed_values(3, system, scale=1000.0), tmp_path / "out"
    x, y, z = standing_before_camera()[HAND]
    written = 1000.0 * (x * np.array(right) - y * np.array(upwards) + z * np.array(forwards))
    hand = ZED.joints.index("LEFT_HAND")
    np.testing.assert_allclose(body_of(values)["keypoint"][hand], written, atol=1e-9)
    handed = np.linalg.det([right, upwards, np.negative(forwards)])
    assert (handed < 0.0) == system.startswith("LEFT")
    source = save_json(tmp_path / "walk.json", values)
    options = ["--coordinate-system", system, "--unit", "millimetres"]
    assert main(["import", "zed", str(source), str(out), *options]) == 0
    last = messages_of(load_dataset(out))[-1]
    assert isinstance(last, Skeletons)
    np.testing.assert_allclose(last.people[0].joints[HAND], (x, y, z), atol=1e-9)


@pytest.mark.parametrize("system", [name for name in AXES if name != "RIGHT_HANDED_Y_UP"])
def test_no_other_system_passes_for_the_usual_one_without_a_word(
    system: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    caplog: pytest.LogCaptureFixture,
) -> None:
    source = save_json(tmp_path / "walk.json", zed_values(3, system))
    main(["import", "zed", str(source), str(tmp_path / "out")])
    assert "give --coordinate-system" in capsys.readouterr().err + caplog.text


@pytest.mark.parametrize("given", ["metres", "inches"])
def test_the_samples_unit_in_c_plus_plus_is_named_whatever_unit_was_given(
    given: str, tmp_path: Path
) -> None:
    source = save_json(tmp_path / "walk.json", zed_values(scale=1000.0))
    with pytest.raises(DatasetError, match="tall: give --unit millimetres"):
        import_zed([source], tmp_path / "out", coordinates=Coordinates("RIGHT_HANDED_Y_UP", given))


def test_confidences_and_states_say_what_is_tracked(tmp_path: Path) -> None:
    values = zed_values(1)
    body = body_of(values)
    for name, confidence in (("LEFT_KNEE", 12.0), ("LEFT_ANKLE", None), ("LEFT_ELBOW", -1.0)):
        body["keypoint_confidence"][ZED.joints.index(name)] = confidence
    body["keypoint"][ZED.joints.index("LEFT_HAND")] = [None, None, None]
    joints = read_zed(save_json(tmp_path / "walk.json", values)).joints
    assert joints.states[0, Joint.KNEE_LEFT] == joints.states[0, Joint.ANKLE_LEFT] == INFERRED
    assert joints.states[0, Joint.ELBOW_LEFT] == INFERRED
    assert joints.states[0, Joint.HAND_LEFT] == MISSING
    assert joints.states[0, Joint.KNEE_RIGHT] == TRACKED
    assert joints.confidences[0, Joint.KNEE_LEFT] == pytest.approx(0.12)
    assert joints.confidences[0, Joint.ELBOW_LEFT] == 0.0


@pytest.mark.parametrize(
    ("state", "expected"),
    [
        (1, TRACKED),
        (2, INFERRED),
        (0, TRACKED),
        ("OK", TRACKED),
        ("Searching", INFERRED),
        ("OBJECT_TRACKING_STATE.OK", TRACKED),
        ("OBJECT_TRACKING_STATE.TERMINATE", INFERRED),
    ],
)
def test_a_body_that_is_out_of_view_is_inferred(
    state: int | str, expected: int, tmp_path: Path
) -> None:
    values = zed_values(1)
    body_of(values)["tracking_state"] = state
    joints = read_zed(save_json(tmp_path / "walk.json", values)).joints
    assert set(joints.states[0]) == {expected}


def test_frames_without_anybody_and_bodies_without_joints_are_frames_of_nobody(
    tmp_path: Path,
) -> None:
    values = zed_values(6)
    names = [name for name in values if name != "0"]
    del values[names[1]]["body_list"]
    values[names[2]]["body_list"] = []
    values[names[3]]["body_list"] = [{"id": 3, "tracking_state": 1}]
    bodies = read_zed(save_json(tmp_path / "walk.json", values))
    assert len(bodies.times_ns) == 6
    assert bodies.frames.tolist() == [0, 4, 5]


@pytest.mark.parametrize(("joints", "whose"), [(38, "BODY_38"), (18, "BODY_18"), (35, "")])
def test_other_body_formats_are_refused_with_the_one_to_record(
    joints: int, whose: str, tmp_path: Path
) -> None:
    values = zed_values()
    body_of(values)["keypoint"] = [[0.1, 0.2, -2.0]] * joints
    with pytest.raises(DatasetError, match=rf"{joints} joints.*{whose}.*record it with.*BODY_34"):
        import_zed([save_json(tmp_path / "walk.json", values)], tmp_path / "out")


@pytest.mark.parametrize(
    ("change", "complaint"),
    [
        ({"keypoint_confidence": [80.0]}, "34 joints, and confidences of 1"),
        ({"keypoint": [[1.0, 2.0]] * 34}, "not as ZED's sample of JSON export writes it"),
        ({"id": "three"}, "not as ZED's sample of JSON export writes it"),
    ],
)
def test_a_bad_body_is_refused_in_one_line(
    change: dict[str, Any], complaint: str, tmp_path: Path
) -> None:
    values = zed_values()
    body_of(values).update(change)
    with pytest.raises(DatasetError, match=complaint) as caught:
        import_zed([save_json(tmp_path / "bad.json", values)], tmp_path / "out")
    assert "\n" not in str(caught.value)


def test_a_clock_that_was_set_is_told_where(tmp_path: Path) -> None:
    values = zed_values(12)
    names = [name for name in values if name != "0"]
    for name in names[7:]:
        values[name]["timestamp"] -= 500_000_000
    with pytest.raises(DatasetError, match=r"the clock steps back by 0\.467 s at frame 7"):
        import_zed([save_json(tmp_path / "walk.json", values)], tmp_path / "out")
