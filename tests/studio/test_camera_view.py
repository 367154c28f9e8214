"""What a tab shows of a camera, looked at in Chromium."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType

import cv2
import numpy as np
import pytest
import trimesh
from browser import chromium, tab
from inhand_studio.camera_view import CameraView
from inhand_studio.scene_parts import add_object
from inhand_studio.server import serving
from inhand_studio.studio import Studio
from inhand_studio.visit import Visit
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.shape.shape import ObjectShape
from playwright.sync_api import Page
from running_rig import eventually

CAMERA = Intrinsics(525.0, 515.0, 300.0, 250.0, 640, 480)
PLACE = np.array([-0.35, 0.2, 1.5])
BOX = trimesh.creation.box((0.2, 0.3, 0.1))
SHAPE = ObjectShape(
    "box",
    np.asarray(BOX.vertices),
    np.asarray(BOX.faces),
    np.zeros((3, 3)),
    np.array([1.0, 0.0, 0.0]),
)


def _image_of_the_box() -> np.ndarray:
    """Draw its silhouette green on grey, as the camera sees it."""
    image = np.full((480, 640, 3), 60, np.uint8)
    corners = CAMERA.project(SHAPE.vertices + PLACE)
    hull = cv2.convexHull(np.rint(corners).astype(np.int32))
    cv2.fillConvexPoly(image, hull, (0, 255, 0))
    return image


@contextmanager
def _shown(monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[CameraView, Page]]:
    """Show the silhouette with the box's mesh, pink, over it."""
    views: list[CameraView] = []

    class Shown:
        def __init__(self, visit: Visit) -> None:
            view = CameraView(visit, CAMERA)
            view.show(_image_of_the_box())
            add_object(visit.client.scene, "/box", SHAPE, (255, 0, 255), 1.0).position = PLACE
            visit.command("the box", "Z", lambda _: view.look_through(PLACE, 0.25))
            views.append(view)

        def close(self) -> None:
            """Nothing runs."""

    module = ModuleType("shown_page")
    module.open_page = Shown  # type: ignore[attr-defined]
    monkeypatch.setitem(__import__("sys").modules, "shown_page", module)
    pages = {"Shown": "shown_page"}
    with (
        serving("127.0.0.1", 0, lambda one: Visit(one, Studio(Path()), pages, "Shown")) as port,
        chromium() as browser,
        tab(browser, f"http://127.0.0.1:{port}") as page,
    ):
        eventually("a page", lambda: views)
        yield views[0], page


def _pixels(page: Page) -> tuple[int, int]:
    """Count the pixels in which the mesh, and the image's silhouette, are seen."""
    seen = cv2.imdecode(np.frombuffer(page.screenshot(), np.uint8), cv2.IMREAD_COLOR).astype(int)
    green, red = seen[..., 1], seen[..., 2]
    return int(((red > 100) & (green < 60)).sum()), int(((green > 150) & (red < 60)).sum())


@pytest.mark.long
def test_an_object_covers_its_image_and_turning_the_scene_takes_the_image_away(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with _shown(monkeypatch) as (view, page):
        mesh = eventually("the mesh", lambda: _pixels(page)[0])
        assert _pixels(page)[1] < 0.05 * mesh

        page.mouse.click(400, 700)
        page.keyboard.press("z")
        near = eventually("a nearer look", lambda: (n := _pixels(page)[0]) > 4 * mesh and n)
        assert _pixels(page)[1] < 0.03 * near

        page.mouse.move(400, 700)
        page.mouse.down()
        page.mouse.move(500, 740, steps=4)
        page.mouse.up()
        eventually("the scene without the image", lambda: not view.inside)
        page.keyboard.press("z")
        eventually("the image again", lambda: view.inside and _pixels(page)[0] > 4 * mesh)
        assert _pixels(page)[1] < 0.03 * near
