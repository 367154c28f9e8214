"""The live page of a studio, looked at in Chromium."""

import itertools
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from urllib.parse import urlparse

import cv2
import numpy as np
import pytest
from browser import chromium, tab
from examples import PERSON
from inhand_runtime.pixels import encode_colour
from inhand_schemas.messages import CameraInfo, ObjectPose, Pose, RgbdFrame, Skeletons
from inhand_schemas.topics import INFO, POSE, RGBD, SKELETONS
from inhand_studio.live_page.hypotheses import stick_colours, sticks
from inhand_tracker.model.model_file import save_model
from people import wave_model
from playwright.sync_api import Page
from running_rig import Process, RunningRig, eventually
from wire import Wire

PERIOD_S = 0.1
PAINTED = (220, 30, 200)
STICK = (60, 70, 134)
PLACE = Pose((0.3, 0.1, 2.0), (1.0, 0.0, 0.0, 0.0))
INFO_OF_FRONT = CameraInfo(
    sequence=0, time_ns=1, width=64, height=48, fx=60.0, fy=60.0, cx=31.5, cy=23.5
)


class Publishing:
    """A camera that paints the whole picture, and a tracker as long as it is ``tracking``."""

    def __init__(self, wire: Wire) -> None:
        self._wire = wire
        self.tracking = True
        self.frames = wire.publisher(RGBD, "front")
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run)

    def __enter__(self) -> "Publishing":
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._stop.set()
        self._thread.join()

    def _run(self) -> None:
        wire = self._wire
        info, people = wire.publisher(INFO, "front"), wire.publisher(SKELETONS, "front")
        poses = wire.publisher(POSE, "mug")
        colour = encode_colour(np.full((48, 64, 3), PAINTED, np.uint8))
        info.put(INFO_OF_FRONT)
        for sequence in itertools.count():
            if self._stop.wait(PERIOD_S):
                return
            now_ns = time.time_ns()
            people.put(Skeletons(sequence=sequence, time_ns=now_ns, people=(PERSON,)))
            self.frames.put(RgbdFrame(sequence=sequence, time_ns=now_ns, colour=colour))
            if self.tracking:
                poses.put(
                    ObjectPose(
                        sequence=sequence,
                        time_ns=now_ns,
                        object="mug",
                        camera="front",
                        state="tracked",
                        confidence=0.875,
                        person=3,
                        camera_from_object=PLACE,
                    )
                )


@contextmanager
def _studio(rig: RunningRig) -> Iterator[str]:
    """A studio, and its address."""
    rig.configure(f'[studio.page]\ndataset = "{rig.folder}/dataset"\nport = 0\n')
    studio: Process = rig.inhand("studio", "--config", rig.config)
    studio.said("the studio is at ")
    yield studio.stderr.split("the studio is at ")[1].split()[0]
    assert studio.stop() == 0
    assert "Traceback" not in studio.stderr


def _painted(page: Page) -> bool:
    """Whether the camera's picture is seen."""
    seen = cv2.imdecode(np.frombuffer(page.screenshot(), np.uint8), cv2.IMREAD_COLOR)
    near = np.abs(seen[:, :800].astype(int) - PAINTED[::-1]).max(axis=2) < 40
    return bool(near.mean() > 0.3)


