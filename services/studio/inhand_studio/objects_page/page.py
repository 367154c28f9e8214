"""A tab that makes objects of the dataset, and shows each beside a hand."""

from dataclasses import replace
from typing import Any

from inhand_runtime.errors import InhandError
from inhand_tracker.geometry.arrays import Array

from inhand_studio.dataset_files import find_objects
from inhand_studio.objects_page.display import described, show_object
from inhand_studio.objects_page.making import Making
from inhand_studio.objects_page.marking import Marking
from inhand_studio.objects_page.panel import Panel
from inhand_studio.texts import lines_html, write
from inhand_studio.visit import Page, Visit

PERIOD_S = 0.3
NEW = "(a new one)"
CM_PER_M = 100.0


def open_page(visit: Visit) -> Page:
    """Make objects of the studio's dataset; raises InhandError where it cannot be written."""
    return ObjectsPage(visit, Making(visit.studio.dataset))


class ObjectsPage:
    """Looks at objects that are there, and makes new ones, which are saved when they were seen."""

    def __init__(self, visit: Visit, making: Making) -> None:
        self._visit, self._making = visit, making
        self._gui = visit.client.gui
        self._waiting = False
        self._add_controls()
        self._stop = visit.every(PERIOD_S, self._step)

    def close(self) -> None:
        """Remove what was not saved."""
        self._stop()
        self._making.close()

    def _add_controls(self) -> None:
        act = self._visit.action
        self._there = self._gui.add_dropdown(
            "Object", (NEW, *find_objects(self._visit.studio.dataset))
        )
        self._there.on_update(act(lambda _: self._look_at()))
        self._folder = self._gui.add_folder("A new object")
        with self._folder:
            self._panel = Panel(self._visit, self._making)
            self._gui.add_button("Make and show").on_click(act(lambda _: self._make()))
            self._marking = Marking(self._visit, self._make)
            self._save = self._gui.add_button("Save to the dataset", visible=False)
            self._save.on_click(act(lambda _: self._keep()))
        self._said = self._gui.add_html("")
        self._about = self._gui.add_html("")

    def _look_at(self) -> None:
        name = self._there.value
        self._marking.offer(None)
        self._folder.visible = name == NEW
        if name == NEW:
            return
        shape, why = self._visit.studio.shapes.find(name)
        if shape is None:
            raise InhandError(why or f"there is no object {name}")
        write(self._said, "")
        show_object(self._visit, shape)
        write(self._about, lines_html(described(shape), "note"))

    def _make(self, marks: Array | None = None) -> None:
        """Make what the panel says, with marks (M, 3) of the object that is shown, if any."""
        self._save.visible = False
        self._marking.offer(None)
        wishes = self._panel.wishes()
        if marks is not None:
            chosen = tuple((x, y, z) for x, y, z in (CM_PER_M * marks).tolist())
            wishes = replace(wishes, marks_cm=chosen)
        self._making.begin(wishes)
        self._visit.clear()
        write(self._about, "")
        self._waiting = True

    def _keep(self) -> None:
        folder = self._making.save()
        self._save.visible = False
        self._marking.offer(None)
        self._there.options = (NEW, *find_objects(self._visit.studio.dataset))
        write(self._said, lines_html([f"saved {folder}"], "note"))

    def _step(self, _event: Any) -> None:
        """Show what is being made, and what became of it."""
        if not self._waiting:
            return
        self._waiting = self._making.running
        if self._waiting:
            write(self._said, lines_html(["It is being made …"], "note"))
            return
        failed = self._making.failed
        write(self._said, lines_html(self._making.said, "wrong" if failed else "note"))
        shape = self._making.result()
        if shape is not None:
            show_object(self._visit, shape)
            write(self._about, lines_html(described(shape), "note"))
            self._save.visible = True
            self._marking.offer(shape)
