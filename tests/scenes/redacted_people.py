"""Says what redacting recordings is worth on simulated people.

``python tests/scenes/redacted_people.py``: of each interaction a recording is made, with skeletons
and without, and redacted by ``inhand recording redact``; the last rows are of somebody who walks
through the picture, before a wall, at 1 m/s. A pixel is left over where its colour or
its depth is not 0 in what was written. Colour is recorded without JPEG, so that what is hidden is
exactly 0. Heads include hair and ears, and people all that they wear.
"""

import argparse
import contextlib
import io
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import inhand_recorder
import numpy as np
from drawn_heads import head_pixels
from inhand_lab.people.person import PEOPLE, USUAL_PEOPLE
from inhand_lab.sensing.cameras import KINECT
from inhand_lab.sensing.render import OBJECT, PERSON
from inhand_lab.world.interactions import INTERACTIONS
from inhand_lab.world.messages import camera_info, person_message
from inhand_lab.world.parameters import CAMERA_PLACINGS, USUAL_VIEWS
from inhand_lab.world.simulation import Casting, Simulation, simulate_cast
from inhand_recorder.recorded import RecordedImages
from inhand_runtime.pixels import encode_depth
from inhand_runtime.recording import RecordingWriter
from inhand_schemas.keys import Site
from inhand_schemas.messages import ColourImage, Message, RgbdFrame, Skeletons
from inhand_schemas.topics import INFO, RGBD, SKELETONS, AnyTopic
from numpy.typing import NDArray

from inhand.__main__ import main as inhand

CAMERA = "front"
WALL_MM = 4000


@dataclass(frozen=True)
class Shown:
    """A picture with its depth in millimetres, and where person, head and object are in it."""

    frame: int
    colour: NDArray[np.uint8]
    depth: NDArray[np.uint16]
    person: NDArray[np.bool_]
    head: NDArray[np.bool_]
    object: NDArray[np.bool_]


@dataclass
class Left:
    """Shares of pixels that are left over, a number a frame."""

    sought: list[float] = field(default_factory=list)
    held: list[float] = field(default_factory=list)
    rest: list[float] = field(default_factory=list)
    blacked: int = 0

    def row(self, name: str) -> str:
        """A row of the table."""
        frames, shown = len(self.sought), np.count_nonzero(self.sought)
        left, most = 100 * np.mean(self.sought or [0]), 100 * max(self.sought, default=0.0)
        held, rest = 100 * np.mean(self.held or [0]), 100 * np.mean(self.rest)
        return (
            f"| {name} | {shown} of {frames} | {left:.3f} % | {most:.1f} % | {held:.0f} % | "
            f"{rest:.0f} % | {self.blacked} |"
        )


def performed(simulation: Simulation, step: int) -> Iterator[Shown]:
    """Every so many frames."""
    for frame in range(0, simulation.frames, step):
        seen, labels = simulation.render(frame), simulation.draw(frame).canvas.labels
        yield Shown(
            frame,
            seen.colour,
            seen.depth,
            labels == PERSON,
            head_pixels(simulation, frame),
            labels == OBJECT,
        )


