"""The gate itself: it listens where the settings say, and forwards what may pass."""

import asyncio
import contextlib
import logging
import socket
import threading
from collections.abc import Iterator

from aiohttp import http_exceptions, web

from inhand_studio.access.forwarding import Forwarder
from inhand_studio.access.gatekeeper import Gatekeeper
from inhand_studio.access.listening import listen
from inhand_studio.access.parameters import DEFAULT_GATE
from inhand_studio.access.settings import AccessSettings
from inhand_studio.access.terms import Terms, terms_of

log = logging.getLogger(__name__)


def _is_no_rubbish(record: logging.LogRecord) -> bool:
    """Whether a fault is of ours: what is no HTTP is answered, and may be of anybody."""
    fault = record.exc_info[1] if record.exc_info else None
    return not isinstance(fault, http_exceptions.HttpProcessingError)


log.addFilter(_is_no_rubbish)


@contextlib.contextmanager
def gate(settings: AccessSettings, inner: tuple[str, int]) -> Iterator[str]:
    """Forward to the ``inner`` server's address and port until the block ends; gives the URL.

    Raises SettingsError for what ``terms_of`` checks, and InhandError where the port is taken.
    """
    terms = terms_of(settings)
    sockets = listen(settings.host, settings.port)
    port = sockets[0].getsockname()[1]
    host = f"[{settings.host}]" if ":" in settings.host else settings.host
    with _served(terms, inner, sockets):
        yield f"{'http' if terms.tls is None else 'https'}://{host}:{port}/"


@contextlib.contextmanager
def _served(terms: Terms, inner: tuple[str, int], sockets: list[socket.socket]) -> Iterator[None]:
    """Serve in a thread of its own until the block ends, which ends all connections."""
    loop = asyncio.new_event_loop()
    thread = threading.Thread(target=loop.run_forever, name="gate")
    thread.start()
    try:
        runner = asyncio.run_coroutine_threadsafe(_start(terms, inner, sockets), loop).result()
        try:
            yield
        finally:
            asyncio.run_coroutine_threadsafe(_end(runner), loop).result()
    finally:
        loop.call_soon_threadsafe(loop.stop)
        thread.join()
        loop.close()


async def _start(
    terms: Terms, inner: tuple[str, int], sockets: list[socket.socket]
) -> web.AppRunner:
    forwarder = Forwarder(inner)
    app = web.Application(client_max_size=DEFAULT_GATE.largest_form_bytes)
    app.router.add_route("*", "/{path:.*}", Gatekeeper(terms, forwarder).answer)

    async def end(_app: web.Application) -> None:
        await forwarder.close()

    app.on_shutdown.append(end)
    # No log of requests: their addresses would tell who looks when.
    runner = web.AppRunner(
        app,
        logger=log,
        access_log=None,
        handle_signals=False,
        shutdown_timeout=2 * DEFAULT_GATE.closing_s,
    )
    await runner.setup()
    for one in sockets:
        await web.SockSite(runner, one, ssl_context=terms.tls).start()
    return runner


async def _end(runner: web.AppRunner) -> None:
    """End all connections, also of a browser that takes no more bytes, and let the loop do what
    their end has left to it."""
    connections = [] if runner.server is None else runner.server.connections
    transports = [one.transport for one in connections]
    await runner.cleanup()
    for transport in transports:
        if transport is not None:
            transport.abort()
    await asyncio.sleep(0.0)
