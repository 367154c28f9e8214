"""The gate over real sockets, with a small server behind it."""

import asyncio
import http.client
import socket
import ssl
from pathlib import Path
from urllib.parse import urlencode, urlsplit

import pytest
from gated import PASSWORD, certificate, gated, inner_server, password_file
from inhand_runtime.errors import InhandError
from inhand_studio.access.gate import gate
from inhand_studio.access.parameters import DEFAULT_GATE as GATE
from inhand_studio.access.settings import AccessSettings
from websockets.asyncio.client import connect as connect_in_a_loop
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Origin


def _ask(
    url: str,
    path: str = "/",
    form: str | None = None,
    tls: ssl.SSLContext | None = None,
    **headers: str,
) -> tuple[int, http.client.HTTPMessage, str]:
    """Ask for a path, or send a password; returns status, headers and text."""
    address = urlsplit(url).netloc
    plain = url.startswith("http:")
    made = (
        http.client.HTTPConnection(address)
        if plain
        else http.client.HTTPSConnection(address, context=tls)
    )
    body = None if form is None else urlencode({"password": form})
    if form is not None:
        headers = {
            "Origin": url[:-1],
            "Content-Type": "application/x-www-form-urlencoded",
        } | headers
    made.request("GET" if form is None else "POST", path, body, headers)
    answer = made.getresponse()
    text = answer.read().decode()
    made.close()
    return answer.status, answer.headers, text


def _socket(url: str, path: str = "/echo", **options: object) -> ClientConnection:
    origin = url[:-1]
    options = {"origin": origin, "compression": None, "max_size": None, **options}
    return connect(url.replace("http", "ws", 1)[:-1] + path, **options)  # type: ignore[arg-type]


async def _echoed(url: str, tls: ssl.SSLContext, cookie: str) -> str | bytes:
    """What comes back of a word over TLS, in one thread: two that read and write one encrypted
    socket at once may wait for each other."""
    address = url.replace("http", "ws", 1)[:-1] + "/echo"
    own = {"Cookie": cookie}
    async with connect_in_a_loop(
        address, origin=Origin(url[:-1]), ssl=tls, additional_headers=own
    ) as made:
        await made.send("in")
        return await made.recv()


def _status(url: str, **options: object) -> int:
    """Return the status with which a WebSocket is refused."""
    with pytest.raises(InvalidStatus) as refused:
        _socket(url, **options)
    return refused.value.response.status_code


def test_pages_of_this_machine_are_forwarded_and_may_ask_nothing_of_others() -> None:
    with gated() as (inner, url):
        status, headers, text = _ask(url, "/a%2Fb?c=d", Cookie="x=1", Authorization="secret")
        assert (status, text) == (200, "inside /a%2Fb?c=d")
        assert "default-src 'none'" in headers["Content-Security-Policy"]
        assert "frame-ancestors 'none'" in headers["Content-Security-Policy"]
        assert "Cookie" not in inner.asked[0]
        assert "Authorization" not in inner.asked[0]


def test_a_page_of_another_site_reaches_nothing() -> None:
    with gated() as (inner, url):
        assert _ask(url, Host="evil.example")[0] == 421
        assert _ask(url, Origin="https://evil.example")[0] == 403
        assert _status(url, origin="https://evil.example") == 403
        assert _status(url, origin=None) == 403
        assert _status(url, origin="http://evil.example", additional_headers={}) == 403
        assert not inner.asked


def test_only_the_inner_server_is_ever_asked() -> None:
    with gated() as (_, url), socket.create_server(("127.0.0.1", 0)) as other:
        host, port = urlsplit(url).hostname, urlsplit(url).port
        target = f"127.0.0.1:{other.getsockname()[1]}"
        for path in (f"http://{target}/", f"@{target}/", f"//{target}/", f"/\\{target}/"):
            with socket.create_connection((host, port)) as made:
                made.sendall(f"GET {path} HTTP/1.1\r\nHost: localhost\r\n\r\n".encode())
                made.recv(100)
        other.settimeout(0.0)
        with pytest.raises(BlockingIOError):
            other.accept()


def test_a_socket_carries_text_bytes_and_the_chosen_protocol_both_ways_and_its_end() -> None:
    large = bytes(range(256)) * (1 << 12)
    with gated() as (_, url), _socket(url, subprotocols=["viser-v1", "other-v1"]) as made:
        assert made.subprotocol == "other-v1"
        for message in ("grüße", large, b""):
            made.send(message)
            assert made.recv() == message
        made.send("end")
        with pytest.raises(ConnectionClosed) as ended:
            made.recv()
        assert ended.value.rcvd is not None
        assert ended.value.rcvd.code == 4001


