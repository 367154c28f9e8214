"""Datasets of simulated people, and the contact sheet."""

from pathlib import Path

import cv2
import numpy as np
import pytest
from inhand_lab.datasets.dataset import Dataset, load_dataset
from inhand_lab.datasets.generation import GenerationSettings, generate
from inhand_lab.datasets.labelled_sequence import labelled_sequence
from inhand_lab.datasets.recorded_frames import load_frames
from inhand_lab.people.person import PEOPLE
from inhand_lab.sensing.cameras import CAMERAS, KINECT
from inhand_lab.world.sheet import HEIGHT, NAME_WIDTH, PICTURES, WIDTH, write_sheet
from inhand_lab.world.simulation import Casting, simulate, simulate_cast
from inhand_runtime.errors import InhandError
from inhand_schemas.joints import Joint

from inhand.__main__ import main

FRAMES = 12


def generated(folder: Path, *, images: bool = False, frames: int = FRAMES) -> Dataset:
    return generate(
        folder, GenerationSettings(["drinkFromMug"], 2, 5, frames, images=images), lambda: None
    )


def test_the_same_seed_writes_the_same_bytes(tmp_path: Path) -> None:
    first, second = (generated(tmp_path / name, images=True) for name in ("first", "second"))
    files = sorted(path for path in first.folder.rglob("*") if path.is_file())
    assert len(files) > 3
    for path in files:
        other = second.folder / path.relative_to(first.folder)
        assert path.read_bytes() == other.read_bytes(), path.name


def test_cameras_of_a_dataset_stand_where_its_views_say(tmp_path: Path) -> None:
    settings = GenerationSettings(["drinkFromMug"], 6, 5, FRAMES, images=False, views="around")
    around = generate(tmp_path / "around", settings, lambda: None)
    folder = tmp_path / "command"
    options = ("--interactions", "drinkFromMug", "--participants", "6", "--seed", "5")
    more = ("--frames", str(FRAMES), "--no-images", "--views", "around")
    assert main(["simulate", str(folder), *options, *more]) == 0
    for file in ("dataset.toml", around.entries[0].file):
        assert (around.folder / file).read_bytes() == (folder / file).read_bytes()
    sequences = [labelled_sequence(around, entry) for entry in around.entries]
    right, left = (
        np.array([one.joints[0, joint, 0] for one in sequences])
        for joint in (Joint.SHOULDER_RIGHT, Joint.SHOULDER_LEFT)
    )
    assert set(np.sign(left - right)) == {-1.0, 1.0}
    assert main(["simulate", "--sheet", str(tmp_path / "x.png"), "--views", "around"]) == 2


def test_people_of_a_dataset_are_those_that_were_asked_for(tmp_path: Path) -> None:
    folder = tmp_path / "people"
    options = ("--interactions", "drinkFromMug", "--participants", "1", "--seed", "5")
    more = ("--frames", str(FRAMES), "--no-images", "--people", "varied")
    assert main(["simulate", str(folder), *options, *more]) == 0
    assert 'people = "varied"' in (folder / "dataset.toml").read_text()
    varied = load_dataset(folder)
    label = load_frames(varied.path(varied.entries[0]), "mug")[0].label
    assert label is not None
    joints, usual = np.array(label.person_joints), simulate("drinkFromMug", 0, 5, FRAMES)
    bodies = [
        simulate_cast(Casting("drinkFromMug", 0, 5, people=people), FRAMES, KINECT)
        for people in PEOPLE
    ]
    assert np.array_equal(bodies[0].true_joints_in_camera, usual.true_joints_in_camera[:FRAMES])
    assert np.allclose(joints, bodies[1].true_joints_in_camera[0])
    assert np.abs(joints - usual.true_joints_in_camera[0]).max() > 0.01
    assert main(["simulate", "--sheet", str(tmp_path / "x.png"), "--people", "varied"]) == 2


def test_every_label_tells_the_whole_truth(tmp_path: Path) -> None:
    dataset = generated(tmp_path / "people", frames=200)
    simulation = simulate("drinkFromMug", 1, 5, 200)
    frames = load_frames(dataset.path(dataset.entries[1]), "mug")
    assert len(frames) == 200
    assert {frame.convention for frame in frames} == {"simulated"}
    for number in range(0, 200, 40):
        label = frames[number].label
        assert label is not None
        assert label.visible_fraction == pytest.approx(simulation.visible_fraction(number))
        assert label.contact in ("resting", "right_hand", "left_hand")
        joints = np.array(label.person_joints)
        assert np.allclose(joints, simulation.true_joints_in_camera[number])
    assert len({frame.label.contact for frame in frames if frame.label}) == 2


def test_the_truth_is_the_same_with_and_without_images(tmp_path: Path) -> None:
    plain, drawn = (generated(tmp_path / str(images), images=images) for images in (False, True))
    for one, other in zip(plain.entries, drawn.entries, strict=True):
        assert load_frames(plain.path(one), "mug") == load_frames(drawn.path(other), "mug")


def test_training_is_given_the_measured_joints(tmp_path: Path) -> None:
    dataset = generated(tmp_path / "people")
    simulation = simulate("drinkFromMug", 0, 5, FRAMES)
    joints = labelled_sequence(dataset, dataset.entries[0]).joints
    missing = simulation.joint_states == 0
    assert np.allclose(joints[~missing], simulation.joints_in_camera[~missing])
    assert not np.allclose(joints[~missing], simulation.true_joints_in_camera[~missing])


def test_a_dataset_says_how_it_was_made(tmp_path: Path) -> None:
    text = (generated(tmp_path / "people").folder / "dataset.toml").read_text()
    for setting in ("version = ", "seed = 5", "frames = 12", 'camera = "kinect"'):
        assert setting in text


@pytest.mark.parametrize("camera", CAMERAS)
def test_any_camera_can_be_chosen(tmp_path: Path, camera: str) -> None:
    options = ["--interactions", "drinkFromMug", "--participants", "1", "--frames", "2"]
    assert main(["simulate", str(tmp_path / "people"), *options, "--camera", camera]) == 0
    text = (tmp_path / "people" / "dataset.toml").read_text()
    assert f'camera = "{camera}"' in text


@pytest.mark.parametrize("suffix", [".png", ".jpg"])
def test_a_contact_sheet_has_a_row_an_interaction(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"sheet{suffix}"
    options = ["--interactions", "drinkFromMug", "sweepFloor", "--seed", "3"]
    assert main(["simulate", "--sheet", str(path), *options]) == 0
    sheet = cv2.imread(str(path))
    assert sheet is not None
    assert sheet.shape == (2 * HEIGHT, NAME_WIDTH + PICTURES * WIDTH, 3)
    rows = sheet[:, NAME_WIDTH:].reshape(2, HEIGHT, PICTURES, WIDTH, 3)
    shown = (rows < 250).any(axis=4).mean(axis=(1, 3))
    assert shown.min() > 0.8
    assert all(
        np.abs(rows[0, :, 0] - rows[0, :, number]).max() > 50 for number in range(1, PICTURES)
    )


def test_a_sheet_is_a_png_or_a_jpeg(tmp_path: Path) -> None:
    with pytest.raises(InhandError, match=r"\.png or \.jpg"):
        write_sheet(tmp_path / "sheet.gif", ["drinkFromMug"], 0, on_progress=lambda: None)


def test_simulating_into_nothing_is_wrong_usage(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["simulate"]) == 2
    assert "--sheet" in capsys.readouterr().err
