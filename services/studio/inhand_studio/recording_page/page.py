"""A tab that makes training recordings: the live picture, who does what, and what is missing."""

import signal
import time
from contextlib import ExitStack
from typing import Any

import viser
from inhand_lab.new_recordings.view_watch import ViewWatch
from inhand_runtime.exit_codes import DONE, INTERRUPTED

from inhand_studio.dataset_files import find_objects
from inhand_studio.live_page.page import LivePage
from inhand_studio.recording_page.parameters import DEFAULT_RECORDING_PAGE
from inhand_studio.recording_page.wishes import Wishes, record_arguments
from inhand_studio.rig import Rig
from inhand_studio.texts import lines_html, write
from inhand_studio.verb import Verb
from inhand_studio.visit import Page, Visit

NO_OBJECT = "(none)"


def open_page(visit: Visit) -> Page:
    """Record the studio's rig; raises InhandError where it has none."""
    return RecordingPage(visit, visit.studio.require_rig())


class RecordingPage:
    """Starts and stops ``inhand record``, and shows what it says beside the live picture."""

    def __init__(self, visit: Visit, rig: Rig) -> None:
        self._visit, self._rig = visit, rig
        self._verb: Verb | None = None
        self._watched: str | None = None
        self._watch = ViewWatch(time.monotonic())
        self._seen = (-1, -1)
        self._looking = ExitStack()
        self._add_controls(visit.client.gui)
        self._live = LivePage(visit, rig, poses_wanted=False)
        self._stop = visit.every(DEFAULT_RECORDING_PAGE.period_s, self._step)

    def close(self) -> None:
        """End the recording, which is kept as at Stop, and the live picture."""
        self._stop()
        if self._verb is not None:
            self._verb.interrupt()
        self._looking.close()
        self._live.close()

    def _add_controls(self, gui: viser.GuiApi) -> None:
        numbers = DEFAULT_RECORDING_PAGE
        self._participant = gui.add_text("Participant", "", hint="Who is recorded")
        self._left = gui.add_checkbox("Left-handed", False)
        self._interaction = gui.add_text("Interaction", "", hint="What is done, such as drink")
        self._object = gui.add_dropdown(
            "Object", (NO_OBJECT, *find_objects(self._visit.studio.dataset))
        )
        self._countdown = gui.add_number(
            "Countdown, s", numbers.countdown_s, min=0.5, max=numbers.longest_s, step=0.5
        )
        self._seconds = gui.add_number(
            "Length, s",
            numbers.seconds,
            min=0.0,
            max=numbers.longest_s,
            step=1.0,
            hint="0: until Stop",
        )
        self._start_button = gui.add_button("Start recording", color="red")
        self._start_button.on_click(self._visit.action(lambda _: self._start()))
        self._stop_button = gui.add_button("Stop recording", visible=False)
        self._stop_button.on_click(self._visit.action(lambda _: self._end()))
        self._missing = gui.add_html("")
        self._said = gui.add_html("")

    def _start(self) -> None:
        if self._verb is not None and self._verb.running:
            return
        named = self._object.value
        wishes = Wishes(
            self._participant.value,
            bool(self._left.value),
            self._interaction.value,
            None if named == NO_OBJECT else named,
            self._live.camera,
            float(self._countdown.value),
            float(self._seconds.value),
        )
        studio = self._visit.studio
        # A studio that dies ends the recording as Stop does: what was recorded is kept.
        self._verb = Verb(record_arguments(wishes, studio.dataset, studio.config), signal.SIGINT)

    def _end(self) -> None:
        if self._verb is not None:
            self._verb.interrupt()

    def _step(self, _event: Any) -> None:
        running = self._verb is not None and self._verb.running
        self._start_button.visible, self._stop_button.visible = not running, running
        missing = self._missing_now(time.monotonic())
        write(self._missing, lines_html(missing, "wrong"))
        if self._verb is not None:
            write(self._said, _told(self._verb))

    def _missing_now(self, now_s: float) -> list[str]:
        """Say what the camera that is looked at does not show."""
        camera = self._live.camera
        info = self._rig.cameras().get(camera)
        if info is None:
            return []  # the live picture says so
        if camera != self._watched:
            self._looking.close()
            self._looking.enter_context(self._rig.looking(camera, "frames"))
            self._watched, self._watch, self._seen = camera, ViewWatch(now_s), (-1, -1)
            self._watch.note(info, now_s)
        news = self._rig.heard(camera, "frames")
        if news.pictures and (newest := news.pictures[-1].sequence) != self._seen[0]:
            self._seen = newest, self._seen[1]
            self._watch.note(news.pictures[-1].message, now_s)
        if news.skeletons and (newest := news.skeletons[-1].sequence) != self._seen[1]:
            self._seen = self._seen[0], newest
            self._watch.note(news.skeletons[-1], now_s)
        self._watch.news(now_s)
        return [one.text for one in self._watch.missing]


def _told(verb: Verb) -> str:
    """Return what a recording says, and whether it came to nothing."""
    if verb.code == INTERRUPTED:
        return lines_html(["Stopped in the countdown: nothing was recorded."], "wrong")
    lines = verb.lines[-DEFAULT_RECORDING_PAGE.lines_shown :]
    return lines_html(lines, "note" if verb.code in (None, DONE) else "wrong")
