"""A tab gets no more pictures than its browser shows."""

import sys
import threading
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from answering_viewer import Viewer, looking
from inhand_studio.camera_view import CameraView
from inhand_studio.pace import Pace
from inhand_studio.server import serving
from inhand_studio.studio import Studio
from inhand_studio.visit import Visit
from inhand_tracker.geometry.camera import Intrinsics
from running_rig import eventually

CAMERA = Intrinsics(50.0, 50.0, 31.5, 23.5, 64, 48)
ENOUGH = 20


class Flooding:
    """A page that shows a new picture whenever its tab is ready, ten times as often as any can."""

    def __init__(self, visit: Visit) -> None:
        self._visit, self._stop = visit, threading.Event()
        self._view, self._pace = CameraView(visit, CAMERA), Pace(visit.client)
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def close(self) -> None:
        self._stop.set()

    def _run(self) -> None:
        while not self._stop.wait(0.003):
            with self._visit.lock:
                if self._pace.ready():
                    self._view.show(np.zeros((48, 64, 3), np.uint8))
                    self._pace.sent()


@pytest.mark.long
def test_a_tab_that_does_not_answer_gets_one_picture_and_slows_no_other(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    module = ModuleType("flooding_page")
    module.open_page = Flooding  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "flooding_page", module)
    pages = {"Flooding": "flooding_page"}
    visits: list[Visit] = []

    def visit_of(client: object) -> Visit:
        visits.append(Visit(client, Studio(Path()), pages, "Flooding"))  # type: ignore[arg-type]
        return visits[-1]

    with serving("127.0.0.1", 0, visit_of) as port:
        url = f"http://127.0.0.1:{port}"
        answering, hanging, stuck = (
            Viewer(url),
            Viewer(url, answers=False),
            Viewer(url, reads=False),
        )
        with looking([answering, hanging, stuck]):
            eventually("pictures", lambda: answering.pictures >= ENOUGH)
            eventually("the first one", lambda: hanging.pictures)
            assert hanging.pictures <= 2  # it answers once, by itself, when it comes
            waiting = [_waiting(one) for one in visits]
            assert max(waiting) < ENOUGH


def _waiting(visit: Visit) -> int:
    """Return the number of messages that wait for a tab."""
    buffer = visit.client._websock_connection._state.message_buffer
    return len(buffer.message_from_id)