@pytest.mark.long
def test_a_browser_that_does_not_read_makes_nothing_grow_and_slows_nobody() -> None:
    with gated() as (inner, url):
        stuck = _socket(url, "/flood", max_queue=1)
        with _socket(url) as other:
            before = -1
            while inner.pieces > before:  # until the flood stands still
                before = inner.pieces
                for number in range(200):
                    other.send(str(number))
                    assert other.recv() == str(number)
        assert inner.pieces <= 32
        stuck.socket.close()


def test_with_a_password_nothing_passes_before_it_is_given(tmp_path: Path) -> None:
    with gated(password_file=password_file(tmp_path)) as (inner, url):
        status, headers, text = _ask(url, "/somewhere")
        assert status == 401
        assert 'type="password"' in text
        assert "default-src 'none'" in headers["Content-Security-Policy"]
        assert _status(url) == 401
        assert _ask(url, "/login", "wrong", Origin="https://evil.example")[0] == 403
        assert _ask(url, "/login", "wrong")[0] == 401
        assert _ask(url, Cookie=f"inhand_studio_{urlsplit(url).port}=guess")[0] == 401
        assert not inner.asked

        status, headers, _ = _ask(url, "/login", PASSWORD)
        assert (status, headers["Location"]) == (303, "/")
        cookie = headers["Set-Cookie"]
        assert "HttpOnly" in cookie
        assert "SameSite=Strict" in cookie
        given = cookie.partition(";")[0]
        assert _ask(url, Cookie=given)[2] == "inside /"
        with _socket(url, additional_headers={"Cookie": given}) as made:
            made.send("in")
            assert made.recv() == "in"
        assert _ask(url, Cookie=given, Host="evil.example")[0] == 421


def test_who_fails_too_often_must_wait_and_it_is_logged_without_what_was_tried(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    with gated(password_file=password_file(tmp_path)) as (_, url):
        for _ in range(GATE.failures_an_address):
            assert _ask(url, "/login", "my other password")[0] == 401
        status, headers, text = _ask(url, "/login", PASSWORD)
        assert status == 429
        assert 0 < int(headers["Retry-After"]) <= GATE.window_s
        assert "Too many" in text
    assert f"{GATE.failures_an_address} failed logins so far" in caplog.text
    assert "my other password" not in caplog.text
    assert PASSWORD not in caplog.text


def test_with_a_certificate_pages_sockets_and_the_cookie_are_encrypted(tmp_path: Path) -> None:
    files = certificate(tmp_path)
    trusting = ssl.create_default_context(cafile=str(files["certificate"]))
    with gated(password_file=password_file(tmp_path), **files) as (_, url):
        assert url.startswith("https://")
        _, headers, _ = _ask(url, "/login", PASSWORD, trusting)
        assert "Secure" in headers["Set-Cookie"]
        given = headers["Set-Cookie"].partition(";")[0]
        assert _ask(url, tls=trusting, Cookie=given)[2] == "inside /"
        assert asyncio.run(_echoed(url, trusting, given)) == "in"
        with pytest.raises(http.client.HTTPException):
            _ask(url.replace("https", "http"))


@pytest.mark.long
def test_a_gate_ends_at_once_with_sockets_open_that_nobody_reads() -> None:
    with inner_server() as (_, address):
        with gate(AccessSettings(port=0), address) as url:
            stuck = _socket(url, "/flood", max_queue=1)
            idle = _socket(url)
        with pytest.raises(ConnectionClosed):
            idle.recv()
        stuck.socket.close()


def test_pages_that_do_not_answer_are_said_so() -> None:
    with socket.create_server(("127.0.0.1", 0)) as nobody:
        address = nobody.getsockname()
    with gate(AccessSettings(port=0), address) as url:
        assert _ask(url)[0] == 502
        assert _status(url) == 502


def test_a_taken_port_is_refused_and_no_other_one_is_taken() -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        with (
            pytest.raises(InhandError, match=f"port {port}: another program listens there"),
            gate(AccessSettings(port=port), ("127.0.0.1", 1)),
        ):
            pass


def test_rubbish_is_refused_without_a_traceback_in_the_log(
    caplog: pytest.LogCaptureFixture,
) -> None:
    with gated() as (_, url):
        host, port = urlsplit(url).hostname, urlsplit(url).port
        for rubbish in (
            b"\x16\x03\x01\x02\x00rubbish\r\n\r\n",
            b"GET / HTTP/1.1\r\n\r\n",
            b"\0" * 99,
        ):
            with socket.create_connection((host, port)) as made:
                made.sendall(rubbish)
                made.shutdown(socket.SHUT_WR)
                while made.recv(4096):
                    pass
        assert _ask(url)[0] == 200
    assert "Traceback" not in caplog.text
