"""Frames recorded as a recorder does that codes colour as H.264, without the wire."""

from collections.abc import Iterable
from pathlib import Path

import msgspec
import numpy as np
from inhand_recorder.colour_coding import ColourCoding
from inhand_recorder.colour_encoder import ColourEncoder
from inhand_recorder.journal import Journal
from inhand_recorder.recording_file import Entry, FileHandling, Limits
from inhand_runtime.pixels import encode_colour, encode_depth
from inhand_runtime.recording import RecordingWriter, read_metadata, read_recording
from inhand_runtime.recording.copying import copy_message, write_beside
from inhand_schemas.messages import ColourImage, RgbdFrame
from inhand_schemas.topics import INFO, RGBD
from numpy.typing import NDArray
from small_rig import CAMERA, DELAY_NS, FRAME_NS, SITE, START_NS, depth_of

KEY = RGBD.key(SITE, "front")
WIDTH, HEIGHT = 64, 48


class Heard:
    """Hears of troubles."""

    def __init__(self) -> None:
        self.texts: list[str] = []

    def trouble(self, name: str, text: str, *, lasts_s: float = 0.0) -> None:
        """Keep what is said."""
        assert name.startswith("colour ")
        assert lasts_s > 0.0
        self.texts.append(text)


def picture(number: int, width: int = WIDTH, height: int = HEIGHT) -> NDArray[np.uint8]:
    """RGB (H, W, 3) of a bright square before a soft background; the square moves."""
    y, x = np.mgrid[:height, :width]
    colour = np.stack((2 * x + 20, 3 * y + 30, x + y + 40), axis=-1).astype(np.uint8)
    left = 2 * number % (width - 16)
    colour[16:32, left : left + 16] = (230, 200, 90)
    return colour


def frame(number: int, colour: ColourImage | None = None) -> RgbdFrame:
    """A frame with depth, and the picture of its number unless another is given."""
    return RgbdFrame(
        sequence=number,
        time_ns=START_NS + number * FRAME_NS,
        colour=encode_colour(picture(number)) if colour is None else colour,
        depth=encode_depth(depth_of(number)),
    )


def entry(of: RgbdFrame) -> Entry:
    """The entry of a frame."""
    received_ns = of.time_ns + DELAY_NS
    return Entry(KEY, RGBD.encode(of), received_ns, of.time_ns, of.sequence)


class CodedRig:
    """Records frames into a folder."""

    def __init__(self, folder: Path) -> None:
        self.heard, self.now = Heard(), 0.0
        self.coding = ColourCoding(self.heard, lambda: self.now)
        handling = FileHandling(records=self.coding.records)
        self.journal = Journal(folder, "rig", Limits(), dict, files=handling)
        info = INFO.encode(CAMERA)
        at_ns = START_NS + DELAY_NS
        self.journal.write(Entry(INFO.key(SITE, "front"), info, at_ns, START_NS, 0, kept=True))

    def record(self, frames: Iterable[RgbdFrame], *, in_turn: bool = True) -> None:
        """Record frames; in turn, each is coded before the next one comes."""
        for one in frames:
            self.write(self.coding.take(entry(one)))
            if in_turn:
                self.write(self.coding.all())
            if one.sequence % 5 == 4:  # as a recorder does ten times a second
                self.journal.hand_over()

    def write(self, entries: Iterable[Entry]) -> None:
        """Write what was handed out."""
        for one in entries:
            self.journal.write(one)

    def split(self) -> Path:
        """Make the file whole."""
        self.write(self.coding.all())
        path = self.journal.close()
        assert path is not None
        return path


def record(folder: Path, frames: int, first: int = 0) -> Path:
    """Record frames, all of them as H.264."""
    rig = CodedRig(folder)
    rig.record(frame(number) for number in range(first, first + frames))
    assert rig.coding.counts == {"coded": frames}
    return rig.split()


def recoded(source: Path, output: Path) -> Path:
    """Copy a recording with its colour as H.264, as if it had been recorded so."""
    encoders: dict[str, ColourEncoder] = {}
    with RecordingWriter(output) as writer:
        for one in read_recording(source):
            if one.topic is not RGBD:
                copy_message(writer, one)
                continue
            message = one.frame()
            if message.colour is not None:
                encoder = encoders.setdefault(one.key, ColourEncoder())
                colour = encoder.encode(message.colour, message.time_ns)
                message = msgspec.structs.replace(message, colour=colour)
            write_beside(writer, one.key, one, RGBD.encode(message))
        for name, values in read_metadata(source).items():
            writer.add_metadata(name, values)
    return output
