"""Viewers of a studio without a browser: they count what they get, and answer as a browser does."""

import asyncio
import contextlib
import threading
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import msgspec
import viser
import websockets
import zstandard

CAMERA = {
    "type": "ViewerCameraMessage",
    "wxyz": (1.0, 0.0, 0.0, 0.0),
    "position": (0.0, 0.0, 0.0),
    "fov": 1.0,
    "near": 0.1,
    "far": 100.0,
    "image_height": 600,
    "image_width": 800,
    "look_at": (0.0, 0.0, 2.0),
    "up_direction": (0.0, -1.0, 0.0),
}
_FIELDS = {"SetCameraPositionMessage": "position", "SetCameraLookAtMessage": "look_at"}


@dataclass
class Viewer:
    """One viewer; it ``reads`` or is stuck, and ``answers`` when its camera is set or hangs then.

    ``pictures`` and ``size`` (bytes) are what it got.
    """

    url: str
    reads: bool = True
    answers: bool = True
    pictures: int = 0
    size: int = 0
    camera: dict[str, Any] = field(default_factory=lambda: dict(CAMERA))

    async def look(self) -> None:
        """Look until it is cancelled."""
        protocol = websockets.Subprotocol(f"viser-v{viser.__version__}")
        address = self.url.replace("http", "ws", 1)
        stuck: dict[str, Any] = {} if self.reads else {"max_queue": 1, "ping_interval": None}
        async with websockets.connect(
            address,
            origin=websockets.Origin(self.url.rstrip("/")),
            subprotocols=[protocol],
            max_size=None,
            compression=None,
            close_timeout=0.1,
            **stuck,
        ) as socket:
            await socket.send(msgspec.msgpack.encode(self.camera))
            if not self.reads:
                socket.transport.pause_reading()  # as a browser that hangs
                await asyncio.Event().wait()
            async for data in socket:
                assert isinstance(data, bytes)
                self.size += len(data)
                if self._take(_messages(data)) and self.answers:
                    await socket.send(msgspec.msgpack.encode(self.camera))

    def _take(self, messages: list[dict[str, Any]]) -> bool:
        """Do as a browser with messages; returns whether its camera was set."""
        answers = False
        for message in messages:
            kind = message["type"]
            if kind == "BackgroundImageMessage" and message["rgb_data"] is not None:
                self.pictures += 1
            elif kind == "SetCameraFovMessage":
                self.camera["fov"] = message["fov"]
                answers = True
            elif kind in _FIELDS:
                self.camera[_FIELDS[kind]] = message[_FIELDS[kind]]
        return answers


@contextlib.contextmanager
def looking(viewers: list[Viewer]) -> Iterator[None]:
    """Let viewers look, in a thread, until the block ends."""
    failed: list[Exception] = []
    runner = asyncio.Runner()
    loop = runner.get_loop()
    ended = asyncio.Event()

    async def look() -> None:
        tasks = [asyncio.create_task(one.look()) for one in viewers]
        first = asyncio.create_task(ended.wait())
        await asyncio.wait((first, *tasks), return_when=asyncio.FIRST_COMPLETED)
        failed.extend(error for one in tasks if one.done() and (error := one.exception()))

    def run() -> None:
        with runner:
            runner.run(look())

    thread = threading.Thread(target=run)
    thread.start()
    try:
        yield
    finally:
        if not failed:
            loop.call_soon_threadsafe(ended.set)
        thread.join()
    assert not failed, failed[0]


def _messages(data: bytes) -> list[dict[str, Any]]:
    """Unpack what the server sends at a time."""
    packed = int.from_bytes(data[8:16], "little")
    unpacked = zstandard.ZstdDecompressor().decompress(data[16 : 16 + packed])
    messages: list[dict[str, Any]] = msgspec.msgpack.decode(unpacked)["messages"]
    return messages
