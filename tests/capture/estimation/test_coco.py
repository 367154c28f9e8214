"""Networks of COCO's key points in ONNX files."""

from pathlib import Path

import numpy as np
import pytest
from inhand_capture.estimation.coco import ROWS, CocoNetwork
from inhand_capture.estimation.estimator import SkeletonEstimator
from inhand_capture.estimation.networks import open_network, require_network
from inhand_capture.estimation.weights import WeightsError
from inhand_runtime.errors import SettingsError
from inhand_schemas.joints import Joint
from numpy.typing import NDArray
from onnx_networks import SIDE, write_network
from posed_person import INFO, depth_of, pixels_of, standing

TRUTH = standing()
COLOUR = np.zeros((480, 640, 3), np.uint8)
SCALE = SIDE / 640.0
OFFSET = np.array([0.0, 0.5 * (640 - 480)])
COCO = {
    Joint.SHOULDER_LEFT: 5,
    Joint.SHOULDER_RIGHT: 6,
    Joint.ELBOW_LEFT: 7,
    Joint.ELBOW_RIGHT: 8,
    Joint.WRIST_LEFT: 9,
    Joint.WRIST_RIGHT: 10,
    Joint.HIP_LEFT: 11,
    Joint.HIP_RIGHT: 12,
    Joint.KNEE_LEFT: 13,
    Joint.KNEE_RIGHT: 14,
    Joint.ANKLE_LEFT: 15,
    Joint.ANKLE_RIGHT: 16,
}


def candidate(joints: NDArray[np.float64], score: float) -> NDArray[np.float64]:
    """What the network says of somebody, (56,)."""
    pixels = (pixels_of(joints) + OFFSET + 0.5) * SCALE
    points = np.zeros((17, 3))
    points[:5, :2], points[:, 2] = pixels[Joint.HEAD], 0.9
    for joint, point in COCO.items():
        points[point, :2] = pixels[joint]
    known = points[:, :2]
    low, high = known.min(axis=0), known.max(axis=0)
    return np.concatenate([0.5 * (low + high), high - low, [score], points.ravel()])


@pytest.fixture
def network(tmp_path: Path) -> Path:
    """Two people: one found twice, the other surely, and a candidate that is nobody."""
    other = standing(x=0.9)
    rows = [
        candidate(TRUTH, 0.8),
        candidate(TRUTH + np.array([0.02, 0.0, 0.0]), 0.7),
        candidate(other, 0.9),
        candidate(standing(x=-0.9), 0.2),
    ]
    said = np.array(rows, np.float32).T[None]
    return write_network(tmp_path / "pose.onnx", said)


def test_each_person_is_found_once_the_surest_first_and_hands_and_feet_are_unknown(
    network: Path,
) -> None:
    people = open_network(network).find(COLOUR)
    assert len(people) == 2
    first, second = people
    assert first.pixels[Joint.HEAD, 0] > second.pixels[Joint.HEAD, 0]
    assert np.isnan(second.pixels[[Joint.HAND_LEFT, Joint.FOOT_RIGHT]]).all()
    assert np.isnan(second.depths).all()
    off = np.linalg.norm(second.pixels - pixels_of(TRUTH), axis=1)
    assert np.nanmax(off) < 1.0


def test_skeletons_come_of_it_with_hands_and_feet_inferred(network: Path) -> None:
    estimator = SkeletonEstimator(CocoNetwork(network), INFO)
    people = estimator.estimate(COLOUR, depth_of(TRUTH, standing(x=0.9)), 0)
    assert [person.id for person in people] == [0, 1]
    person = people[1]
    assert person.states[Joint.HAND_LEFT] == person.states[Joint.FOOT_LEFT] == "inferred"
    assert person.confidences[Joint.HAND_LEFT] == pytest.approx(0.45)
    hand = np.array(person.joints[Joint.HAND_LEFT])
    assert np.linalg.norm(hand - TRUTH[Joint.HAND_LEFT]) < 0.1


def test_foreign_networks_and_files_are_refused_in_one_line(tmp_path: Path) -> None:
    wrong = write_network(tmp_path / "other.onnx", np.zeros((1, ROWS + 1, 3), np.float32))
    with pytest.raises(WeightsError, match=r"other\.onnx is another network: it should take"):
        CocoNetwork(wrong)
    (tmp_path / "no.onnx").write_bytes(b"no network at all")
    with pytest.raises(WeightsError, match=r"no\.onnx is no network of ONNX: "):
        CocoNetwork(tmp_path / "no.onnx")
    with pytest.raises(WeightsError, match=r"there is no network at .*none\.onnx: check the path"):
        require_network(tmp_path / "none.onnx")
    with pytest.raises(SettingsError, match=r"'ligt' is no network: name one of lite, full, heavy"):
        require_network(Path("ligt"))
