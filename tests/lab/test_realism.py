"""The comparison of simulated sensors with real ones."""

import json
from pathlib import Path

import numpy as np
import pytest
from inhand_lab.dataset import DatasetError
from inhand_lab.joints import PARENTS, Joint
from inhand_lab.realism import LEFT_OUT, WITHIN, Comparison, compare
from inhand_lab.realism_depth import DepthPair, measure_depth
from inhand_lab.realism_skeletons import Figure, hand_bends, measure_skeletons
from inhand_lab.transforms import Floats
from numpy.typing import NDArray

from inhand.__main__ import main

DATA = Path(__file__).parents[3] / "shared" / "data"

needs_real_data = pytest.mark.skipif(
    not (DATA / "utd-mhad").is_dir(), reason=f"the real data are not on this machine: no {DATA}"
)


def skeletons(trembling: float, seed: int = 0, drift: float = 0.0) -> list[Floats]:
    """A doll that rests but for what is asked for, in metres a frame."""
    random = np.random.default_rng(seed)
    doll = np.zeros((20, 3))
    for joint, parent in enumerate(PARENTS):
        if parent >= 0:
            doll[joint] = doll[parent] + (0.0, 0.1 + 0.01 * joint, 0.0)
    still = np.repeat(doll[None], 900, axis=0)
    still += drift * np.arange(900)[:, None, None] * np.array([1.0, 0.0, 0.0])
    return [still + trembling * random.normal(size=still.shape) for _ in range(2)]


def value(figures: list[Figure], name: str, on: str) -> float:
    (found,) = [one.value for one in figures if (one.name, one.on) == (name, on)]
    return found


def test_the_figures_of_any_recordings_are_the_same_properties() -> None:
    one, other = (measure_skeletons(skeletons(size)) for size in (0.0005, 0.003))
    assert [(a.name, a.on) for a in one] == [(b.name, b.on) for b in other]


def test_jitter_grows_as_the_trembling_does() -> None:
    small, large = (
        value(measure_skeletons(skeletons(size)), "head jitter, median", "still head")
        for size in (0.0003, 0.0006)
    )
    assert large == pytest.approx(2.0 * small, rel=0.05)
    assert small == pytest.approx(1.54 * np.sqrt(6.0) * 0.3, rel=0.05)


def test_a_drift_is_told_from_a_tremble() -> None:
    name, on = "wrist drift over jitter", "still wrist"
    assert value(measure_skeletons(skeletons(0.0005)), name, on) == pytest.approx(1.0, abs=0.1)
    drifting = measure_skeletons(skeletons(1e-6, drift=0.001))
    assert value(drifting, name, on) == pytest.approx(8.0, rel=0.05)


def test_what_is_too_rare_to_tell_is_no_number() -> None:
    assert np.isnan(value(measure_skeletons(skeletons(0.0)), "hand turned by 90°", "fast wrist"))


def test_a_hand_that_points_back_is_bent_by_half_a_turn() -> None:
    joints = skeletons(0.0)[0][:1].copy()
    arm = (Joint.ELBOW_RIGHT, Joint.WRIST_RIGHT, Joint.HAND_RIGHT)
    assert hand_bends(joints, arm)[0] == pytest.approx(0.0, abs=1e-6)
    joints[0, Joint.HAND_RIGHT] = joints[0, Joint.WRIST_RIGHT] - (0.0, 0.05, 0.0)
    assert hand_bends(joints, arm)[0] == pytest.approx(180.0)


def depth_pairs(noise: float, step: int) -> list[DepthPair]:
    """A flat person 60 pixels wide at 2.5 m, measured in steps, in millimetres."""
    random = np.random.default_rng(0)
    joints = np.tile([0.0, 0.0, 2.5], (20, 1))
    joints[[Joint.HIP_LEFT, Joint.HIP_RIGHT], 0] = 0.1, -0.1
    joints[Joint.HIP_CENTER, 1], joints[Joint.SHOULDER_CENTER, 1] = 0.3, -0.3
    joints[Joint.SPINE, 1] = 0.2

    def frame() -> NDArray[np.uint16]:
        depth = np.zeros((240, 320), np.uint16)
        exact = 2500.0 + noise * random.normal(size=(160, 60))
        depth[40:200, 130:190] = step * np.rint(exact / step)
        return depth

    return [DepthPair((frame(), frame()), (joints, joints), 285.0, (160.0, 120.0))] * 3


def test_depth_figures_follow_steps_and_noise() -> None:
    fine, rough = (measure_depth(depth_pairs(noise, 1)) for noise in (2.0, 8.0))
    for name, on, real in (
        ("depth roughness", "chest, less its curvature", 8.0),
        ("depth deviation in time", "resting chest", 8.0),
    ):
        assert value(rough, name, on) == pytest.approx(real, rel=0.15)
        assert value(fine, name, on) == pytest.approx(real / 4.0, rel=0.15)
    coarse = measure_depth(depth_pairs(8.0, 16))
    ratio = value(coarse, "depth step over squared distance", "2.0 to 2.7 m")
    assert ratio == pytest.approx(16.0 / 2.5**2, rel=0.05)
    assert value(coarse, "ragged pixels", "person's outline") < 5.0


def test_a_ratio_is_within_the_factor_either_way() -> None:
    for simulated, expected in ((2.9, True), (3.1, False), (1.4, True), (1.3, False)):
        assert Comparison("x", "mm", "all", 2.0, simulated).within is expected
    assert not Comparison("x", "mm", "all", 2.0, np.nan).within


def test_a_folder_without_recordings_is_named(tmp_path: Path) -> None:
    with pytest.raises(DatasetError, match="--data"):
        compare(tmp_path)


def test_without_the_real_data_one_line_says_where_they_should_be(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["simulate", "--realism"]) == 2
    assert "--data" in capsys.readouterr().err.strip().splitlines()[-1]


def test_the_table_goes_to_machines_too(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    compared = [
        Comparison("jitter", "mm", "still head", 1.0, 1.2),
        Comparison("flips", "", "fast wrist", 1.0, np.nan),
    ]
    monkeypatch.setattr("inhand.realism.compare", lambda *_: compared)
    result = tmp_path / "realism.json"
    assert main(["simulate", "--realism", "--data", str(tmp_path), "--json", str(result)]) == 1
    shown = capsys.readouterr()
    assert "still head" in shown.out
    assert "Knowingly left out" in shown.out
    assert "1 of 2" in shown.err
    written = json.loads(result.read_text())
    assert written["within"] == WITHIN
    assert [one["ratio"] for one in written["properties"]] == [1.2, None]
    assert written["left_out"] == list(LEFT_OUT)


@pytest.mark.long
@needs_real_data
def test_every_property_is_within_a_factor_of_one_and_a_half() -> None:
    compared = compare(DATA / "utd-mhad")
    assert len(compared) > 100
    off = [f"{one.name} of {one.on}: {one.ratio:.2f}" for one in compared if not one.within]
    assert off == []
