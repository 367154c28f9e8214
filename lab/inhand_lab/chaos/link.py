"""A link between two hosts, as a relay of this process that can be cut, slow, late or lossy."""

import asyncio
import random
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

CHUNK_BYTES = 16_384
WAITING_CHUNKS = 64
"""Number of chunks, 1 MiB, that wait in the link one way before a sender is held up."""
POLL_S = 0.02
HOST = "127.0.0.1"


@dataclass(frozen=True)
class Condition:
    """How a link is: whether it is ``cut``, how long each byte is under way (``delay_s``), how many
    bytes pass a second (None: any number), and what share of chunks is lost and comes a time of
    retransmission later."""

    cut: bool = False
    delay_s: float = 0.0
    bytes_per_s: float | None = None
    lost: float = 0.0


RETRANSMITTED_AFTER_S = 0.3
"""Seconds after which TCP sends again what was lost, at the least 0.2 in Linux."""


class Link:
    """A relay to ``upstream``, a port of this machine, that clients reach by another ``port``."""

    def __init__(self, upstream: int) -> None:
        self.port = 0
        self.condition = Condition()
        self._upstream = upstream
        self._loop = asyncio.new_event_loop()
        self._random = random.Random(0)

    @contextmanager
    def open(self) -> Iterator["Link"]:
        """Relay until the block ends."""
        server = self._loop.run_until_complete(asyncio.start_server(self._relay, HOST, 0))
        self.port = int(server.sockets[0].getsockname()[1])
        thread = threading.Thread(target=self._loop.run_forever, name="link", daemon=True)
        thread.start()
        try:
            yield self
        finally:
            asyncio.run_coroutine_threadsafe(self._end(server), self._loop).result()
            self._loop.call_soon_threadsafe(self._loop.stop)
            thread.join()
            self._loop.close()

    @contextmanager
    def being(self, condition: Condition) -> Iterator[None]:
        """Let the link be in a condition until the block ends."""
        before, self.condition = self.condition, condition
        try:
            yield
        finally:
            self.condition = before

    async def _end(self, server: asyncio.Server) -> None:
        server.close()
        tasks = asyncio.all_tasks(self._loop) - {asyncio.current_task()}
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    async def _relay(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        try:
            further, back = await asyncio.open_connection(HOST, self._upstream)
        except OSError:  # the hub is away: so the client is told
            writer.close()
            return
        async with asyncio.TaskGroup() as ways:
            ways.create_task(self._pass_on(reader, back))
            ways.create_task(self._pass_on(further, writer))

    async def _pass_on(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Pass bytes on in one direction until their sender, or who takes them, ends it."""
        waiting = asyncio.Queue[tuple[float, bytes]](WAITING_CHUNKS)
        try:
            async with asyncio.TaskGroup() as ways:
                ways.create_task(self._take(reader, waiting))
                ways.create_task(self._send(waiting, writer))
        except* OSError:
            pass  # as links end
        finally:
            writer.close()

    async def _take(
        self, reader: asyncio.StreamReader, waiting: "asyncio.Queue[tuple[float, bytes]]"
    ) -> None:
        data = b"-"
        while data:
            data = await reader.read(CHUNK_BYTES)
            await waiting.put((self._loop.time(), data))

    async def _send(
        self, waiting: "asyncio.Queue[tuple[float, bytes]]", writer: asyncio.StreamWriter
    ) -> None:
        while True:
            came, data = await waiting.get()
            while self.condition.cut:
                await asyncio.sleep(POLL_S)
            condition = self.condition
            await asyncio.sleep(max(came + condition.delay_s - self._loop.time(), 0.0))
            if self._random.random() < condition.lost:
                await asyncio.sleep(RETRANSMITTED_AFTER_S)
            if condition.bytes_per_s is not None:
                await asyncio.sleep(len(data) / condition.bytes_per_s)
            if not data:
                return
            writer.write(data)
            await writer.drain()
