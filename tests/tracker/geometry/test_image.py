"""An image is prepared once for all the objects in it."""

import numpy as np
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.image import Image

CAMERA = Intrinsics(50.0, 50.0, 31.5, 23.5, 64, 48)


def test_what_is_prepared_of_an_image_is_prepared_once() -> None:
    calls = []

    def mean_of(image: Image) -> float:
        calls.append(image)
        return float(image.grey.mean())

    image, other = (Image(np.full((48, 64), level, np.uint8), CAMERA) for level in (90, 10))
    assert [image.once(mean_of) for _ in range(3)] == [90.0] * 3
    assert other.once(mean_of) == 10.0
    assert len(calls) == 2
