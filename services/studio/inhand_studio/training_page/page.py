"""A tab that trains: what to learn of which recordings, how far it is, and what came of it."""

from typing import Any

import viser
from inhand_runtime.errors import InhandError

from inhand_studio.controls import put
from inhand_studio.texts import lines_html, write
from inhand_studio.training_page.lessons import Lesson, lessons_of
from inhand_studio.training_page.rollout import Place, how_to_add, places_of, roll_out
from inhand_studio.training_page.told import progress_lines
from inhand_studio.visit import Page, Visit

PERIOD_S = 0.3


def open_page(visit: Visit) -> Page:
    """Train on the studio's dataset; raises DatasetError where there is none."""
    lessons = lessons_of(visit.studio.dataset)
    if not lessons:
        raise InhandError(
            f"no recording of {visit.studio.dataset} names an object: record with an object, and "
            "label it"
        )
    return TrainingPage(visit, {one.title: one for one in lessons})


class TrainingPage:
    """Starts trainings, which go on when the tab is gone, and puts their models into the rig."""

    def __init__(self, visit: Visit, lessons: dict[str, Lesson]) -> None:
        self._visit, self._lessons = visit, lessons
        self._gui = visit.client.gui
        self._places: dict[str, Place] = {}
        self._boxes: list[tuple[viser.GuiCheckboxHandle, Any]] = []
        self._add_controls()
        self._stop = visit.every(PERIOD_S, self._step)

    def close(self) -> None:
        """Look no longer; what is trained goes on."""
        self._stop()

    def _add_controls(self) -> None:
        act = self._visit.action
        self._lesson = self._gui.add_dropdown("Learn", tuple(self._lessons))
        self._lesson.on_update(act(lambda _: self._list_recordings()))
        self._folder = self._gui.add_folder("Recordings")
        self._list_recordings()
        self._start = self._gui.add_button("Start training")
        self._start.on_click(act(lambda _: self._train()))
        self._cancel = self._gui.add_button("Cancel training", visible=False)
        self._cancel.on_click(act(lambda _: self._visit.studio.trainings.cancel()))
        self._told = self._gui.add_html("")
        self._failed = self._gui.add_html("")
        self._place = self._gui.add_dropdown("Put into", ("",), visible=False)
        self._put = self._gui.add_button("Put into the running rig", visible=False)
        self._put.on_click(act(lambda _: self._roll_out()))
        self._rolled_out = self._gui.add_html("")

    def _list_recordings(self) -> None:
        for box, _ in self._boxes:
            box.remove()
        lesson = self._lessons[self._lesson.value]
        self._boxes = []
        with self._folder:
            for entry in lesson.entries:
                why = lesson.unusable.get(entry.file)
                box = self._gui.add_checkbox(
                    f"{entry.participant}: {entry.file.rpartition('/')[2]}",
                    why is None,
                    disabled=why is not None,
                    hint=why or f"{entry.handedness}-handed",
                )
                self._boxes.append((box, entry))

    def _train(self) -> None:
        lesson = self._lessons[self._lesson.value]
        entries = [entry for box, entry in self._boxes if box.value]
        if not entries:
            raise InhandError("tick the recordings to learn from; those without labels cannot be")
        self._rolled_out.content = ""
        self._visit.studio.trainings.start(self._visit.studio.dataset, lesson, entries)

    def _step(self, _event: Any) -> None:
        progress = self._visit.studio.trainings.progress
        if progress is None:
            return
        self._start.visible, self._cancel.visible = not progress.running, progress.running
        write(self._told, lines_html(progress_lines(progress), "note"))
        failure = [] if progress.failure is None else [progress.failure]
        write(self._failed, lines_html(failure, "wrong"))
        ready = progress.model is not None and not progress.running
        begins, self._put.visible = ready and not self._put.visible, ready
        if begins:
            self._offer_places()
        self._place.visible = ready and bool(self._places)

    def _offer_places(self) -> None:
        """Offer the places of models in the rig, first those of the same object."""
        name = self._object_trained()
        places = sorted(
            places_of(self._visit.studio.config), key=lambda one: one.object_name != name
        )
        self._places = {one.title: one for one in places}
        if self._places:
            self._place.options = tuple(self._places)
            put(self._place, next(iter(self._places)))

    def _object_trained(self) -> str:
        progress = self._visit.studio.trainings.progress
        return "" if progress is None or progress.model is None else progress.model.stem

    def _roll_out(self) -> None:
        progress, daemon = self._visit.studio.trainings.progress, self._visit.studio.daemon
        if progress is None or progress.model is None:
            return
        if daemon is None or not self._places:
            text = how_to_add(progress.model, self._object_trained())
        else:
            text = roll_out(progress.model, self._places[self._place.value], daemon)
        self._rolled_out.content = lines_html([text], "note")
