"""Says what processor time a simulated Kinect's frame takes, and which pictures came out.

``python tests/scenes/simulated_frames.py``, on one core (``taskset -c 1``): mean and median of 120
frames, neither encoded nor written, and a checksum of their bytes. To compare it with another
checkout run it with that one's Python, in turns; in older ones the simulation
stood in another module (``--module inhand_lab.world``).
"""

import argparse
import hashlib
import importlib
import statistics
import time

FIRST, LAST = 30, 150


def main() -> None:
    """Draw once and print what it took."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--module", default="inhand_lab.world.simulation")
    parser.add_argument("--interaction", default="drinkFromMug")
    chosen = parser.parse_args()
    simulate = importlib.import_module(chosen.module).simulate
    simulation = simulate(chosen.interaction, participant=5, seed=0, frames=LAST)
    for frame in (60, 61):
        simulation.render(frame)
    checksum, milliseconds = hashlib.sha256(), []
    for frame in range(FIRST, LAST):
        began = time.process_time()
        seen = simulation.render(frame)
        milliseconds.append((time.process_time() - began) * 1e3)
        checksum.update(seen.colour.tobytes() + seen.depth.tobytes())
    print(
        f"mean {statistics.fmean(milliseconds):.2f} ms, median "
        f"{statistics.median(milliseconds):.2f} ms, pictures {checksum.hexdigest()[:16]}"
    )


if __name__ == "__main__":
    main()
