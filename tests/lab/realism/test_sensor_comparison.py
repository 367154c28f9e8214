"""The comparison of simulated sensors with real ones."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.realism.depth_properties import DepthPair, depth_properties, measure_pair
from inhand_lab.realism.measured_people import MeasuredPerson
from inhand_lab.realism.parameters import DEFAULT_REALISM
from inhand_lab.realism.sensor_comparison import (
    LEFT_OUT,
    SensorComparison,
    compare_sensors,
    property_intervals,
    sensor_properties,
)
from inhand_lab.realism.skeleton_properties import (
    ObservedSkeletons,
    SensorProperty,
    hand_bends,
    skeleton_properties,
)
from inhand_schemas.joints import PARENTS, Joint
from inhand_tracker.geometry.arrays import Array
from numpy.typing import NDArray
from real_data import DATA

from inhand.__main__ import main

needs_real_data = pytest.mark.skipif(
    not (DATA / "utd-mhad").is_dir(), reason=f"the real data are not on this machine: no {DATA}"
)


def skeletons(trembling: float, seed: int = 0, drift: float = 0.0) -> list[Array]:
    """A doll that rests but for what is asked for, in metres a frame."""
    random = np.random.default_rng(seed)
    doll = np.zeros((20, 3))
    for joint, parent in enumerate(PARENTS):
        if parent >= 0:
            doll[joint] = doll[parent] + (0.0, 0.1 + 0.01 * joint, 0.0)
    still = np.repeat(doll[None], 900, axis=0)
    still += drift * np.arange(900)[:, None, None] * np.array([1.0, 0.0, 0.0])
    return [still + trembling * random.normal(size=still.shape) for _ in range(2)]


def measured(recordings: list[Array]) -> list[SensorProperty]:
    """Figures of one person's recordings."""
    return skeleton_properties([[ObservedSkeletons.of(joints) for joints in recordings]])


def value(figures: list[SensorProperty], name: str, on: str) -> float:
    (found,) = [one.value for one in figures if (one.name, one.on) == (name, on)]
    return found


def test_the_figures_of_any_recordings_are_the_same_properties() -> None:
    one, other = (measured(skeletons(size)) for size in (0.0005, 0.003))
    assert [(a.name, a.on) for a in one] == [(b.name, b.on) for b in other]


def test_jitter_grows_as_the_trembling_does() -> None:
    small, large = (
        value(measured(skeletons(size)), "head jitter, median", "still head")
        for size in (0.0003, 0.0006)
    )
    assert large == pytest.approx(2.0 * small, rel=0.05)
    assert small == pytest.approx(1.54 * np.sqrt(6.0) * 0.3, rel=0.05)


def test_a_drift_is_measured_apart_from_a_tremble() -> None:
    name, on = "wrist drift over jitter", "still wrist"
    assert value(measured(skeletons(0.0005)), name, on) == pytest.approx(1.0, abs=0.1)
    drifting = measured(skeletons(1e-6, drift=0.001))
    assert value(drifting, name, on) == pytest.approx(8.0, rel=0.05)


def test_what_was_never_recorded_is_no_number() -> None:
    assert np.isnan(value(measured(skeletons(0.0)), "hand turned by 90°", "fast wrist"))


def test_bones_that_change_between_stretches_are_measured_apart_from_bones_that_tremble() -> None:
    name, on = "head bone, deviation between stretches", "1.5 s of one person"
    steady = skeletons(0.0)[0]
    longer = steady.copy()
    up = steady[:, Joint.HEAD] - steady[:, PARENTS[Joint.HEAD]]
    longer[450:, Joint.HEAD] += 0.02 * up[450:] / np.linalg.norm(up[450:], axis=1, keepdims=True)
    assert value(measured([steady, steady]), name, on) == pytest.approx(0.0, abs=1e-6)
    assert value(measured([longer]), name, on) == pytest.approx(10.0, rel=0.1)
    other = [[ObservedSkeletons.of(steady)], [ObservedSkeletons.of(longer[450:])]]
    assert value(skeleton_properties(other), name, on) == pytest.approx(0.0, abs=1e-6)


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


def depth_figures(noise: float, step: int) -> list[SensorProperty]:
    return depth_properties([measure_pair(pair) for pair in depth_pairs(noise, step)])


def test_depth_figures_follow_steps_and_noise() -> None:
    fine, rough = (depth_figures(noise, 1) for noise in (2.0, 8.0))
    for name, on, real in (
        ("depth roughness", "chest, less its curvature", 8.0),
        ("depth deviation in time", "resting chest", 8.0),
    ):
        assert value(rough, name, on) == pytest.approx(real, rel=0.15)
        assert value(fine, name, on) == pytest.approx(real / 4.0, rel=0.15)
    coarse = depth_figures(8.0, 16)
    ratio = value(coarse, "depth step over squared distance", "2.0 to 2.7 m")
    assert ratio == pytest.approx(16.0 / 2.5**2, rel=0.05)
    assert value(coarse, "ragged pixels", "person's outline") < 5.0


