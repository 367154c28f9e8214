"""The real network on drawn people: what no drawn depth can show is whether it finds them."""

from pathlib import Path

import numpy as np
import pytest
from fetched_weights import use_weights
from inhand_capture.estimation.blazepose import BlazePose
from inhand_capture.estimation.detector import ANCHORS, anchor_centres
from inhand_capture.estimation.estimator import SkeletonEstimator
from inhand_capture.estimation.landmarks import LandmarkNetwork
from inhand_capture.estimation.regions import Region
from inhand_capture.estimation.weights import DETECTOR, LANDMARKS, WeightsError
from inhand_lab.benchmarks.estimated_skeletons import are_exchanged, joints_of
from inhand_lab.world.messages import camera_info
from inhand_lab.world.simulation import Simulation, simulate
from inhand_schemas.joints import Joint

pytestmark = pytest.mark.long
FRAMES = range(0, 30, 3)
HAMMERED = range(104, 144)
"""Frames in many of which the network takes this person's left for their right."""


@pytest.fixture
def folder(monkeypatch: pytest.MonkeyPatch) -> Path:
    return use_weights(monkeypatch, "full")


@pytest.fixture(scope="module")
def drinking() -> Simulation:
    return simulate("drinkFromMug", 0, seed=3, frames=30)


def test_a_drawn_person_is_found_at_once_followed_and_lifted(
    folder: Path, drinking: Simulation
) -> None:
    info = camera_info(drinking.intrinsics, 30.0)
    estimator = SkeletonEstimator(BlazePose("full", folder), info)
    distances = []
    for frame in FRAMES:
        shown = drinking.render(frame)
        (person,) = estimator.estimate(shown.colour, shown.depth, frame * 33_000_000)
        assert person.id == 0
        truth = drinking.true_joints_in_camera[frame]
        joints = np.array(person.joints)
        distances.append(np.linalg.norm(joints - truth, axis=1))
        across = [j[Joint.SHOULDER_LEFT] - j[Joint.SHOULDER_RIGHT] for j in (joints, truth)]
        assert across[0] @ across[1] > 0.0
    assert np.median(distances) < 0.04
    assert np.mean(np.array(distances) > 0.2) < 0.05


def test_sides_that_the_network_exchanges_in_many_frames_are_kept(folder: Path) -> None:
    hammering = simulate("hammerNail", 0, seed=5, frames=240)
    info = camera_info(hammering.intrinsics, 30.0)
    estimator = SkeletonEstimator(BlazePose("full", folder), info)
    exchanged, distances = 0, []
    for frame in HAMMERED:
        shown = hammering.render(frame)
        (person,) = estimator.estimate(shown.colour, shown.depth, frame * 33_333_333)
        truth = hammering.true_joints_in_camera[frame]
        joints = joints_of(person)
        distances.append(np.linalg.norm(joints - truth, axis=1))
        exchanged += are_exchanged(joints, truth)
    assert exchanged == 0
    assert np.nanmean(distances) < 0.06


def test_a_mirrored_look_at_a_mirrored_picture_finds_the_mirror_image(
    folder: Path, drinking: Simulation
) -> None:
    network = LandmarkNetwork(folder / LANDMARKS["full"].file)
    picture = drinking.render(0).colour
    hips = drinking.true_joints_in_camera[0, Joint.HIP_CENTER]
    x, y = 525.0 * hips[:2] / hips[2] + (319.5, 239.5)
    plain = network.find(picture, Region(x, y, 400.0, 0.1))
    mirrored_picture = np.ascontiguousarray(picture[:, ::-1])
    region = Region(picture.shape[1] - x, y, 400.0, -0.1)
    mirrored = network.find(mirrored_picture, region, mirrored=True)
    for left, right in ((11, 12), (12, 11), (15, 16), (27, 28), (32, 31)):
        there = mirrored.pixels[left]
        assert abs(picture.shape[1] - there[0] - plain.pixels[right, 0]) < 2.5
        assert abs(there[1] - plain.pixels[right, 1]) < 2.0
        np.testing.assert_allclose(
            mirrored.places[left] * [-1.0, 1.0, 1.0], plain.places[right], atol=0.02
        )


def test_two_people_are_both_found_and_nobody_in_an_empty_room(
    folder: Path, drinking: Simulation
) -> None:
    network = BlazePose("full", folder)
    assert network.find(np.full((480, 640, 3), 110, np.uint8)) == []
    one = drinking.render(0).colour
    hips = drinking.true_joints_in_camera[0, Joint.HIP_CENTER]
    middle = round(525.0 * hips[0] / hips[2] + 319.5)
    part = one[:, middle - 150 : middle + 150]
    two = np.concatenate([part, part[:, ::-1]], axis=1)
    for _ in range(31):
        found = network.find(np.ascontiguousarray(two))
    assert len(found) == 2
    places = sorted(person.pixels[Joint.HEAD, 0] for person in found)
    assert places[0] < 300 < places[1]


def test_weights_of_another_network_are_refused(folder: Path, tmp_path: Path) -> None:
    with pytest.raises(WeightsError, match="holds the weights of another network"):
        LandmarkNetwork(folder / DETECTOR.file)
    (tmp_path / "no.tflite").write_bytes(b"no network at all")
    with pytest.raises(WeightsError, match=r"no\.tflite is no network of LiteRT"):
        LandmarkNetwork(tmp_path / "no.tflite")


def test_anchors_cover_the_picture() -> None:
    centres = anchor_centres()
    assert centres.shape == (ANCHORS, 2) == (2254, 2)
    np.testing.assert_allclose(centres.mean(axis=0), 0.5)
    np.testing.assert_allclose(centres[[0, 1, 2]], np.array([[1, 1], [1, 1], [3, 1]]) / 56)
