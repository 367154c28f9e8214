"""A link between two sockets that is cut, late, slow, lossy, or whole."""

import socket
import time
from collections.abc import Iterator

import pytest
from inhand_lab.chaos.link import Condition, Link


@pytest.fixture
def ends() -> Iterator[tuple[Link, socket.socket, socket.socket]]:
    """A link, and the sockets at both of its ends."""
    with (
        socket.create_server(("127.0.0.1", 0)) as server,
        Link(server.getsockname()[1]).open() as link,
        socket.create_connection(("127.0.0.1", link.port)) as near,
    ):
        far, _ = server.accept()
        with far:
            near.settimeout(5.0)
            far.settimeout(5.0)
            yield link, near, far


def received(end: socket.socket, count: int) -> bytes:
    """So many bytes that come at an end."""
    data = b""
    while len(data) < count:
        data += end.recv(65536)
    return data


def test_a_whole_link_passes_bytes_on_in_both_directions(
    ends: tuple[Link, socket.socket, socket.socket],
) -> None:
    _, near, far = ends
    sent = bytes(range(256)) * 2000
    near.sendall(sent)
    assert received(far, len(sent)) == sent
    far.sendall(b"back")
    assert received(near, 4) == b"back"


def test_nothing_passes_a_cut_link_and_everything_comes_once_it_is_mended(
    ends: tuple[Link, socket.socket, socket.socket],
) -> None:
    link, near, far = ends
    far.settimeout(0.3)
    with link.being(Condition(cut=True)):
        near.sendall(b"held")
        with pytest.raises(TimeoutError):
            far.recv(1)
    far.settimeout(5.0)
    assert received(far, 4) == b"held"


@pytest.mark.parametrize(
    ("condition", "count", "least_s"),
    [
        (Condition(delay_s=0.25), 4, 0.25),
        (Condition(bytes_per_s=100_000.0), 50_000, 0.5),
        (Condition(lost=1.0), 5, 0.3),
    ],
    ids=["late", "slow", "lossy"],
)
def test_bytes_take_as_long_as_the_link_s_condition_says(
    ends: tuple[Link, socket.socket, socket.socket],
    condition: Condition,
    count: int,
    least_s: float,
) -> None:
    link, near, far = ends
    sent = bytes(number % 251 for number in range(count))
    with link.being(condition):
        begin = time.monotonic()
        near.sendall(sent)
        assert received(far, count) == sent
        assert time.monotonic() - begin >= least_s


def test_the_end_of_a_connection_reaches_the_other_end(
    ends: tuple[Link, socket.socket, socket.socket],
) -> None:
    _, near, far = ends
    near.sendall(b"last")
    near.shutdown(socket.SHUT_WR)
    assert received(far, 4) == b"last"
    assert far.recv(1) == b""


def test_who_cannot_be_reached_ends_a_connection_at_once() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        nobody = server.getsockname()[1]
    with (
        Link(nobody).open() as link,
        socket.create_connection(("127.0.0.1", link.port)) as near,
    ):
        near.settimeout(5.0)
        assert near.recv(1) == b""
