"""A tab that watches a rig live."""

import threading
import time
from contextlib import ExitStack
from typing import Any

import viser
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import CameraInfo, ObjectPose
from inhand_tracker.geometry.camera import Intrinsics, intrinsics_of

from inhand_studio.camera_view import CameraView
from inhand_studio.drawn_scene import DrawnScene, PlacedObject
from inhand_studio.live_page.conditions import conditions_of, no_camera, without_poses
from inhand_studio.live_page.hypotheses import LiveHypotheses
from inhand_studio.live_page.moment import Moment, moment_of, newest_poses
from inhand_studio.live_page.parameters import DEFAULT_LIVE, LiveParameters
from inhand_studio.live_page.points import LivePoints
from inhand_studio.live_page.rates import Rate, rate_of
from inhand_studio.live_page.texts import objects_html, processes_html, shown_html
from inhand_studio.pace import Pace
from inhand_studio.picture import Picture
from inhand_studio.rig import CameraNews, Pictures, Rig
from inhand_studio.texts import lines_html, write
from inhand_studio.visit import Page, Visit

NO_CAMERA = "(no camera yet)"
PICTURES: dict[str, Pictures | None] = {
    "all": "frames",
    "small and few, for slow links": "previews",
    "none": None,
}


def open_page(visit: Visit) -> Page:
    """Watch the studio's rig; raises InhandError where it has none."""
    return LivePage(visit, visit.studio.require_rig())


