import numpy as np
import pytest
from inhand_tracker.shape.kernels.mark_faces import mark_faces


def defined(pixels: np.ndarray, faces: np.ndarray, size: int) -> np.ndarray:
    """Where the barycentric coordinates of a pixel's centre in any face are none below 0."""
    row, column = np.indices((size, size)).reshape(2, -1)
    centres = np.vstack((column, row, np.ones(size * size)))
    shares = [np.linalg.solve(np.vstack((pixels[face].T, np.ones(3))), centres) for face in faces]
    return np.any([(one >= 0.0).all(axis=0) for one in shares], axis=0).reshape(size, size)


@pytest.mark.parametrize("seed", range(4))
def test_pixels_are_marked_whose_centre_lies_in_a_face(seed: int) -> None:
    random = np.random.default_rng(seed)
    pixels, faces = random.uniform(-5.0, 25.0, (12, 2)), np.arange(12).reshape(4, 3)
    mask = np.zeros((20, 20), np.uint8)
    mark_faces(pixels, faces, mask)
    np.testing.assert_array_equal(mask > 0, defined(pixels, faces, 20))


def test_what_lies_between_all_pixels_or_out_of_the_image_marks_none() -> None:
    between = np.array([[2.1, 2.1], [2.9, 2.2], [2.5, 2.9]])
    mask = np.zeros((8, 8), np.uint8)
    for pixels in (between, between + 20.0, between - 20.0):
        mark_faces(pixels, np.array([[0, 1, 2]]), mask)
    assert not mask.any()
