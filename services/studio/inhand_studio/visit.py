"""One browser tab, which shows one page at a time."""

import logging
import threading
from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any, Protocol

import viser
from inhand_runtime.errors import InhandError
from viser import GuiFolderHandle

from inhand_studio.studio import Studio

log = logging.getLogger(__name__)

Action = Callable[[Any], None]
"""What is done at an event of the browser, which it is given."""


class Page(Protocol):
    """What a tab shows."""

    def close(self) -> None:
        """End all that runs for the page; what it drew is removed by the visit."""


class Visit:
    """A browser tab with its menu of pages.

    What happens in a tab happens one at a time: whatever changes a page holds the visit's
    ``lock``, which actions do by themselves.
    """

    def __init__(
        self, client: viser.ClientHandle, studio: Studio, pages: Mapping[str, str], first: str
    ) -> None:
        """Take the ``pages`` by their titles: each is a module with ``open_page(visit)``."""
        self.client = client
        self.studio = studio
        self.lock = threading.RLock()
        self._pages = pages
        self._first = first
        self._page: Page | None = None
        self._folder: GuiFolderHandle | None = None
        self._commands: list[viser.CommandHandle] = []
        self._on_look: Action = _nothing
        self._closed = False

    @property
    def closed(self) -> bool:
        """Whether the tab is gone: what still runs for it should end."""
        return self._closed

    def open(self) -> None:
        """Show the menu and the first page."""
        menu = self.client.gui.add_button_group("Page", tuple(self._pages))
        self.client.camera.on_update(self.action(lambda event: self._on_look(event)))
        menu.on_click(self.action(lambda event: self._show(event.target.value)))
        self.action(lambda _: self._show(self._first))(None)

    def close(self) -> None:
        """End the page, for the tab is gone."""
        self._closed = True
        with self.lock:
            self._leave()

    def action(self, act: Action) -> Action:
        """Make what the browser's events call: one action of a tab at a time.

        What it raises is shown in the tab; what is no InhandError is logged with its traceback.
        """

        def done(event: Any) -> None:
            with self.lock:
                self._do(act, event)

        return done

    def task(self, act: Action) -> Action:
        """Make what takes long, and runs beside a tab's actions, without its lock."""

        def done(event: Any) -> None:
            self._do(act, event)

        return done

    def every(self, period_s: float, act: Action) -> Callable[[], None]:
        """Do an action every so often, until the tab is gone or what is returned is called."""
        stop = threading.Event()
        do = self.action(lambda event: None if stop.is_set() else act(event))

        def run() -> None:
            while not stop.wait(period_s) and not self._closed:
                do(None)

        threading.Thread(target=run, name=f"every {period_s:g} s", daemon=True).start()
        return stop.set

    def command(self, label: str, key: str, act: Action, modifier: str | None = None) -> None:
        """Let a key do something while the page is shown; it is listed in the tab's palette.

        ``key`` and ``modifier`` are viser's, such as "K" and "shift".
        """
        command = self.client.gui.add_command(label, hotkey=key, modifier=modifier)  # type: ignore[arg-type]
        command.on_trigger(self.action(act))
        self._commands.append(command)

    def on_look(self, act: Action) -> None:
        """Do something when the browser looks from elsewhere, while the page is shown."""
        self._on_look = act

    def tell(self, text: str, *, title: str = "This did not work") -> None:
        """Show a line in the tab until it is put away."""
        self.client.add_notification(title, text, auto_close_seconds=None)

    def clear(self) -> None:
        """Take away all that the page drew into the scene, and its commands."""
        for command in self._commands:
            command.remove()
        self._commands.clear()
        self._on_look = _nothing
        self.client.scene.reset()
        self.client.scene.set_background_image(None)

    def _do(self, act: Action, event: Any) -> None:
        if self._closed:
            return
        try:
            act(event)
        except InhandError as error:
            self.tell(str(error))
        except Exception as error:
            log.exception("an action of a page failed")
            self.tell(f"{type(error).__name__}: {error}; the studio's log has the rest")

    def _show(self, title: str) -> None:
        """Leave the page that is shown for another."""
        self._leave()
        self._folder = self.client.gui.add_folder(title)
        with self._folder:
            self._page = import_module(self._pages[title]).open_page(self)

    def _leave(self) -> None:
        """Take away the page, or what there is of one that could not be opened."""
        if self._page is not None:
            self._page.close()
            self._page = None
        if self._closed or self._folder is None:
            return
        self.clear()
        self._folder.remove()
        self._folder = None


def _nothing(_event: Any) -> None:
    """Do nothing at an event."""