@pytest.mark.long
def test_a_tab_shows_the_rig_says_what_is_missing_and_asks_no_other_machine(
    rig: RunningRig, wire: Wire
) -> None:
    with _studio(rig) as url, chromium() as browser:
        asked: list[str] = []
        with tab(browser, "about:blank") as page:
            page.on("request", lambda request: asked.append(request.url))
            page.on("websocket", lambda socket: asked.append(socket.url))
            page.goto(url)
            page.get_by_text("No camera of rig").wait_for()
            with Publishing(wire) as published:
                page.get_by_text("mug of person 3").wait_for()
                page.get_by_text("There is no mesh of mug in").wait_for()
                page.get_by_text("No tracker runs").wait_for(state="detached")
                eventually("the picture", lambda: _painted(page))

                published.tracking = False
                page.get_by_text("No tracker runs: objects are not tracked").wait_for()
                published.tracking = True
                page.get_by_text("No tracker runs").wait_for(state="detached")

                side = wire.publisher(INFO, "side")
                side.put(INFO_OF_FRONT)
                _choose(page, "Camera", "side")
                page.get_by_text("No picture of side came yet").wait_for()
                eventually("nobody who looks at front", lambda: not published.frames.wanted())
                _choose(page, "Camera", "front")
                eventually("the picture again", lambda: _painted(page))
                _choose(page, "Pictures", "none")
                eventually("nobody who looks", lambda: not published.frames.wanted())
                _choose(page, "Pictures", "all")
                eventually("the picture once more", lambda: _painted(page))
            page.get_by_text("No picture of front came for").wait_for()
            page.get_by_text("its process has ended, or cannot be reached").first.wait_for()
        assert {urlparse(one).hostname for one in asked if not _within(one)} == {"127.0.0.1"}
        frames = published.frames
        eventually("nobody who looks", lambda: not frames.wanted())


@pytest.mark.long
def test_a_tab_shows_hypotheses_of_trackers_while_it_is_ticked(
    rig: RunningRig, wire: Wire, tmp_path: Path
) -> None:
    file = tmp_path / "wedge.model"
    save_model(wave_model(), file)
    rig.configure(
        '[capture.front]\nsource = "simulator"\n'
        f'[tracker.thing]\ncamera = "front"\nmodel = "{file}"\n'
        f'[studio.page]\ndataset = "{rig.folder}/dataset"\nport = 0\n'
    )
    processes = [rig.inhand(one, "--config", rig.config) for one in ("tracker", "capture")]
    studio = rig.inhand("studio", "--config", rig.config)
    studio.said("the studio is at ")
    url = studio.stderr.split("the studio is at ")[1].split()[0]
    with chromium() as browser, tab(browser, url) as page:
        page.get_by_text("wedge of person").wait_for()
        _choose(page, "Pictures", "none")
        eventually("no picture", lambda: not _sticks_seen(page))
        page.get_by_role("checkbox", name="Hypotheses").check()
        page.get_by_text("hypotheses, 10 predictions").wait_for()
        eventually("sticks", lambda: _sticks_seen(page))
        page.get_by_role("checkbox", name="Hypotheses").uncheck()
        page.get_by_text("hypotheses, 10 predictions").wait_for(state="detached")
        eventually("no stick", lambda: not _sticks_seen(page))
    assert studio.stop() == 0
    assert [one.stop() for one in processes] == [0, 0]
    assert "Traceback" not in studio.stderr


def test_sticks_lie_along_the_longest_side_and_the_likeliest_is_the_brightest() -> None:
    turned = Pose((1.0, 0.0, 2.0), (0.5**0.5, 0.5**0.5, 0.0, 0.0))  # z becomes -y
    shape = wave_model().shape
    ends = sticks([PLACE, turned], shape)
    low, high = shape.vertices[:, 2].min(), shape.vertices[:, 2].max()
    np.testing.assert_allclose(ends[0, :, 2], [2.0 + low, 2.0 + high], atol=1e-6)
    np.testing.assert_allclose(ends[1, :, 1], [-low, -high], atol=1e-6)
    colours = stick_colours(np.array([0.1, 0.9, 0.0]))
    assert colours.shape == (3, 2, 3)
    assert np.argmax(colours[:, 0].sum(axis=1)) == 1


def _sticks_seen(page: Page) -> bool:
    """Whether the colour is seen in which a browser shows most hypotheses."""
    seen = cv2.imdecode(np.frombuffer(page.screenshot(), np.uint8), cv2.IMREAD_COLOR)
    return bool((np.abs(seen[:, :800].astype(int) - STICK[::-1]).max(axis=2) < 16).any())


def _choose(page: Page, menu: str, option: str) -> None:
    page.get_by_role("combobox", name=menu).click()
    page.get_by_role("option", name=option, exact=True).click()


def _within(url: str) -> bool:
    """Whether a request stays in the browser."""
    return urlparse(url).scheme in ("data", "blob")
