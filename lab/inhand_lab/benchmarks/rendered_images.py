"""Makes images of simulated frames as a tracker gets them, through the messages' coding."""

from inhand_runtime.pixels import encode_colour, encode_depth
from inhand_schemas.messages import RgbdFrame
from inhand_tracker.geometry.image import Image
from inhand_tracker.wire.conversion import Need, image_of

from inhand_lab.world.messages import camera_info
from inhand_lab.world.simulation import Simulation

NEEDS: tuple[Need, ...] = ("edges", "depth", "colour")


def rendered_image(shown: Simulation, number: int) -> Image:
    """Render one frame's colour and depth."""
    seen = shown.render(number)
    frame = RgbdFrame(
        sequence=0,
        time_ns=0,
        colour=encode_colour(seen.colour),
        depth=encode_depth(seen.depth),
    )
    image = image_of(frame, camera_info(shown.intrinsics, shown.frame_rate), NEEDS)
    if image is None:
        raise ValueError("a simulated frame has colour and depth")
    return image
