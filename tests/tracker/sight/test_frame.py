import numpy as np
import pytest
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.image import Image
from inhand_tracker.sight.frame import prepare

CAMERA = Intrinsics(100.0, 110.0, 31.5, 23.5, 64, 48)
POINT = np.array([0.05, 0.02, 1.0])


def image() -> Image:
    random = np.random.default_rng(0)
    colour = random.integers(0, 256, (48, 64, 3)).astype(np.uint8)
    return Image(None, CAMERA, random.random((48, 64)).astype(np.float32), colour)


def test_a_region_shows_the_same_in_its_own_pixels() -> None:
    whole, part = prepare(image()), prepare(image(), (10.2, 5.0, 50.0, 40.5))
    assert (part.camera.width, part.camera.height) == (40, 36)
    np.testing.assert_allclose(
        part.camera.project(POINT), whole.camera.project(POINT) - np.array([10.0, 5.0])
    )
    assert part.depth is not None
    assert whole.depth is not None
    np.testing.assert_array_equal(part.depth, whole.depth[5:41, 10:50])


@pytest.mark.parametrize(
    "region", [(-50.0, -50.0, -20.0, -20.0), (60.0, 40.0, 300.0, 300.0), (30.0, 30.0, 30.0, 30.0)]
)
def test_a_region_beyond_the_image_or_of_no_size_still_has_pixels(
    region: tuple[float, float, float, float],
) -> None:
    part = prepare(image(), region)
    assert part.depth is not None
    assert min(part.depth.shape) >= 16
    assert part.edges is not None


def test_depth_of_another_size_is_brought_to_the_colours() -> None:
    small = np.arange(12.0, dtype=np.float32).reshape(3, 4)
    frame = prepare(Image(None, CAMERA, small, image().colour))
    assert frame.depth is not None
    assert frame.depth.shape == (48, 64)
    assert frame.depth[0, 0] == small[0, 0]
    assert frame.depth[-1, -1] == small[-1, -1]


def test_depth_alone_keeps_its_size() -> None:
    frame = prepare(Image(None, CAMERA, np.ones((24, 32), np.float32)))
    assert (frame.camera.width, frame.camera.fx) == (32, 50.0)
    assert frame.bins is None
    assert frame.edges is None
    assert frame.edge_scores is None


def test_a_region_of_very_many_pixels_is_seen_in_fewer_that_show_the_same() -> None:
    region = (3.0, 2.0, 63.0, 45.0)
    whole = prepare(image(), region)
    small = prepare(image(), region, most_pixels=300)
    assert (small.camera.width, small.camera.height) == (20, 14)
    np.testing.assert_allclose(
        3.0 * (small.camera.project(POINT) + 0.5), whole.camera.project(POINT) + 0.5
    )
    assert small.depth is not None
    assert whole.depth is not None
    np.testing.assert_array_equal(small.depth, whole.depth[1:42:3, 1::3])
    assert small.colour is not None
    assert whole.colour is not None
    mean = whole.colour[:42].reshape(14, 3, 20, 3, 3).mean(axis=(1, 3))
    np.testing.assert_allclose(small.colour, mean, atol=0.51)
