"""A small server behind the gate, and what a browser says to it over real sockets."""

import asyncio
import contextlib
import socket
import subprocess
import threading
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from aiohttp import web
from inhand_studio.access.gate import gate
from inhand_studio.access.settings import AccessSettings

PASSWORD = "correct horse battery"
PIECE = bytes(1 << 20)


@dataclass
class Inner:
    """What the inner server was asked, and how many megabytes of its flood it got rid of."""

    asked: list[Any] = field(default_factory=list)
    pieces: int = 0


@contextlib.contextmanager
def inner_server() -> Iterator[tuple[Inner, tuple[str, int]]]:
    """Run a server with a page, a WebSocket that echoes, and one that sends without end."""
    seen = Inner()

    async def page(request: web.Request) -> web.Response:
        seen.asked.append(request.headers)
        return web.Response(text=f"inside {request.path_qs}", content_type="text/html")

    async def echo(request: web.Request) -> web.WebSocketResponse:
        answer = web.WebSocketResponse(protocols=("other-v1",), max_msg_size=0)
        await answer.prepare(request)
        async for message in answer:
            if message.data == "end":
                await answer.close(code=4001)
            elif isinstance(message.data, str):
                await answer.send_str(message.data)
            else:
                await answer.send_bytes(message.data)
        return answer

    async def flood(request: web.Request) -> web.WebSocketResponse:
        answer = web.WebSocketResponse(compress=False)
        await answer.prepare(request)
        with contextlib.suppress(ConnectionError):
            while True:
                await answer.send_bytes(PIECE)
                seen.pieces += 1
        return answer

    app = web.Application()
    app.add_routes([web.get("/echo", echo), web.get("/flood", flood), web.get("/{any:.*}", page)])
    loop = asyncio.new_event_loop()
    thread = threading.Thread(target=loop.run_forever)
    thread.start()
    runner = web.AppRunner(app, handle_signals=False, shutdown_timeout=0.1)
    try:
        with socket.create_server(("127.0.0.1", 0)) as listening:

            async def start() -> None:
                await runner.setup()
                await web.SockSite(runner, listening).start()

            async def end() -> None:
                assert runner.server is not None
                transports = [one.transport for one in runner.server.connections]
                await runner.cleanup()
                for transport in transports:
                    if transport is not None:
                        transport.abort()
                await asyncio.sleep(0.0)

            asyncio.run_coroutine_threadsafe(start(), loop).result()
            try:
                yield seen, listening.getsockname()
            finally:
                asyncio.run_coroutine_threadsafe(end(), loop).result()
    finally:
        loop.call_soon_threadsafe(loop.stop)
        thread.join()
        loop.close()


@contextlib.contextmanager
def gated(**settings: Any) -> Iterator[tuple[Inner, str]]:
    """Run the inner server behind a gate, and give its URL."""
    with (
        inner_server() as (seen, address),
        gate(AccessSettings(port=0, **settings), address) as url,
    ):
        yield seen, url


def password_file(folder: Path, text: str = PASSWORD + "\n") -> Path:
    """Write the password where only its user reads it."""
    path = folder / "password"
    path.write_text(text)
    path.chmod(0o600)
    return path


def certificate(folder: Path) -> dict[str, Path]:
    """Make a self-signed certificate for this machine; returns the settings that name it."""
    made = {"certificate": folder / "cert.pem", "private_key": folder / "key.pem"}
    command = ["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256"]
    command += ["-nodes", "-subj", "/CN=localhost", "-addext", "subjectAltName=IP:127.0.0.1"]
    command += ["-out", str(made["certificate"]), "-keyout", str(made["private_key"])]
    subprocess.run(command, check=True, capture_output=True)
    return made
