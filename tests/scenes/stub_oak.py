"""Stands for the sensor nodes of an OAK camera, and for nothing else: depthai runs all the rest.

A host-only pipeline, whose one node sends recorded colour and depth as the device would: frames
with the device's numbers and times, and the lens that they were taken with.
"""

import queue
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from datetime import timedelta
from pathlib import Path

import numpy as np
import simplejpeg
from inhand_capture.sources.oak.connection import Connection
from inhand_capture.sources.oak.library import dai
from inhand_capture.sources.oak.options import OakOptions
from inhand_runtime.pixels import decode_colour, decode_depth
from inhand_runtime.recording import read_recording
from inhand_schemas.topics import RGBD
from numpy.typing import NDArray

FOCAL = 500.0
Shot = tuple[NDArray[np.uint8], NDArray[np.uint16]]


@dataclass(frozen=True)
class Shots(Sequence[Shot]):
    """Pictures that show their number, made when asked for: depth is 1000 + n, colour's red n."""

    count: int
    width: int = 640
    height: int = 480

    def __len__(self) -> int:
        return self.count

    def __getitem__(self, number):
        if not 0 <= number < self.count:
            raise IndexError(number)
        colour = np.zeros((self.height, self.width, 3), np.uint8)
        colour[..., 0] = number
        return colour, np.full((self.height, self.width), 1000 + number, np.uint16)


def recorded_shots(path: Path) -> list[Shot]:
    """Colour and depth of a recording of one camera."""
    frames = [recorded.message() for recorded in read_recording(path, streams=(RGBD.stream,))]
    return [(decode_colour(frame.colour), decode_depth(frame.depth)) for frame in frames]


@dataclass(frozen=True)
class Exposure:
    """One command to the sensors: what is sent, and how it is stamped."""

    number: int
    colour: bool = True
    depth: bool = True
    depth_number: int | None = None
    depth_later_s: float = 0.0


class SensorNodes(dai.node.ThreadedHostNode):
    """Sends what it is told to, each exposure stamped with the time at which it is sent."""

    def __init__(self) -> None:
        super().__init__()
        self.colour = self.createOutput()
        self.depth = self.createOutput()
        self.shots: Sequence[Shot] = ()
        self.mjpeg = False
        self.focal = FOCAL
        self.period_s = 0.001
        self.commands: queue.Queue[Exposure] = queue.Queue()
        self.sent: dict[int, int] = {}
        """The host's monotonic time of each exposure, in nanoseconds."""

    def run(self) -> None:
        """Work off the commands until the pipeline stops."""
        while self.mainLoop():
            try:
                self._expose(self.commands.get(timeout=0.02))
            except queue.Empty:
                continue
            finally:
                time.sleep(self.period_s)

    def _expose(self, command: Exposure) -> None:
        now_ns = time.monotonic_ns() // 1000 * 1000
        self.sent[command.number] = now_ns
        colour, depth = self.shots[command.number % len(self.shots)]
        if command.colour:
            frame = self._encoded(colour) if self.mjpeg else self._raw(colour)
            self.colour.send(self._stamped(frame, colour, command.number, now_ns))
        if command.depth:
            image = dai.ImgFrame()
            image.setCvFrame(depth, dai.ImgFrame.Type.RAW16)
            number = command.number if command.depth_number is None else command.depth_number
            later_ns = now_ns + round(1e9 * command.depth_later_s)
            self.depth.send(self._stamped(image, depth, number, later_ns))

    def _raw(self, colour: NDArray[np.uint8]) -> "dai.ImgFrame":
        image = dai.ImgFrame()
        image.setCvFrame(np.ascontiguousarray(colour[..., ::-1]), dai.ImgFrame.Type.RGB888i)
        return image

    def _encoded(self, colour: NDArray[np.uint8]) -> "dai.EncodedFrame":
        frame = dai.EncodedFrame()
        frame.setProfile(dai.EncodedFrame.Profile.JPEG)
        frame.setSize(colour.shape[1], colour.shape[0])
        data = simplejpeg.encode_jpeg(np.ascontiguousarray(colour), 90, "RGB", "420")
        frame.setData(np.frombuffer(data, np.uint8))
        return frame

    def _stamped(self, frame, picture, number: int, time_ns: int):
        height, width = picture.shape[:2]
        lens = dai.ImgTransformation(width, height)
        lens.setIntrinsicMatrix(
            [[self.focal, 0, width / 2], [0, self.focal, height / 2], [0, 0, 1]]
        )
        frame.setTransformation(lens)
        frame.setSequenceNum(number)
        at = timedelta(microseconds=time_ns / 1000)
        frame.setTimestamp(at)
        frame.setTimestampDevice(at - timedelta(hours=1))  # the device's clock is its own
        return frame


@dataclass
class StubCamera:
    """A camera whose sensors the test commands; each ``connect`` opens it anew."""

    shots: Sequence[Shot] = Shots(200)
    mjpeg: bool = False
    first: Sequence[Exposure] = (Exposure(0),)
    focal: float = FOCAL
    period_s: float = 0.001
    troubles: dict[str, str] = field(default_factory=dict)
    controls: list[tuple[OakOptions, list[str]]] = field(default_factory=list)
    died: str | None = None
    closed: int = 0
    fails_to_close: bool = False
    sensors: SensorNodes | None = None
    ended: threading.Event = field(default_factory=threading.Event)
    on_connect: Callable[["StubCamera"], None] | None = None

    def connect(self, _options: object) -> Connection:
        """A connection whose graph is on this host."""
        pipeline = dai.Pipeline(createImplicitDevice=False)
        sensors = pipeline.create(SensorNodes)
        sensors.shots, sensors.mjpeg, sensors.focal = self.shots, self.mjpeg, self.focal
        sensors.period_s = self.period_s
        for exposure in self.first:
            sensors.commands.put(exposure)
        self.sensors, self.pipeline = sensors, pipeline
        if self.on_connect is not None:
            self.on_connect(self)
        return Connection(
            pipeline=pipeline,
            colour=sensors.colour,
            depth=sensors.depth,
            description="a stub of a camera",
            clock_ns=200_000,
            control=lambda options, automatic: self.controls.append((options, list(automatic))),
            troubles=lambda: self.troubles,
            died=lambda: self.died,
            close=self._close,
        )

    def send(self, *numbers: int, **how: object) -> None:
        """Let the sensors expose, one after the other."""
        assert self.sensors is not None
        for number in numbers:
            self.sensors.commands.put(Exposure(number, **how))

    def break_link(self) -> None:
        """Close all queues, as depthai does when it loses a device."""
        self.pipeline.stop()

    def _close(self) -> None:
        self.ended.set()
        # A pipeline that is deleted while a node in Python still runs waits for it with the GIL.
        self.pipeline.wait()
        self.closed += 1
        if self.fails_to_close:
            raise RuntimeError("X_LINK_ERROR")
