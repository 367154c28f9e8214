"""Links that close at once, beside descriptors whose number was a link's a moment ago."""

import fcntl
import os
import socket
import struct
from collections.abc import Iterator
from pathlib import Path

import pytest
from inhand_runtime.lingering import close_at_once, let_not_linger

LINGERS = struct.pack("ii", 1, 10)


@pytest.fixture
def link() -> Iterator[tuple[socket.socket, tuple[int, int]]]:
    """A socket that lingers for 10 s, and its ports: its own and the other end's."""
    with (
        socket.create_server(("127.0.0.1", 0)) as server,
        socket.create_connection(server.getsockname()) as opened,
        server.accept()[0],
    ):
        opened.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, LINGERS)
        yield opened, (opened.getsockname()[1], opened.getpeername()[1])


def lingers(link: socket.socket) -> bool:
    return bool(link.getsockopt(socket.SOL_SOCKET, socket.SO_LINGER))


def test_only_the_socket_between_the_two_ends_closes_at_once(
    link: tuple[socket.socket, tuple[int, int]],
) -> None:
    opened, (own, other) = link
    close_at_once((f"tcp/127.0.0.1:{other}", f"tcp/127.0.0.1:{own + 1}"))
    assert lingers(opened)
    close_at_once((f"tcp/127.0.0.1:{own}", f"tcp/127.0.0.1:{other}"))
    assert not lingers(opened)


def test_a_socket_that_took_a_link_s_number_stays_as_it_is(
    link: tuple[socket.socket, tuple[int, int]],
) -> None:
    opened, (own, other) = link
    let_not_linger(opened.fileno(), (own, other + 1))
    assert lingers(opened)


def test_a_locked_folder_that_took_a_link_s_number_is_free_when_it_is_closed(
    tmp_path: Path,
) -> None:
    locked = os.open(tmp_path, os.O_RDONLY)
    fcntl.flock(locked, fcntl.LOCK_EX)
    let_not_linger(locked, (1, 2))
    os.close(locked)
    again = os.open(tmp_path, os.O_RDONLY)
    fcntl.flock(again, fcntl.LOCK_EX | fcntl.LOCK_NB)  # fails while anybody holds it
    os.close(again)


def test_a_number_that_nothing_has_any_more_is_passed_over() -> None:
    reading, writing = os.pipe()
    os.close(reading)
    os.close(writing)
    let_not_linger(reading, (1, 2))
