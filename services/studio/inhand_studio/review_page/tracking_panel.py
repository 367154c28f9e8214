"""Tracks a recording anew, by any method with any model, to see methods or models side by side."""

import time
from collections.abc import Callable
from pathlib import Path

from inhand_lab.datasets.dataset import DatasetEntry
from inhand_runtime.errors import InhandError
from inhand_tracker.methods.registry import DEFAULT_METHOD, METHODS

from inhand_studio.controls import put
from inhand_studio.dataset_files import find_models
from inhand_studio.review_page.estimates import Estimates
from inhand_studio.review_page.parameters import DEFAULT_REVIEW
from inhand_studio.review_page.recording import ReviewedRecording
from inhand_studio.review_page.tracking_job import TrackingJob, TrackingTask
from inhand_studio.visit import Visit

NO_MODEL = "(by its path)"


class TrackingPanel:
    """Its controls, and the one job that runs; used with the visit's lock held."""

    def __init__(
        self,
        visit: Visit,
        recording: ReviewedRecording,
        estimates: Estimates,
        entry: DatasetEntry | None,
        on_result: Callable[[], None],
    ) -> None:
        """``entry`` is what a dataset says of the recording, and ``on_result`` is called when there
        are other estimates."""
        self._recording, self._estimates, self._on_result = recording, estimates, on_result
        self._job: TrackingJob | None = None
        self._written = 0.0
        studio = visit.studio
        self._models = {str(path): path for path in find_models(studio.dataset, studio.models)}
        gui = visit.client.gui
        with gui.add_folder("Track it anew", expand_by_default=False):
            self._method = gui.add_dropdown("Method", tuple(METHODS), initial_value=DEFAULT_METHOD)
            names = (*self._models, NO_MODEL)
            self._model = gui.add_dropdown("Model", names)
            self._path = gui.add_text("Its path", "")
            left = entry is not None and entry.handedness == "left"
            self._left = gui.add_checkbox("Left-handed", left)
            self._start_button = gui.add_button("Track")
            self._start_button.on_click(visit.action(lambda _: self._start()))
            self._cancel_button = gui.add_button("Cancel", visible=False)
            self._cancel_button.on_click(visit.action(lambda _: self._cancel()))
            self._bar = gui.add_progress_bar(0.0, visible=False)

    def tick(self) -> None:
        """Look how far the job is; raises InhandError where it failed."""
        job = self._job
        if job is None or time.monotonic() - self._written < DEFAULT_REVIEW.progress_s:
            return
        self._written = time.monotonic()
        put(self._bar, 100.0 * job.share)
        if not job.running:
            self._end()
            self._estimates.add_tracked(job.task, job.result())
            self._on_result()

    def close(self) -> None:
        """End the job, if one runs."""
        if self._job is not None:
            self._job.cancel()
            self._job = None

    def _start(self) -> None:
        if self._job is not None:
            raise InhandError("one tracker runs already: wait for it, or cancel it")
        self._job = TrackingJob(self._task())
        self._cancel_button.visible = self._bar.visible = True
        self._start_button.disabled = True

    def _task(self) -> TrackingTask:
        model = self._models.get(self._model.value)
        if model is None:
            if not self._path.value.strip():
                raise InhandError("write the path of a model, which `inhand train` makes")
            model = Path(self._path.value.strip()).expanduser()
        if not model.is_file():
            raise InhandError(f"{model} is no file: choose a model, which `inhand train` makes")
        several = len(self._recording.cameras) > 1
        camera = self._recording.camera if several else ""
        return TrackingTask(
            self._recording.path, model, self._method.value, camera, self._left.value
        )

    def _cancel(self) -> None:
        self.close()
        self._end()

    def _end(self) -> None:
        self._job = None
        self._cancel_button.visible = self._bar.visible = False
        self._start_button.disabled = False
