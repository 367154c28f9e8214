"""What a JPEG costs: ``python tests/scenes/jpeg_cost.py`` prints milliseconds of processor time."""

import time
from collections.abc import Callable

import cv2
import numpy as np
from inhand_runtime.pixels import decode_colour, encode_colour

FRAMES = 100


def milliseconds(work: Callable[[], object]) -> float:
    """Processor time of one call."""
    begin = time.process_time()
    for _ in range(FRAMES):
        work()
    return 1e3 * (time.process_time() - begin) / FRAMES


def main() -> None:
    """Print encoding and decoding for both sizes of the OAK driver."""
    noise = np.random.default_rng(0)
    for width, height in ((640, 480), (1280, 720)):
        picture = noise.integers(0, 255, (height, width, 3), np.uint8)
        picture = np.asarray(cv2.GaussianBlur(picture, (9, 9), 3), np.uint8)
        encoded = encode_colour(picture)
        print(
            f"{width} x {height}: encode {milliseconds(lambda: encode_colour(picture)):.2f}, "  # noqa: B023
            f"decode {milliseconds(lambda: decode_colour(encoded)):.2f}, "  # noqa: B023
            f"{len(encoded.data) / (width * height):.3f} bytes a pixel"
        )


if __name__ == "__main__":
    main()
