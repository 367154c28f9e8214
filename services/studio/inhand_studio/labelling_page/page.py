"""The labelling page: a recording and an object are chosen, and the desk is laid."""

import threading
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from inhand_tracker.shape.shape import ObjectShape, load_shape

from inhand_studio.controls import put
from inhand_studio.dataset_files import find_objects, find_recordings, recording_name
from inhand_studio.labelling_page.assistant import Eyes
from inhand_studio.labelling_page.desk import Desk
from inhand_studio.labelling_page.exporting import Exporting
from inhand_studio.labelling_page.handling import Handling
from inhand_studio.labelling_page.helping import Helping
from inhand_studio.labelling_page.opened import OpenedRecording
from inhand_studio.labelling_page.panel import Panel
from inhand_studio.labelling_page.parameters import DEFAULT_PAGE
from inhand_studio.labelling_page.stage import Stage
from inhand_studio.visit import Visit

NOTHING = "choose …"


def open_page(visit: Visit) -> "LabellingPage":
    """Show the page in a tab."""
    return LabellingPage(visit)


class LabellingPage:
    """What is chosen, and the desk that is laid for it."""

    def __init__(self, visit: Visit) -> None:
        self._visit = visit
        self._gui = visit.client.gui
        self._dataset = visit.studio.dataset
        self._desk: Desk | None = None
        self._stopped = threading.Event()
        self._recordings = find_recordings(
            self._dataset, visit.studio.recording, labelled_copies=False
        )
        self._objects = find_objects(self._dataset)
        self._add_choice()
        self._ticks = visit.action(lambda _: self._tick())
        threading.Thread(target=self._run_ticks, name="labelling", daemon=True).start()
        if visit.studio.object_name in self._objects:
            put(self._object, visit.studio.object_name)
        if visit.studio.recording is not None:
            put(self._recording, recording_name(visit.studio.recording, self._dataset))
            self._choose()

    def close(self) -> None:
        """End what runs, and let others edit."""
        self._stopped.set()
        self._put_away()

    def _add_choice(self) -> None:
        names = (NOTHING, *self._recordings)
        self._recording = self._gui.add_dropdown("Recording", names, initial_value=NOTHING)
        objects = (NOTHING, *self._objects) if len(self._objects) != 1 else tuple(self._objects)
        self._object = self._gui.add_dropdown("Object", objects, initial_value=objects[0])
        self._camera = self._gui.add_dropdown(
            "Camera", (NOTHING,), initial_value=NOTHING, visible=False
        )
        self._said = self._gui.add_markdown(
            _missing(self._dataset, self._recordings, self._objects)
        )
        self._container = self._gui.add_folder("Labels")
        for control in (self._recording, self._object, self._camera):
            control.on_update(self._chosen_by_browser)

    def _chosen_by_browser(self, event: Any) -> None:
        if event.client is not None:
            self._visit.action(lambda _: self._choose(event.target))(event)

    def _choose(self, changed: object = None) -> None:
        """Lay the desk for what is chosen now, if it is enough."""
        self._put_away()
        if changed is not self._camera:
            self._camera.visible = False
        if NOTHING in (self._recording.value, self._object.value):
            return
        camera = str(self._camera.value) if self._camera.visible else None
        with ExitStack() as opened:
            path = self._recordings[self._recording.value]
            recording = OpenedRecording(path, camera)
            opened.callback(recording.close)
            if recording.several_cameras and camera is None:
                self._camera.options = recording.cameras
                self._camera.visible = True
                put(self._camera, recording.camera)
            shape = load_shape(self._objects[self._object.value])
            with self._container:
                self._folder = self._gui.add_folder(shape.name)
            with self._folder:
                self._desk = lay_desk(self._visit, recording, shape, self._dataset)
            opened.pop_all()

    def _put_away(self) -> None:
        if self._desk is None:
            return
        self._desk.close()
        self._desk = None
        if not self._visit.closed:
            self._visit.clear()
            self._folder.remove()

    def _run_ticks(self) -> None:
        while not self._stopped.wait(self._pause_s()):
            self._ticks(None)

    def _pause_s(self) -> float:
        desk = self._desk
        return DEFAULT_PAGE.play_s if desk is not None and desk.playing else DEFAULT_PAGE.tick_s

    def _tick(self) -> None:
        if self._desk is not None and not self._stopped.is_set():
            self._desk.tick()


def lay_desk(visit: Visit, recording: OpenedRecording, shape: ObjectShape, dataset: Path) -> Desk:
    """Open the keyframes of an object in a recording, and show both.

    Raises LabellingError, RecordingError and DatasetError.
    """
    desk = Desk(visit, recording, shape)
    try:
        eyes, handling = Eyes(shape), Handling(desk)
        helping = Helping(desk, eyes)
        acts = {**desk.acts(), **handling.acts(), **helping.acts()}
        panel = Panel(visit, len(recording), acts)
        desk.begin(Stage(visit, recording, shape, handling.drag), panel)
        Exporting(desk, dataset, eyes)
    except BaseException:
        desk.close()
        raise
    return desk


def _missing(dataset: Path, recordings: dict[str, Path], objects: dict[str, Path]) -> str:
    """Say what a dataset lacks."""
    lacking = []
    if not recordings:
        lacking.append(f"{dataset / 'recordings'} holds no recordings: the page Record makes one.")
    if not objects:
        lacking.append(f"{dataset / 'objects'} holds no objects: the page Objects makes one.")
    return " ".join(lacking)
