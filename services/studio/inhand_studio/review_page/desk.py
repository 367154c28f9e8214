"""One recording that is reviewed, with its controls."""

import threading
import time
from contextlib import ExitStack

import viser
from inhand_lab.datasets.dataset import DatasetEntry

from inhand_studio.controls import put
from inhand_studio.pace import Pace
from inhand_studio.player import RATES, Player
from inhand_studio.review_page.drawing import Drawing
from inhand_studio.review_page.estimates import Estimates
from inhand_studio.review_page.parameters import DEFAULT_REVIEW, ReviewParameters
from inhand_studio.review_page.plot import marker_html, plot_html, worst_frame
from inhand_studio.review_page.recording import ReviewedRecording
from inhand_studio.review_page.texts import frame_text, legend_html
from inhand_studio.review_page.tracking_panel import TrackingPanel
from inhand_studio.scene_parts import TRUE
from inhand_studio.texts import lines_html
from inhand_studio.visit import Visit


class Desk:
    """Shows the frame that is chosen or played, in a thread of its own, and reads the errors in
    another; made and closed with the visit's lock held."""

    def __init__(
        self,
        visit: Visit,
        recording: ReviewedRecording,
        entry: DatasetEntry | None,
        parameters: ReviewParameters = DEFAULT_REVIEW,
    ) -> None:
        self._visit, self._recording, self._parameters = visit, recording, parameters
        self._estimates = Estimates(recording, visit.studio.shapes, parameters)
        self._player = Player(recording.times_ns)
        self._pace = Pace(visit.client)
        self._drawing = Drawing(visit, recording, self._estimates)
        self._shown: tuple[object, ...] | None = None
        self._follows = True
        self._changes = 0
        self._stop = threading.Event()
        self._ended = ExitStack()
        self._add_controls(visit.client.gui)
        self._tracking = TrackingPanel(visit, recording, self._estimates, entry, self._changed)
        self._ended.callback(self._tracking.close)
        self._add_commands()
        self._threads = [
            threading.Thread(target=self._run, name="review", daemon=True),
            threading.Thread(target=self._read, name="review errors", daemon=True),
        ]
        for thread in self._threads:
            thread.start()

    def close(self) -> None:
        """End what runs, and close the recording when nobody reads it any longer."""
        self._stop.set()
        self._ended.close()
        threading.Thread(target=self._close_file, name="review end", daemon=True).start()

    def _close_file(self) -> None:
        for thread in self._threads:
            thread.join()
        self._recording.close()

    def _add_controls(self, gui: viser.GuiApi) -> None:
        action, frames = self._visit.action, len(self._recording)
        self._about = gui.add_html("")
        self._plot, self._marker = gui.add_html(""), gui.add_html("")
        self._slider = gui.add_slider("Frame", 0, max(frames - 1, 1), 1, 0)
        self._slider.on_update(self._slide)
        steps = gui.add_button_group("Go", ("one back", "one on", "worst"))
        steps.on_click(action(lambda event: self._go(event.target.value)))
        self._rate = gui.add_dropdown("Speed", RATES, initial_value="1")
        self._play_button = gui.add_button("Play", hint="P")
        self._play_button.on_click(action(lambda _: self._play()))
        names = self._recording.objects or ("(none)",)
        self._object = gui.add_dropdown("Errors of", names, visible=len(names) > 1)
        self._with_truth = gui.add_checkbox("Truth", True, hint="The recording's labels, green")
        self._with_recorded = gui.add_checkbox(
            "Recorded", True, hint="What a tracker estimated while it was recorded, red"
        )
        for control in (self._object, self._with_truth, self._with_recorded):
            control.on_update(action(lambda _: self._changed()))
        self._legend = gui.add_html("")
        self._progress = gui.add_progress_bar(0.0, visible=True)

    def _add_commands(self) -> None:
        visit = self._visit
        visit.command("Play, and stop", "P", lambda _: self._play())
        visit.command("One frame back", "Z", lambda _: self._step(-1))
        visit.command("One frame on", "X", lambda _: self._step(1))
        visit.command("Ten frames back", "Z", lambda _: self._step(-10), "shift")
        visit.command("Ten frames on", "X", lambda _: self._step(10), "shift")
        visit.command("To the first frame", "home", lambda _: self._jump(0))
        visit.command("To the last frame", "end", lambda _: self._jump(len(self._recording) - 1))
        visit.command("To the worst frame", "M", lambda _: self._go("worst"))
        visit.command("Look through the camera", "C", lambda _: self._drawing.look_through())

    def _slide(self, event: viser.GuiEvent[viser.GuiSliderHandle[int]]) -> None:
        """Follow the slider that somebody moves; where the page itself moves it, do nothing."""
        if event.client is not None:
            self._follows = False
            self._player.jump(int(event.target.value))

    def _go(self, where: str) -> None:
        if where == "worst":
            frame = worst_frame(self._estimates.of(self._object.value))
            if frame is not None:
                self._jump(frame)
        else:
            self._step(-1 if where == "one back" else 1)

    def _step(self, frames: int) -> None:
        self._jump(self._player.frame(time.monotonic()) + frames)

    def _jump(self, frame: int) -> None:
        self._follows = True
        self._player.jump(frame)

    def _play(self) -> None:
        self._follows = True
        if self._player.playing:
            self._player.stop(time.monotonic())
        else:
            self._player.play(float(self._rate.value), time.monotonic())

    def _changed(self) -> None:
        """Draw anew what is shown."""
        self._changes += 1

    def _run(self) -> None:
        def step(_event: object) -> None:
            self._show()
            self._shown_well = True

        show = self._visit.action(step)
        parameters = self._parameters
        while not self._stop.wait(parameters.tick_s if self._player.playing else parameters.idle_s):
            self._shown_well = False
            show(None)
            if not self._shown_well:
                self._player.stop(time.monotonic())
                self._stop.wait(1.0)

    def _show(self) -> None:
        """Show the frame of now, if it is not shown and the tab is ready for it."""
        if self._stop.is_set():
            return
        self._tracking.tick()
        frame = self._player.frame(time.monotonic())
        wanted = frame, self._changes
        if wanted == self._shown or not self._pace.ready():
            return
        changed = self._shown is None or self._shown[1] != self._changes
        self._shown = wanted
        said = self._drawing.show(frame, self._with_truth.value, self._with_recorded.value)
        if self._recording.note is not None:
            said.insert(0, self._recording.note)
        self._describe(frame, said, changed)
        self._pace.sent()

    def _describe(self, frame: int, said: list[str], changed: bool) -> None:
        recording = self._recording
        text = [frame_text(frame, recording.times_ns), *said]
        self._about.content = lines_html(text, "note")
        estimates = self._estimates.of(self._object.value)
        if changed:
            self._plot.content = plot_html(estimates, len(recording), self._parameters)
        self._marker.content = marker_html(frame, len(recording)) if self._plot.content else ""
        truth = TRUE if self._object.value in recording.labels else None
        self._legend.content = legend_html(estimates, frame, truth)
        self._play_button.label = "Stop" if self._player.playing else "Play"
        if self._follows and self._slider.value != frame:
            put(self._slider, frame)

    def _read(self) -> None:
        """Read what errors are made of."""
        written = time.monotonic()

        def on_progress(share: float) -> bool:
            nonlocal written
            if time.monotonic() - written > self._parameters.progress_s:
                written = time.monotonic()
                put(self._progress, 100.0 * share)
            return not self._stop.is_set()

        def read(_event: object) -> None:
            self._estimates.read(on_progress)

        self._visit.task(read)(None)
        if not self._stop.is_set():
            self._progress.visible = False
            self._changed()
