"""Where pages are served."""

import socket
from pathlib import Path

import pytest
from inhand_runtime.errors import InhandError
from inhand_studio.server import PageServer, serving
from inhand_studio.studio import Studio
from inhand_studio.visit import Visit


def _serving(port: int):  # type: ignore[no-untyped-def]
    return serving("127.0.0.1", port, lambda one: Visit(one, Studio(Path()), {}, "Live"))


def test_a_taken_port_is_refused_and_no_other_one_is_taken_instead() -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        with (
            pytest.raises(InhandError, match="another program listens"),
            _serving(taken.getsockname()[1]),
        ):
            pass


def test_pages_are_served_on_the_given_address_alone() -> None:
    with _serving(0) as port:
        with socket.create_connection(("127.0.0.1", port)):
            pass
        with pytest.raises(ConnectionRefusedError):
            socket.create_connection(("127.0.0.2", port))


def test_no_page_is_shared_through_another_host() -> None:
    with pytest.raises(InhandError, match="not shared"):
        PageServer.request_share_url(object.__new__(PageServer))
