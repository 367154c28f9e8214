"""A tab that reviews recordings."""

from contextlib import ExitStack
from pathlib import Path
from typing import Any

from inhand_lab.datasets.dataset import DatasetEntry, DatasetError, load_dataset
from inhand_runtime.errors import InhandError

from inhand_studio.controls import put
from inhand_studio.dataset_files import find_recordings
from inhand_studio.review_page.desk import Desk
from inhand_studio.review_page.recording import ReviewedRecording
from inhand_studio.texts import lines_html
from inhand_studio.visit import Page, Visit

NOTHING = "choose …"


def open_page(visit: Visit) -> Page:
    """Review the recordings of the studio's dataset, or any other."""
    return ReviewPage(visit)


class ReviewPage:
    """Chooses a recording, and lays the desk for it."""

    def __init__(self, visit: Visit) -> None:
        self._visit = visit
        self._gui = visit.client.gui
        self._desk: Desk | None = None
        self._path: Path | None = None
        studio = visit.studio
        self._recordings = find_recordings(studio.dataset, studio.recording)
        self._recording = self._gui.add_dropdown("Recording", (NOTHING, *self._recordings))
        self._recording.on_update(self._chosen)
        self._typed = self._gui.add_text("or its path", "")
        open_button = self._gui.add_button("Open the path")
        open_button.on_click(visit.action(lambda _: self._open_typed()))
        self._camera = self._gui.add_dropdown("Camera", (NOTHING,), visible=False)
        self._camera.on_update(self._camera_chosen)
        lacking = [] if self._recordings else [f"{studio.dataset} holds no recordings."]
        self._gui.add_html(lines_html(lacking, "wrong"))
        self._container = self._gui.add_folder("Recording")
        if studio.recording is not None:
            named = (name for name, path in self._recordings.items() if path == studio.recording)
            put(self._recording, next(named, NOTHING))
            self._open(studio.recording)

    def close(self) -> None:
        """End what runs."""
        if self._desk is not None:
            self._desk.close()
            self._desk = None

    def _chosen(self, event: Any) -> None:
        if event.client is not None and event.target.value != NOTHING:
            path = self._recordings[event.target.value]
            self._visit.action(lambda _: self._open(path))(event)

    def _camera_chosen(self, event: Any) -> None:
        path = self._path
        if event.client is not None and path is not None and event.target.value != NOTHING:
            self._visit.action(lambda _: self._open(path, event.target.value))(event)

    def _open_typed(self) -> None:
        path = Path(self._typed.value.strip()).expanduser()
        if not path.name:
            raise InhandError("write the path of a recording (.mcap)")
        self._open(path)

    def _open(self, path: Path, camera: str | None = None) -> None:
        """Lay the desk for a recording; raises RecordingError or DatasetError."""
        self._put_away()
        with ExitStack() as opened:
            recording = ReviewedRecording(path, camera)
            opened.callback(recording.close)
            self._camera.options = recording.cameras or (NOTHING,)
            put(self._camera, recording.camera or NOTHING)
            self._camera.visible = len(recording.cameras) > 1
            with self._container:
                self._folder = self._gui.add_folder(path.name)
            with self._folder:
                self._desk = Desk(self._visit, recording, _entry(self._visit.studio.dataset, path))
            self._path = path
            opened.pop_all()

    def _put_away(self) -> None:
        if self._desk is not None:
            self._desk.close()
            self._desk = None
            self._visit.clear()
            self._folder.remove()


def _entry(folder: Path, path: Path) -> DatasetEntry | None:
    """Return what a dataset says of a recording; None where it says nothing."""
    try:
        dataset = load_dataset(folder)
    except DatasetError:  # a folder of recordings alone can be reviewed as well
        return None
    same = (entry for entry in dataset.entries if dataset.path(entry).absolute() == path.absolute())
    return next(same, None)
