"""A recording of somebody who walks past a camera, with whom a network finds told picture by
picture."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import simplejpeg
from inhand_capture.faces.discs import Disc
from inhand_capture.faces.finder import FaceFinder
from inhand_runtime.pixels import encode_colour, encode_depth
from inhand_runtime.recording import RecordingWriter
from inhand_schemas.joints import Joint
from inhand_schemas.keys import Site
from inhand_schemas.messages import Message, ObjectPose, Preview, RgbdFrame, Skeletons
from inhand_schemas.topics import INFO, LABEL, PREVIEW, RGBD, SKELETONS, AnyTopic
from numpy.typing import NDArray
from posed_person import INFO as CAMERA
from posed_person import WALL_M, ToldNetwork, depth_of, draw_ball, seen, standing

START_NS = 1_700_000_000_000_000_000
PERIOD_NS = 200_000_000
LATER_NS = 1_000_000
MUG = (slice(440, 452), slice(20, 32))
"""Where a small thing stands in the picture, far from who walks by."""
MUG_MM = 1500
WALL, PERSON = 110, 220


@dataclass
class ToldFaces:
    """Finds the faces that it is told of."""

    discs: tuple[Disc, ...] = ()

    def find(self, _picture: NDArray[np.uint8], _view: object) -> list[Disc]:
        """Find the same faces in each view."""
        return list(self.discs)


def told_finder(places: Sequence[float | None], *faces: Disc) -> Callable[[], FaceFinder]:
    """Make what finds somebody at these places, a picture each, None for nobody."""
    script = [[] if x is None else [seen(standing(x))] for x in places]
    return lambda: FaceFinder(ToldFaces(faces), ToldNetwork(list(script)))  # type: ignore[arg-type]


def _with_necks(places: Iterable[float | None]) -> NDArray[np.uint16]:
    """Depth of people whose heads are joined to their trunks."""
    people = [standing(x) for x in places if x is not None]
    depth = depth_of(*people).astype(np.float64)
    for joints in people:
        for below in (0.12, 0.18, 0.24):
            draw_ball(depth, joints[Joint.HEAD] + [0.0, below, 0.0], 0.07)
    return depth.astype(np.uint16)


@cache
def depth_at(*places: float | None) -> NDArray[np.uint16]:
    """Depth (480, 640), millimetres, of people at places, and of the wall."""
    depth = _with_necks(places)
    depth[MUG] = MUG_MM
    depth.flags.writeable = False
    return depth


@cache
def person_at(x: float) -> NDArray[np.bool_]:
    """The pixels (480, 640) of somebody at a place."""
    person = _with_necks([x]) < 1000 * WALL_M
    person.flags.writeable = False
    return person


def colour_at(*places: float | None) -> NDArray[np.uint8]:
    """The picture (480, 640, 3) of people at places."""
    colour = np.full((480, 640, 3), WALL, np.uint8)
    for x in places:
        if x is not None:
            colour[person_at(x)] = PERSON
    return colour


def write_walk(
    path: Path,
    places: Sequence[float | None],
    others: Sequence[float | None] | None = None,
    *,
    info: bool = True,
    depth: bool = True,
) -> Path:
    """Record frames of one or two people, a place each for each frame, their previews and messages
    of other streams, five frames a second."""
    with RecordingWriter(path) as writer:

        def write(topic: AnyTopic, name: str, message: Message) -> None:
            writer.write(
                topic.key(Site(), name),
                topic.encode(message),  # type: ignore[arg-type]
                received_ns=max(message.time_ns, START_NS) + LATER_NS,
                captured_ns=message.time_ns,
                sequence=message.sequence,
            )

        writer.add_metadata("session", {"participant": "p01"})
        for name in ("objects/mug/mesh.ply", "poster.jpg"):
            writer.add_attachment(name, "", name.encode(), received_ns=START_NS)
        if info:
            write(INFO, "front", CAMERA)
        for number, people in enumerate(zip(places, others or [None] * len(places), strict=True)):
            stamp = {"sequence": number, "time_ns": START_NS + number * PERIOD_NS}
            colour = colour_at(*people)
            small = simplejpeg.encode_jpeg(np.ascontiguousarray(colour[::2, ::2]), 90, "RGB", "420")
            write(PREVIEW, "front", Preview(**stamp, width=320, height=240, jpeg=small))
            measured = encode_depth(depth_at(*people)) if depth else None
            write(RGBD, "front", RgbdFrame(**stamp, colour=encode_colour(colour), depth=measured))
            write(SKELETONS, "front", Skeletons(**stamp, people=()))
            label = {"object": "mug", "camera": "front", "state": "lost", "confidence": 0.0}
            write(LABEL, "mug", ObjectPose(**stamp, **label))
    return path
