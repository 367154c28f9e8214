"""Says what hiding faces is worth on simulated people, and what it costs.

``python tests/scenes/hidden_faces.py``: of each interaction, pictures of which some of the head is
shown, hair and ears included; the largest share of a head that is shown; what is hidden of the
picture, where a head takes half a hundredth; and processor time of one core. The last rows are of
somebody whom the picture's edge cuts in the middle, who stands in a tenth of the light, who is
three times as far away, and who comes in from the side at 1 m/s.
"""

import argparse
import time
from collections.abc import Iterator

import cv2
import numpy as np
from drawn_heads import head_pixels
from inhand_capture.estimation.networks import open_network
from inhand_capture.estimation.weights import DEFAULT_NETWORK
from inhand_capture.faces.finder import open_face_finder
from inhand_lab.world.interactions import INTERACTIONS
from inhand_lab.world.messages import camera_info
from inhand_lab.world.simulation import Simulation, simulate
from numpy.typing import NDArray

SPEED_M = 1.0
Shown = tuple[NDArray[np.uint8], NDArray[np.bool_]]
"""A picture, and where its head is."""


def performed(simulation: Simulation, step: int) -> Iterator[Shown]:
    """Every so many frames."""
    for frame in range(0, simulation.frames, step):
        yield simulation.render(frame).colour, head_pixels(simulation, frame)


def coming_in(simulation: Simulation) -> Iterator[Shown]:
    """Somebody who is moved into the picture from its left side, before an empty wall."""
    colour, head = simulation.render(0).colour, head_pixels(simulation, 0)
    height, width = head.shape
    pixels = simulation.intrinsics.fx / simulation.true_joints_in_camera[0, 0, 2]
    step = round(pixels * SPEED_M / simulation.frame_rate)
    for away in range(width // 2 + 100, 0, -step):
        moved = np.full_like(colour, 110)
        moved[:, : width - away] = colour[:, away:]
        there = np.zeros((height, width), bool)
        there[:, : width - away] = head[:, away:]
        yield moved, there


def cut_in_the_middle(pictures: Iterator[Shown]) -> Iterator[Shown]:
    """The right half of a head, at the left edge."""
    middle = 0
    for colour, head in pictures:
        middle = middle or round(float(np.nonzero(head)[1].mean()))
        yield np.ascontiguousarray(colour[:, middle:]), head[:, middle:]


def in_the_dark(pictures: Iterator[Shown]) -> Iterator[Shown]:
    """With a tenth of the light."""
    for colour, head in pictures:
        yield (colour // 10).astype(np.uint8), head


def far_away(pictures: Iterator[Shown]) -> Iterator[Shown]:
    """Three times as far, before an empty wall."""
    for colour, head in pictures:
        height, width = (size // 3 for size in head.shape)
        away, there = np.full_like(colour, 110), np.zeros_like(head)
        window = (slice(160, 160 + height), slice(200, 200 + width))
        away[window] = cv2.resize(colour, (width, height), interpolation=cv2.INTER_AREA)
        there[window] = head[1::3, 1::3][:height, :width]
        yield away, there


def row(name: str, simulation: Simulation, pictures: Iterator[Shown], step: int) -> str:
    """Hide the faces of pictures that follow each other."""
    finder = open_face_finder(open_network(DEFAULT_NETWORK), trust_skeletons=False)
    info = camera_info(simulation.intrinsics, simulation.frame_rate)
    period_ns = round(1e9 * step / simulation.frame_rate)
    shares, hidden, milliseconds = [], [], []
    for number, (colour, head) in enumerate(pictures):
        began = time.process_time()
        mask = finder.find(colour, number * period_ns, (), info).mask(*head.shape)
        milliseconds.append(1e3 * (time.process_time() - began))
        if head.any():
            shares.append((head & ~mask).sum() / head.sum())
        hidden.append(mask.mean())
    shown = np.count_nonzero(shares)
    return (
        f"| {name} | {shown} of {len(shares)} | {100 * max(shares):.0f} % | "
        f"{100 * np.mean(hidden):.1f} % | {np.mean(milliseconds):.1f} |"
    )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--participant", type=int, default=1)
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--frames", type=int, default=240)
    parser.add_argument("--step", type=int, default=2, help="looks at one frame of so many")
    chosen = parser.parse_args()
    print(
        "| | pictures that show some of the head | at most | hidden | ms |\n|---|---|---|---|---|"
    )
    for name in INTERACTIONS:
        simulation = simulate(name, chosen.participant, chosen.seed, frames=chosen.frames)
        pictures = performed(simulation, chosen.step)
        print(row(name, simulation, pictures, chosen.step), flush=True)
    simulation = simulate("drinkFromMug", chosen.participant, chosen.seed, frames=chosen.frames)
    for name, changed in (
        ("cut in the middle", cut_in_the_middle),
        ("in the dark", in_the_dark),
        ("three times as far", far_away),
    ):
        pictures = changed(performed(simulation, chosen.step))
        print(row(name, simulation, pictures, chosen.step), flush=True)
    print(row("who comes in", simulation, coming_in(simulation), 1))


if __name__ == "__main__":
    main()
