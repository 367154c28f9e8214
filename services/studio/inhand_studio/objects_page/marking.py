"""Marked vertices by clicks on an object that is shown."""

from collections.abc import Callable
from typing import Any

import numpy as np
from inhand_lab.new_objects.proposal import FEWEST_MARKS
from inhand_runtime.errors import InhandError
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.shape.shape import ObjectShape

from inhand_studio.clicked_point import point_on
from inhand_studio.objects_page.display import STANDING, show_marks
from inhand_studio.texts import lines_html, write
from inhand_studio.visit import Visit


class Marking:
    """Takes points that are clicked on, and gives them to ``use``, which gets points (M, 3)."""

    def __init__(self, visit: Visit, use: Callable[[Array], None]) -> None:
        self._visit, self._use = visit, use
        self._shape: ObjectShape | None = None
        self._chosen: list[Array] = []
        self._listening = False
        gui = visit.client.gui
        self._begin = gui.add_button(
            "Choose other marks", hint="Points by which the error of a pose is measured"
        )
        self._begin.on_click(visit.action(lambda _: self._start()))
        self._said = gui.add_html("")
        self._take = gui.add_button("Use these marks")
        self._take.on_click(visit.action(lambda _: self._finish()))
        self.offer(None)

    def offer(self, shape: ObjectShape | None) -> None:
        """Let marks be chosen on an object that is shown; on none, nothing is offered."""
        self._end()
        self._shape = shape
        self._begin.visible = shape is not None

    def _start(self) -> None:
        assert self._shape is not None
        self._end()
        self._listening = self._take.visible = True
        show_marks(self._visit, self._shape, np.zeros((0, 3)))
        self._visit.client.scene.on_click()(self._visit.action(self._clicked))
        self._tell()

    def _clicked(self, event: Any) -> None:
        if self._shape is None:
            return
        ray = np.array(event.ray_origin), np.array(event.ray_direction)
        self._chosen.append(point_on(self._shape, STANDING, *ray))
        show_marks(self._visit, self._shape, np.array(self._chosen))
        self._tell()

    def _finish(self) -> None:
        if len(self._chosen) < FEWEST_MARKS:
            raise InhandError(f"click on {FEWEST_MARKS} points of the object or more")
        chosen = np.array(self._chosen)
        self._end()
        self._use(chosen)

    def _end(self) -> None:
        if self._listening:
            self._visit.client.scene.remove_click_callback("all")
        self._listening = self._take.visible = False
        self._chosen = []
        write(self._said, "")

    def _tell(self) -> None:
        text = (
            f"Click on {FEWEST_MARKS} points of the object or more, far apart: "
            f"{len(self._chosen)} so far."
        )
        write(self._said, lines_html([text], "note"))