class LivePage:
    """Shows what one camera sees, in a thread of its own, as fast as its tab takes it."""

    def __init__(
        self,
        visit: Visit,
        rig: Rig,
        parameters: LiveParameters = DEFAULT_LIVE,
        *,
        poses_wanted: bool = True,
    ) -> None:
        """Show a rig's camera; that no poses come is said where they are ``poses_wanted``."""
        self._visit, self._rig, self._parameters = visit, rig, parameters
        self._poses_wanted = poses_wanted
        self._looking = ExitStack()
        self._looked: tuple[str, Pictures | None] | None = None
        self._seen_from: tuple[str, Intrinsics] | None = None
        self._view: CameraView | None = None
        self._scene = DrawnScene(visit.client.scene)
        self._points = LivePoints(visit.client.scene, parameters)
        self._hypotheses = LiveHypotheses(visit.client.scene, rig, visit.studio.shapes, parameters)
        self._pace = Pace(visit.client)
        self._news = CameraNews()
        self._unknown: list[str] = []
        self._shown: Picture | None = None
        self._damage: str | None = None
        self._shown_rate = Rate()
        self._texts_at = self._processes_at = 0.0
        self._stop = threading.Event()
        self._add_controls(visit.client.gui)
        visit.command("Look through the camera", "C", lambda _: self._look_through())
        self._thread = threading.Thread(target=self._run, name="live page", daemon=True)
        self._thread.start()

    @property
    def camera(self) -> str:
        """The name of the camera that is chosen."""
        return str(self._camera.value)

    def close(self) -> None:
        """Look at nothing any longer; called with the visit's lock held."""
        self._stop.set()
        self._hypotheses.want(False)
        self._looking.close()

    def _add_controls(self, gui: viser.GuiApi) -> None:
        cameras = tuple(self._rig.cameras()) or (NO_CAMERA,)
        self._camera = gui.add_dropdown("Camera", cameras)
        self._pictures = gui.add_dropdown("Pictures", tuple(PICTURES))
        self._with_points = gui.add_checkbox(
            "Point cloud", False, hint="What depth measures, five times a second; turn the scene"
        )
        self._with_hypotheses = gui.add_checkbox(
            "Hypotheses",
            False,
            hint="Poses that trackers consider, the likelier the brighter, and what each part of "
            "the body says by itself; five times a second",
        )
        look = gui.add_button("Look through the camera", hint="C; drag the scene to turn it")
        look.on_click(self._visit.action(lambda _: self._look_through()))
        self._wrong = gui.add_html("")
        self._objects = gui.add_html("")
        self._rates = gui.add_html("")
        with gui.add_folder("Processes"):
            self._processes = gui.add_html("")

    def _run(self) -> None:
        """Show what comes until the page is closed, or showing fails, which the tab says."""
        show = self._visit.action(self._step)
        news = -1
        while not self._stop.is_set() and not self._visit.closed:
            self._done = False
            show(None)
            if not self._done:
                return
            news = self._rig.wait(news, self._parameters.wait_s)

    def _step(self, _event: Any) -> None:
        if not self._stop.is_set():
            with self._visit.client.atomic():
                self._show(time.monotonic())
        self._done = True

    def _show(self, now: float) -> None:
        """Bring the tab up to date."""
        infos = self._rig.cameras()
        if self._camera.options != (cameras := tuple(infos) or (NO_CAMERA,)):
            self._camera.options = cameras
        info = infos.get(self._camera.value)
        if info is None:
            write(self._wrong, lines_html([no_camera(self._rig)], "wrong"))
        else:
            self._look_at(self._camera.value, info)
            self._show_camera(self._camera.value, info, now)
        if now - self._processes_at > self._parameters.processes_period_s:
            self._processes_at = now
            write(self._processes, processes_html(self._rig.roll))

    def _look_at(self, camera: str, info: CameraInfo) -> None:
        """Let what the menus choose come, and nothing else."""
        wanted = camera, PICTURES[self._pictures.value]
        if wanted != self._looked:
            before = self._looking.pop_all()
            self._looking.enter_context(self._rig.looking(*wanted))
            before.close()
            self._looked, self._shown = wanted, None
            if wanted[1] is None and self._view is not None:
                self._view.hide()
        seen_from = camera, intrinsics_of(info)
        if self._view is None or self._seen_from != seen_from:
            self._seen_from = seen_from
            self._view = CameraView(self._visit, intrinsics_of(info))

    def _show_camera(self, camera: str, info: CameraInfo, now: float) -> None:
        pictures = PICTURES[self._pictures.value]
        self._hypotheses.want(bool(self._with_hypotheses.value))
        considered = self._hypotheses.draw(camera)
        news = self._rig.heard(camera, pictures)
        if news != self._news and self._pace.ready():
            self._news = news
            self._draw(moment_of(news, now, self._parameters), info, now)
        if now - self._texts_at < self._parameters.text_period_s:
            return
        self._texts_at = now
        lines = [
            *self._unknown,
            *conditions_of(camera, info, pictures, self._rig, self._parameters),
        ]
        if self._poses_wanted:
            lines += without_poses(camera, pictures, self._rig, self._parameters)
        lines += [] if self._damage is None else [self._damage]
        write(self._wrong, lines_html(lines, "wrong"))
        objects = objects_html(newest_poses(news.poses), self._parameters)
        write(self._objects, objects + lines_html(considered, "note"))
        came_hz = rate_of([picture.arrived for picture in news.pictures], now)
        write(self._rates, shown_html(self._shown_rate.at(now), came_hz))

    def _draw(self, moment: Moment, info: CameraInfo, now: float) -> None:
        """Draw a moment, unless its picture is drawn already."""
        if moment.picture is not None and moment.picture is self._shown:
            return
        self._show_picture(moment.picture, info, now)
        self._scene.draw_people(() if moment.people is None else moment.people.people)
        placed, self._unknown = self._placed(moment)
        self._scene.draw_objects(placed)
        self._pace.sent()

    def _show_picture(self, picture: Picture | None, info: CameraInfo, now: float) -> None:
        """Show a picture that is not shown yet, and its points where they are wanted."""
        if picture is None or self._view is None:
            return
        self._shown = picture
        try:
            colour = picture.colour(info)
            if colour is not None:
                self._view.show(colour)
                self._shown_rate.count(now)
            self._points.show(picture if self._with_points.value else None, info, now)
            self._damage = None
        except MessageError as error:
            self._damage = f"A picture of {self._camera.value} cannot be shown: {error}."

    def _placed(self, moment: Moment) -> tuple[list[PlacedObject], list[str]]:
        """Return the objects to be drawn, and what is to be said of them."""
        placed, lines = [], []
        for pose in moment.objects:
            if pose.camera_from_object is None:
                continue
            shape, why = self._visit.studio.shapes.find(pose.object)
            placed.append(PlacedObject(_slot(pose), shape, pose.camera_from_object))
            lines += [] if why is None else [why]
        return placed, list(dict.fromkeys(lines))

    def _look_through(self) -> None:
        if self._view is not None:
            self._view.look_through()


def _slot(pose: ObjectPose) -> str:
    return pose.object if pose.person is None else f"{pose.object}_{pose.person}"
