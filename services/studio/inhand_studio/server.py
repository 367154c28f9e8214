"""Serves pages to browsers, each of which is a visit."""

import contextlib
import io
import threading
from collections.abc import Callable, Iterator
from typing import NoReturn

import viser
from inhand_runtime.errors import InhandError

from inhand_studio.visit import Visit


class PageServer(viser.ViserServer):
    """A server of pages that asks no other machine for anything."""

    def request_share_url(self, verbose: bool = True) -> NoReturn:
        """Refuse to let a browser make these pages public through another host."""
        raise InhandError("the studio is not shared through other hosts")


@contextlib.contextmanager
def serving(host: str, port: int, visit_of: Callable[[viser.ClientHandle], Visit]) -> Iterator[int]:
    """Serve pages until the block ends, and give the port: a free one where ``port`` is 0.

    Each browser tab is a visit, which is opened and closed in threads of the server. Raises
    InhandError where the port is taken.
    """
    with contextlib.redirect_stdout(io.StringIO()):  # viser announces its address by itself
        server = PageServer(host, port, label="Inhand", verbose=False)
    try:
        if port not in (0, server.get_port()):
            raise InhandError(
                f"another program listens on {host}:{port}: choose another port of the studio"
            )
        # Once for all: a view that is set together with it is turned by the direction before.
        server.scene.set_up_direction("-y")
        server.gui.configure_theme(control_width="large", show_logo=False, show_share_button=False)
        _watch_visits(server, visit_of)
        yield server.get_port()
    finally:
        with contextlib.redirect_stdout(io.StringIO()):
            server.stop()


def _watch_visits(server: PageServer, visit_of: Callable[[viser.ClientHandle], Visit]) -> None:
    visits: dict[int, Visit] = {}
    lock = threading.Lock()

    # What is async runs in the order of what happens, so that no visit is closed before it opens.
    @server.on_client_connect
    async def _(client: viser.ClientHandle) -> None:
        visit = visit_of(client)
        with lock:
            visits[client.client_id] = visit
        threading.Thread(target=visit.open, name=f"visit {client.client_id}", daemon=True).start()

    @server.on_client_disconnect
    async def _(client: viser.ClientHandle) -> None:
        with lock:
            visit = visits.pop(client.client_id)
        threading.Thread(target=visit.close, name=f"visit {client.client_id}", daemon=True).start()
