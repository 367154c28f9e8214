"""What can be known of a tracker before a start is checked before a start."""

import os
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import pytest
from inhand_runtime.errors import SettingsError
from inhand_runtime.rig_calibration import CameraCalibration, RigCalibration, write_rig_calibration
from inhand_runtime.settings import load_settings
from inhand_schemas.messages import Pose
from inhand_tracker import load_model
from inhand_tracker.loading import check
from inhand_tracker.model.model_file import save_model
from inhand_tracker.people.following import PeopleWatched
from inhand_tracker.people.watching import CameraFrame, Watcher
from inhand_tracker.recognition.recogniser_file import load_recogniser
from inhand_tracker.settings import TrackerSettings
from people import person, wave_model

CAMERA = '[capture.front]\nsource = "simulator"\n'


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a model, and with a text of another kind."""
    save_model(wave_model(), tmp_path / "wave.model")
    (tmp_path / "notes.txt").write_text("a text")
    return tmp_path


def checked(folder: Path, tracker: str, more: str = CAMERA) -> Watcher:
    config = folder / "rig.toml"
    config.write_text(f"[tracker.mug]\n{tracker}\n{more}")
    return check(load_settings(config, "tracker", TrackerSettings))


RIG = CAMERA + '[capture.left]\nsource = "simulator"\n'


@pytest.mark.parametrize(
    ("tracker", "reason"),
    [
        (
            'cameras = ["front", "lft"]',
            r"there is no table \[capture\.lft\] \(did you mean left\?\)",
        ),
        ('cameras = ["front", "front"]', "one is named twice"),
        ("cameras = []", "name two or more in it, or one in camera"),
        ('cameras = ["front"]', "name two or more in it, or one in camera"),
        ('camera = "front"\ncameras = ["front", "left"]', "and leave camera out"),
        ('cameras = ["front", "left"]\nmethod = "gd-hand"', "gd-hand takes one camera"),
        ('camera = "front"\ncalibration = "notes.txt"', "it is for several cameras"),
        ('cameras = ["front", "left"]\ncalibration = "cameras.toml"', "does not say where left is"),
        ('cameras = ["front", "left"]\ncalibration = "nowhere.toml"', r"nowhere\.toml"),
    ],
)
def test_cameras_that_cannot_track_together_are_refused(
    folder: Path, tracker: str, reason: str
) -> None:
    there = CameraCalibration(
        Pose((0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0)),
        (0.01,) * 3,
        (0.01,) * 3,
        "board",
        datetime.now(UTC),
    )
    write_rig_calibration(folder / "cameras.toml", RigCalibration({"front": there}))
    with pytest.raises(SettingsError, match=reason):
        checked(folder, tracker + '\nmodel = "wave.model"', RIG)


@pytest.mark.parametrize("absent", [(), (0, 1, 12, 16)])
def test_people_without_hips_are_watched_where_the_model_was_learned_from_such(
    folder: Path, absent: tuple[int, ...]
) -> None:
    model = wave_model()
    upper = replace(model, mapping=replace(model.mapping, absent_joints=absent))
    save_model(upper, folder / "upper.model")
    watcher = checked(folder, 'camera = "front"\nmodel = "upper.model"')
    assert watcher.needs_hips == (not absent)
    people = PeopleWatched(lambda: watcher, 1)
    seated = person(1, missing=(0, 1, 12, 16))
    numbers = people.see([seated], CameraFrame(0), lambda *_: None)
    assert (None in numbers) == (not absent)


@pytest.mark.parametrize(
    ("tracker", "line"),
    [
        ('camera = "front"', r"^\[tracker.mug\] names no model: write model = "),
        (
            'camera = "frnt"\nmodel = "wave.model"',
            r"rig\.toml:2: setting tracker\.mug\.camera: "
            r"there is no table \[capture\.frnt\] \(did you mean front\?\)$",
        ),
        (
            'model = "wave.model"',
            r"setting tracker\.mug\.camera: there is no table \[capture\.camera\]",
        ),
        (
            'camera = "front"\nmodel = "none.model"',
            r"rig\.toml:3: setting tracker\.mug\.model: .*none\.model does not exist: "
            r"check the path; `inhand train` makes it$",
        ),
        (
            'camera = "front"\nmodel = "notes.txt"',
            r"^\[tracker\.mug\]: .*notes\.txt is no Inhand model: make one with `inhand train`$",
        ),
        (
            'camera = "front"\nmodel = "wave.model"\nrecogniser = "none"',
            r"rig\.toml:4: setting tracker\.mug\.recogniser: .*none does not exist: ",
        ),
        (
            'camera = "front"\nmodel = "wave.model"\nrecogniser = "wave.model"',
            r"^\[tracker\.mug\]: .*wave\.model is no Inhand recogniser: ",
        ),
        (
            'camera = "front"\nmodel = "wave.model"\nmethod = "fuson"',
            r"rig\.toml:4: setting tracker\.mug\.method: "
            r"there is no 'fuson' \(did you mean fusion\?\)$",
        ),
    ],
)
def test_what_cannot_work_is_refused(folder: Path, tracker: str, line: str) -> None:
    with pytest.raises(SettingsError, match=line):
        checked(folder, tracker)


@pytest.mark.parametrize("more", ["", CAMERA + '[zenoh]\nconnect = ["tcp/10.0.0.1:7447"]\n'])
def test_a_camera_of_elsewhere_is_allowed(folder: Path, more: str) -> None:
    assert checked(folder, 'camera = "side"\nmodel = "wave.model"', more).names == ("wedge",)


def test_models_are_found_beside_the_settings(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir("/")
    assert checked(folder, 'camera = "front"\nmodel = "wave.model"').names == ("wedge",)


def test_files_may_be_named_by_text(folder: Path) -> None:
    path = os.fspath(folder / "wave.model")
    save_model(load_model(path), os.fspath(folder / "again.model"))
    assert load_model(os.fspath(folder / "again.model")).shape.name == "wedge"
    with pytest.raises(Exception, match="is no Inhand recogniser"):
        load_recogniser(path)