def coming_in(simulation: Simulation) -> Iterator[Shown]:
    """Somebody who moves at 1 m/s from the left side into a picture of an empty wall, and out."""
    first = next(performed(simulation, 1))
    width = first.head.shape[1]
    metre = simulation.intrinsics.fx / simulation.true_joints_in_camera[0, 0, 2]
    step = round(metre / simulation.frame_rate)
    way = [width + 100 - number * step for number in range(2 * (width + 100) // step)]
    somebody = first.person | first.object
    for number, away in enumerate(way):
        colour = np.full_like(first.colour, 110)
        depth = np.full_like(first.depth, WALL_MM)
        masks = [np.zeros_like(first.head) for _ in range(3)]
        if abs(away) < width:
            to, of = slice(max(-away, 0), width - max(away, 0)), slice(max(away, 0), None)
            of = slice(of.start, of.start + to.stop - to.start)
            there = somebody[:, of]
            colour[:, to][there] = first.colour[:, of][there]
            depth[:, to][there] = first.depth[:, of][there]
            for mask, whole in zip(masks, (first.person, first.head, first.object), strict=True):
                mask[:, to] = whole[:, of]
        yield Shown(number, colour, depth, *masks)


def record(path: Path, simulation: Simulation, shown: Sequence[Shown], *, skeletons: bool) -> None:
    """Record pictures of a simulation, with its skeletons or without."""
    rate = simulation.frame_rate
    with RecordingWriter(path) as writer:

        def write(topic: AnyTopic, message: Message) -> None:
            writer.write(
                topic.key(Site(), CAMERA),
                topic.encode(message),  # type: ignore[arg-type]
                received_ns=message.time_ns + 1_000_000,
                captured_ns=message.time_ns,
                sequence=message.sequence,
            )

        write(INFO, camera_info(simulation.intrinsics, rate))
        for one in shown:
            stamp = {"sequence": one.frame, "time_ns": 10**18 + round(1e9 * one.frame / rate)}
            height, width = one.depth.shape
            colour = ColourImage("rgb8", width, height, one.colour.tobytes())
            write(RGBD, RgbdFrame(**stamp, colour=colour, depth=encode_depth(one.depth)))
            if skeletons:
                person = person_message(simulation, one.frame)
                write(SKELETONS, Skeletons(**stamp, people=(person,)))


def measure(left: Left, redacted: Path, shown: Sequence[Shown], what: str) -> None:
    """Compare what was recorded with what was written."""
    with inhand_recorder.open(redacted) as recording:
        for old, new in zip(shown, recording[f"rgbd/{CAMERA}"], strict=True):
            if not isinstance(new, RecordedImages) or new.colour is None or new.depth is None:
                raise TypeError("a frame lost its colour or depth")
            still = new.colour.any(axis=2) | (new.depth > 0)
            there = old.colour.any(axis=2) | (old.depth > 0)
            sought = old.head if what == "faces" else old.person
            rest = there & ~sought & ~old.object
            for mask, shares in ((sought, left.sought), (old.object, left.held), (rest, left.rest)):
                if mask.any():
                    shares.append(float((mask & still).sum() / mask.sum()))
            left.blacked += not still.any()


def rows_of(
    name: str, simulation: Simulation, shown: Sequence[Shown], *, skeletons: bool
) -> Iterator[str]:
    """Record, redact and measure."""
    with tempfile.TemporaryDirectory() as folder:
        recorded = Path(folder) / "recorded.mcap"
        record(recorded, simulation, shown, skeletons=skeletons)
        for what in ("faces", "people"):
            redacted, left = Path(folder) / f"{what}.mcap", Left()
            words = ["recording", "redact", str(recorded), "-o", str(redacted)]
            with contextlib.redirect_stdout(io.StringIO()):
                code = inhand([*words, f"--{what}"])
            if code != 0:
                raise SystemExit(f"{name} was not redacted")
            measure(left, redacted, shown, what)
            how = "with skeletons" if skeletons else "pictures alone"
            yield left.row(f"{name}, {what}, {how}")


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--participant", type=int, default=1)
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--frames", type=int, default=240)
    parser.add_argument("--step", type=int, default=4, help="records one frame of so many")
    parser.add_argument("--interactions", nargs="+", default=list(INTERACTIONS))
    parser.add_argument("--views", choices=list(CAMERA_PLACINGS), default=USUAL_VIEWS)
    parser.add_argument("--people", choices=PEOPLE, default=USUAL_PEOPLE)
    chosen = parser.parse_args()

    def simulated(name: str) -> Simulation:
        cast = Casting(
            name, chosen.participant, chosen.seed, views=chosen.views, people=chosen.people
        )
        return simulate_cast(cast, chosen.frames, KINECT)

    print("| | frames with any left | left | at most | object shown | rest shown | all hidden |")
    print("|---|---|---|---|---|---|---|")
    for name in chosen.interactions:
        simulation = simulated(name)
        shown = list(performed(simulation, chosen.step))
        for skeletons in (True, False):
            for row in rows_of(name, simulation, shown, skeletons=skeletons):
                print(row, flush=True)
    simulation = simulated("drinkFromMug")
    for row in rows_of(
        "comes in, and leaves", simulation, list(coming_in(simulation)), skeletons=False
    ):
        print(row, flush=True)


if __name__ == "__main__":
    main()