def test_holes_are_counted_with_and_without_a_hand_before_the_trunk() -> None:
    pair = depth_pairs(2.0, 1)[0]
    pair.depths[0][100:110, 150:170] = 0
    joints = pair.joints[0].copy()
    joints[Joint.HAND_LEFT] = 0.0, 0.0, 2.1
    before = replace(pair, joints=(joints, joints))
    seen = depth_properties([measure_pair(pair)])
    assert value(seen, "holes", "trunk that faces the camera") > 1.0
    assert np.isnan(value(seen, "holes", "trunk behind a hand"))
    assert value(depth_properties([measure_pair(before)]), "holes", "trunk behind a hand") > 1.0


def compared_with(simulated: float, lowest: float = 1.8, highest: float = 2.2) -> SensorComparison:
    """A property whose real figure is 2."""
    return SensorComparison("x", "mm", "all", 2.0, lowest, highest, simulated)


def test_a_ratio_is_within_the_factor_either_way() -> None:
    for simulated, expected in ((2.9, True), (3.1, False), (1.4, True), (1.3, False)):
        assert compared_with(simulated).within is expected
    assert not compared_with(np.nan).within


def test_a_property_is_judged_where_other_people_would_give_nearly_the_same() -> None:
    assert compared_with(2.0, 1.4, 2.9).judged
    for lowest, highest in ((1.3, 2.2), (1.8, 3.1), (0.0, 2.2), (1.8, np.inf)):
        assert not compared_with(2.0, lowest, highest).judged
    assert not SensorComparison("x", "", "all", np.nan, 0.0, np.inf, 1.0).judged
    assert not SensorComparison("x", "", "all", 0.0, 0.0, 0.0, 1.0).judged


def people(spread: float) -> list[MeasuredPerson]:
    """Eight dolls that tremble, some more than others."""
    sizes = 0.0005 * np.exp(spread * np.linspace(-1.0, 1.0, 8))
    depth = [measure_pair(pair) for pair in depth_pairs(2.0, 1)[:1]]
    return [
        MeasuredPerson(
            [ObservedSkeletons.of(skeletons(size, seed)[0][:200])], depth, np.full(20, size)
        )
        for seed, size in enumerate(sizes)
    ]


def test_the_interval_is_wide_where_people_differ() -> None:
    parameters = replace(DEFAULT_REALISM, resamples=20)
    for spread, narrow in ((0.02, True), (1.5, False)):
        recorded = people(spread)
        lowest, highest = property_intervals(recorded, parameters)
        names = [(one.name, one.on) for one in sensor_properties(recorded)]
        row = names.index(("head jitter, median", "still head"))
        real = sensor_properties(recorded)[row].value
        assert lowest[row] <= real <= highest[row]
        ratio = float(highest[row] / lowest[row])
        assert ratio < 1.2 if narrow else ratio > 1.5


def test_a_folder_without_recordings_is_named(tmp_path: Path) -> None:
    with pytest.raises(DatasetError, match="--data"):
        compare_sensors(tmp_path, seed=0)


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
        SensorComparison("jitter", "mm", "still head", 1.0, 0.9, 1.2, 1.2),
        SensorComparison("flips", "", "fast wrist", 1.0, 0.9, 1.2, np.nan),
        SensorComparison("holes", "%", "trunk", 1.0, 0.1, 9.0, 7.0),
    ]
    monkeypatch.setattr("inhand.realism.compare_sensors", lambda *_: compared)
    result = tmp_path / "realism.json"
    assert main(["simulate", "--realism", "--data", str(tmp_path), "--json", str(result)]) == 1
    shown = capsys.readouterr()
    assert "still head" in shown.out
    assert "too few people to tell" in shown.out
    assert "Knowingly left out" in shown.out
    assert "1 of 2" in shown.err
    written = json.loads(result.read_text())
    assert written["within"] == DEFAULT_REALISM.within
    assert [one["ratio"] for one in written["properties"]] == [1.2, None, 7.0]
    assert [one["judged"] for one in written["properties"]] == [True, True, False]
    assert written["left_out"] == list(LEFT_OUT)


@pytest.mark.long
@needs_real_data
@pytest.mark.exhaustive
def test_what_is_known_of_real_sensors_is_within_a_factor() -> None:
    fewer = replace(DEFAULT_REALISM, resamples=12)
    compared = compare_sensors(DATA / "utd-mhad", seed=0, parameters=fewer)
    judged = [one for one in compared if one.judged]
    assert len(judged) > 110
    off = [f"{one.name} of {one.on}: {one.ratio:.2f}" for one in judged if not one.within]
    assert off == []
