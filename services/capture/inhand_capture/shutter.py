"""The shutter of a camera: while it is closed nothing is captured, and nothing is published.

Whether it is closed is a file in the folder for data, so that it survives restarts; the file is
written before anybody is told that the shutter is closed.
"""

import logging
import os
import threading
import time
from pathlib import Path
from typing import Generic, TypeVar

from inhand_runtime.data_folder import data_folder
from inhand_runtime.errors import SettingsError
from inhand_schemas.keys import Site
from inhand_schemas.messages import Message
from inhand_schemas.topics import Topic

from inhand_capture.publishing import Outlet, Outlets

log = logging.getLogger(__name__)

T = TypeVar("T", bound=Message)
T_contra = TypeVar("T_contra", bound=Message, contravariant=True)
POLL_S = 0.05


class ShutterFile:
    """Keeps whether a camera's shutter is closed."""

    def __init__(self, site: Site, camera: str) -> None:
        self.path: Path = data_folder() / "shutters" / f"{site.realm}.{site.rig}.{camera}.closed"

    def is_closed(self) -> bool:
        """Whether it is closed; raises OSError when that cannot be read."""
        return self.path.exists()

    def write(self, *, closed: bool) -> None:
        """Keep it through a restart, and a loss of power; raises OSError."""
        if not closed:
            self.path.unlink(missing_ok=True)
            return
        self.path.parent.mkdir(parents=True, exist_ok=True)
        with self.path.open("wb") as file:
            file.flush()
            os.fsync(file.fileno())
        folder = os.open(self.path.parent, os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)


class Shutter:
    """One camera's shutter, from any thread."""

    def __init__(self, file: ShutterFile, *, closed: bool) -> None:
        self._file = file
        self._moving = threading.Lock()
        self._sending = threading.Lock()
        self._closed = closed
        self.closings = 0
        """How often it was closed so far."""

    def is_closed(self) -> bool:
        """Whether it is closed now."""
        return self._closed

    def move(self, *, closed: bool) -> str | None:
        """Close or open it; what is being sent is sent first, and nothing after a closing.

        Returns why it will not stay so through a restart; None when it will.
        """
        with self._moving:
            moves = closed != self._closed
            if closed and moves:
                with self._sending:
                    self._closed = True
                    self.closings += 1
            problem = self._keep(closed=closed)
            self._closed = closed
        if moves:
            log.info("the shutter is %s", "closed" if closed else "open")
        return problem

    def send(self, outlet: "Outlet[T_contra]", message: T_contra) -> None:
        """Send a message unless the shutter is closed."""
        with self._sending:
            if not self._closed:
                outlet.put(message)

    def _keep(self, *, closed: bool) -> str | None:
        try:
            self._file.write(closed=closed)
        except OSError as error:
            word = "closed" if closed else "open"
            return (
                f"it is {word} until the next start only: {self._file.path} cannot be written "
                f"({error.strerror}); set INHAND_DATA to a folder that can"
            )
        return None


def kept_shutter(site: Site, camera: str) -> Shutter:
    """The shutter as it was left; raises SettingsError when that cannot be known."""
    file = ShutterFile(site, camera)
    try:
        return Shutter(file, closed=file.is_closed())
    except OSError as error:
        raise SettingsError(
            f"whether the shutter is closed cannot be read from {file.path}: {error.strerror}; set "
            "INHAND_DATA to a folder that this user can read"
        ) from None


class ShutteredOutlet(Generic[T_contra]):
    """An outlet behind a shutter: while that is closed nobody is listened to, and nothing sent."""

    def __init__(self, outlet: "Outlet[T_contra]", shutter: Shutter) -> None:
        self._outlet = outlet
        self._shutter = shutter

    def put(self, message: T_contra) -> None:
        """Send a message, if the shutter is open."""
        self._shutter.send(self._outlet, message)

    def wanted(self) -> bool:
        """Whether anybody listens now, and may."""
        return not self._shutter.is_closed() and self._outlet.wanted()


class ShutteredOutlets:
    """Outlets behind one shutter."""

    def __init__(self, outlets: Outlets, shutter: Shutter) -> None:
        self._outlets = outlets
        self._shutter = shutter

    def publisher(self, topic: Topic[T], name: str) -> Outlet[T]:
        """The outlet of a topic under one name; how the camera sees may always be known."""
        outlet = self._outlets.publisher(topic, name)
        return outlet if topic.delivery.kept else ShutteredOutlet(outlet, self._shutter)


class EndOfCapture:
    """Set while a daemon stops or its shutter is closed: either ends what is being captured."""

    def __init__(self, stop: threading.Event, shutter: Shutter) -> None:
        self._stop = stop
        self._shutter = shutter

    def is_set(self) -> bool:
        """Whether capturing has to end."""
        return self._stop.is_set() or self._shutter.is_closed()

    def wait(self, timeout: float) -> bool:
        """Wait until capturing has to end, or for seconds; returns whether it has to."""
        end = time.monotonic() + timeout
        while not self.is_set():
            rest = end - time.monotonic()
            if rest <= 0.0:
                return False
            self._stop.wait(min(rest, POLL_S))
        return True
