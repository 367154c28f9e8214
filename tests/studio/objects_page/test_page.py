"""The objects page of a studio, in Chromium."""

from pathlib import Path

import cv2
import numpy as np
import pytest
import trimesh
from browser import choose, chromium, fill, tab
from inhand_runtime.errors import InhandError
from inhand_studio.objects_page.wishes import (
    AS_FOUND,
    ByCamera,
    ByMeasures,
    ByMesh,
    Wishes,
    object_arguments,
)
from inhand_tracker.shape.shape import load_shape
from playwright.sync_api import Page
from running_rig import RunningRig, eventually


def test_wishes_become_the_options_of_the_verb_and_what_is_not_given_is_asked_for() -> None:
    mesh = ByMesh(Path("/x/a.stl"), "mm", 0.0, "-y")
    assert object_arguments(Wishes("--can", mesh, "z", "x"), Path("/data")) == [
        *("object", "new", "--dataset=/data", "--mesh=/x/a.stl", "--unit=mm", "--up=-y"),
        *("--symmetry=z", "--mirror=x", "--", "--can"),
    ]
    by_measures = Wishes("can", ByMeasures("paddle", {"blade_length": 9.5}))
    assert "--blade-length=9.5" in object_arguments(by_measures, Path("/data"))
    as_found = Wishes("can", ByMesh(Path("a.glb"), AS_FOUND, 0.0, AS_FOUND))
    assert not {"--unit", "--up"} & {
        one.split("=")[0] for one in object_arguments(as_found, Path())
    }
    for wishes, asked in (
        (Wishes(" ", ByMeasures("can", {})), "a name"),
        (Wishes("can", ByMesh(None, "mm", 0.0, "z")), "upload a mesh"),
        (Wishes("can", ByCamera(None)), "no recording"),
    ):
        with pytest.raises(InhandError, match=asked):
            object_arguments(wishes, Path())


def _drawn(page: Page) -> bool:
    """Whether an object is seen."""
    seen = cv2.imdecode(np.frombuffer(page.screenshot(), np.uint8), cv2.IMREAD_COLOR)[:, :800]
    red, blue = seen[..., 2].astype(int), seen[..., 0].astype(int)
    return int((blue > red + 40).sum()) > 2000


def _face(page: Page) -> list[tuple[float, float]]:
    """Three places within the object, far apart."""
    seen = cv2.imdecode(np.frombuffer(page.screenshot(), np.uint8), cv2.IMREAD_COLOR)
    blue = seen[..., 0].astype(int) > seen[..., 2].astype(int) + 40
    blue[:, :350] = blue[:, 800:] = False  # notifications and the panel
    rows, columns = np.nonzero(blue)
    x, y, wide, high = columns.mean(), rows.mean(), np.ptp(columns), np.ptp(rows)
    return [(x + 0.2 * wide, y), (x - 0.2 * wide, y), (x, y + 0.2 * high)]


@pytest.mark.long
def test_objects_of_measures_and_of_a_mesh_file_are_made_seen_and_saved(
    rig: RunningRig, tmp_path: Path
) -> None:
    dataset, file = tmp_path / "dataset", tmp_path / "Thing 1.STL"
    trimesh.creation.cylinder(40.0, 120.0).export(file, file_type="stl")
    rig.configure(f'[studio.desk]\ndataset = "{dataset}"\nport = 0\n')
    studio = rig.inhand("studio", "--config", rig.config)
    studio.said("the studio is at ")
    url = studio.stderr.split("the studio is at ")[1].split()[0]
    with chromium() as browser, tab(browser, url) as page:
        page.get_by_text("Objects", exact=True).click()
        make = page.get_by_role("button", name="Make and show")
        save = page.get_by_role("button", name="Save to the dataset")
        make.click()
        page.get_by_text("give the object a name").wait_for()
        fill(page, "Name", "my_mug")
        for measure, value in (("Height", "9.5"), ("Diameter", "8"), ("Handle", "2.5")):
            fill(page, f"{measure}, cm", value)
        make.click()
        save.click()
        page.get_by_text("saved ").wait_for()
        eventually("the mug", lambda: _drawn(page))
        page.screenshot(path=str(tmp_path / "mug.png"))

        choose(page, "Kind", "box")
        page.get_by_text("Depth, cm", exact=True).wait_for()  # the last of its measures
        fill(page, "Name", "tea")
        for measure in ("Height", "Width", "Depth"):
            fill(page, f"{measure}, cm", "10")
        make.click()
        page.get_by_role("button", name="Choose other marks").click()
        page.get_by_text("0 so far").wait_for()
        use = page.get_by_role("button", name="Use these marks")
        use.click()
        page.get_by_text("click on 3 points of the object or more", exact=True).wait_for()
        for number, place in enumerate(_face(page), 1):
            page.mouse.click(*place)
            page.get_by_text(f"{number} so far").wait_for()
        page.screenshot(path=str(tmp_path / "marks.png"))
        use.click()
        page.get_by_text("3 marked vertices").wait_for()
        save.click()
        page.get_by_text("objects/tea").wait_for()

        choose(page, "Make it of", "a mesh file")
        fill(page, "Name", "can")
        with page.expect_file_chooser() as chooser:
            page.get_by_role("button", name="Upload a mesh file").click()
        chooser.value.set_files(file)
        page.get_by_text("bytes are here").wait_for()
        make.click()
        page.get_by_text("does not say which points up: add Points up z").wait_for()
        choose(page, "Unit", "mm")
        choose(page, "Points up", "z")
        make.click()
        page.get_by_text("turned about z by any angle").wait_for()
        save.click()
        page.get_by_text("saved ").wait_for()
        page.screenshot(path=str(tmp_path / "can.png"))
        choose(page, "Object", "my_mug")
        page.get_by_text("my_mug: 8.0 × 10.5 × 9.5 cm").wait_for()
    assert np.ptp(load_shape(dataset / "objects/can").vertices, axis=0)[2] == pytest.approx(0.12)
    assert load_shape(dataset / "objects/my_mug").name == "my_mug"
    marks = load_shape(dataset / "objects/tea").marked_vertices
    assert len(marks) == 3
    np.testing.assert_allclose(np.abs(marks).max(axis=1), 0.05, atol=1e-4)  # on the box's faces
    assert np.ptp(marks, axis=0).max() > 0.02
    assert studio.stop() == 0
    assert "Traceback" not in studio.stderr
    eventually("nothing else", lambda: [one.name for one in dataset.iterdir()] == ["objects"])
