"""What depth costs by its codec: ``python tests/scenes/depth_cost.py`` prints milliseconds of
processor time for a simulated Kinect's frame, and its size."""

from typing import get_args

from inhand_lab.world.simulation import simulate
from inhand_runtime.pixels import decode_depth, encode_depth
from inhand_schemas.fields import DepthCodec
from jpeg_cost import milliseconds


def main() -> None:
    """Print encoding, decoding and size of each codec."""
    depth = simulate("drinkFromMug", participant=0, seed=3, frames=10).render(5).depth
    for codec in get_args(DepthCodec):
        encoded = encode_depth(depth, codec)
        print(
            f"{codec}: encode {milliseconds(lambda: encode_depth(depth, codec)):.2f}, "  # noqa: B023
            f"decode {milliseconds(lambda: decode_depth(encoded)):.2f}, "  # noqa: B023
            f"{len(encoded.data) / 1e3:.0f} kB"
        )


if __name__ == "__main__":
    main()
