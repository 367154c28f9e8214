"""A person labels a recording on the page, in Chromium."""

import re
import signal
from pathlib import Path

import numpy as np
import pytest
from browser import WINDOW, chromium, tab
from inhand_lab.datasets.dataset import load_dataset
from inhand_lab.labelling.keyframes import load_keyframes
from inhand_studio.clicked_point import point_on
from inhand_studio.eye import whole_eye
from inhand_studio.labelling_page.autosave import keyframes_path
from inhand_studio.labelling_page.opened import OpenedRecording
from inhand_studio.scene_parts import UPRIGHT
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.camera import Intrinsics, intrinsics_of
from inhand_tracker.shape.shape import load_shape
from labelling_person import LabellingPerson, labelling
from running_rig import eventually

from inhand.__main__ import main

SIMULATED = ["--interactions", "drinkFromMug", "--participants", "2", "--frames", "40"]


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("simulated") / "dataset"
    assert main(["simulate", str(folder), *SIMULATED, "--seed", "7"]) == 0
    return folder / "recordings" / "drinkFromMug_p00.mcap"


def _saved(recording: Path) -> dict[int, np.ndarray | None]:
    """Return the places in keyframes on the disk by their frames."""
    path = keyframes_path(recording, "mug")
    keyframes = load_keyframes(path).keyframes if path.exists() else ()
    return {one.frame: None if one.pose is None else one.pose[0] for one in keyframes}


@pytest.mark.long
def test_what_a_person_sets_is_saved_at_once_survives_a_kill_and_trains(recording: Path) -> None:
    with chromium() as browser:
        with labelling(recording) as (url, process), tab(browser, url) as page:
            person = LabellingPerson(page)
            person.type_pose(np.array([-0.2, -0.1, 2.3]), UPRIGHT)
            eventually("the first keyframe", lambda: 0 in _saved(recording))
            np.testing.assert_allclose(_saved(recording)[0], [-0.2, -0.1, 2.3], atol=1e-4)

            person.press("l", "Shift+L", "Shift+I")
            moved = [-0.189, -0.101, 2.3]
            eventually("nudges", lambda: np.allclose(_saved(recording)[0], moved, atol=1e-6))
            person.press("Control+z")
            back = [-0.189, -0.1, 2.3]
            eventually("undo", lambda: np.allclose(_saved(recording)[0], back, atol=1e-6))
            person.press("Control+y")
            eventually("redo", lambda: np.allclose(_saved(recording)[0], moved, atol=1e-6))

            person.press("v")
            _drag_handles(person)
            eventually("a drag", lambda: np.linalg.norm(_saved(recording)[0] - moved) > 0.005)
            dragged = _saved(recording)[0]

            person.press("Shift+X", "x", "n")
            person.press("End", "c", "PageUp", "PageUp")
            eventually("three keyframes", lambda: sorted(_saved(recording)) == [0, 11, 39])
            eventually("the first", lambda: person.frame == 0)
            person.press("p")
            eventually("it plays", lambda: person.frame > 0)
            eventually("it ends", lambda: person.frame == 39)
            process.send_signal(signal.SIGKILL)
            process.wait()

        with labelling(recording) as (url, _), tab(browser, url) as page:
            person = LabellingPerson(page)
            assert "3 keyframes, saved" in person.status
            np.testing.assert_array_equal(_saved(recording)[0], dragged)
            with tab(browser, url) as second:
                other = LabellingPerson(second)
                assert "Read only" in other.status
                other.click("Take over")
                eventually("the other's", lambda: "Read only" not in other.status)
                eventually("what the first is told", lambda: "Read only" in person.status)
                other.press("m")
                eventually("an absence", lambda: _saved(recording)[0] is None)
                other.press("Control+z")
                _export(other)
        entries = load_dataset(recording.parent.parent).entries
        assert entries[0].file == "recordings/drinkFromMug_p00.labelled.mcap"
        dataset, model = recording.parent.parent, recording.parent.parent / "model"
        assert main(["train", str(dataset), "-o", str(model)]) == 0


@pytest.mark.long
def test_three_clicks_and_the_image_place_the_object_and_refine_between(recording: Path) -> None:
    recording = recording.with_name("drinkFromMug_p01.mcap")
    opened = OpenedRecording(recording)
    assert opened.info is not None
    camera, shape = intrinsics_of(opened.info), load_shape(recording.parents[1] / "objects" / "mug")
    truth = opened.label("mug", 0)
    assert truth is not None
    turned = rotations.multiply(rotations.from_vector(np.array([0.0, 0.15, 0.1])), truth[1])
    away = truth[0] + np.array([-0.25, -0.1, -0.1]), turned
    pixels = camera.project(truth[0]) + np.array([(-4.0, -7.0), (5.0, -5.0), (0.0, 8.0)])
    points = [
        point_on(shape, truth, np.zeros(3), ray)
        for ray in camera.unproject(np.asarray(pixels), np.ones(3))
    ]
    with labelling(recording) as (url, _), chromium() as browser, tab(browser, url) as page:
        person = LabellingPerson(page)
        person.click("Live")
        person.wait_for("looks at no rig")
        person.click("Label")
        person = LabellingPerson(page)
        names = page.get_by_text("Live", exact=True)
        assert names.count() == 1, "what could not be opened stays beside the next page"
        person.type_pose(*away)
        person.press("8")
        for number, point in enumerate(points, 1):
            for pose, asked in ((away, "point"), (truth, "where point")):
                person.wait_for(f"Click on {asked} {number}")
                page.wait_for_timeout(500)
                page.mouse.click(*_place_of(rotations.rotate(pose[1], point) + pose[0], camera))
        person.wait_for("The image moved it")
        placed = _saved(recording)[0]
        assert np.linalg.norm(placed - truth[0]) < 0.01

        person.press("End", "c", "9")
        person.wait_for("Least sure is frame")
        person.press("0")
        eventually("a refined frame", lambda: re.search("s: refined: it may be", person.status))
        person.press("n")
        eventually("it is kept", lambda: len(_saved(recording)) == 3)


def _place_of(point: np.ndarray, camera: Intrinsics) -> tuple[float, float]:
    """Return where a point is seen in a window that shows all of the picture."""
    lens = whole_eye(camera, WINDOW[0] / WINDOW[1], WINDOW[1]).lens
    x, y = lens.project(point).tolist()
    return x, y


def _drag_handles(person: LabellingPerson) -> None:
    """Drag the square between two arrows, which moves the object in the picture's plane."""
    page = person.page
    page.wait_for_timeout(1500)
    page.mouse.move(700, 460)
    page.mouse.down()
    page.mouse.move(720, 480, steps=4)
    page.mouse.move(740, 500, steps=4)
    page.mouse.up()


def _export(person: LabellingPerson) -> None:
    person.click("Write labels")
    eventually("what is there", lambda: re.search("has labels of mug already", person.status))
    person.tick("Replace what is there")
    person.click("Write labels")
    eventually("the labels", lambda: "dataset.toml names it" in person.status)
