import numpy as np
from inhand_tracker.shape.kernels.measure_thickness import measure_thickness


def defined(mask: np.ndarray, pixel: np.ndarray, normal: np.ndarray) -> tuple[float, float]:
    """Steps inwards to the first pixel off the mask, and outwards, from the second, to one on it;
    what is off the raster is off the mask."""
    steps = np.arange(1, len(mask))[:, None]
    rows = []
    for line in (pixel - steps * normal, pixel + steps * normal):
        column, row = np.rint(line).astype(int).T
        within = (np.minimum(column, row) >= 0) & (np.maximum(column, row) < len(mask))
        rows.append(within & mask[np.where(within, row, 0), np.where(within, column, 0)])
    inwards, outwards = rows
    outwards[0] = False
    return 1 + np.argmin([*inwards, False]), 1 + np.argmax(outwards) if any(outwards) else np.inf


def test_thickness_is_that_of_the_definition() -> None:
    random = np.random.default_rng(0)
    row, column = np.indices((40, 40))
    mask = (np.hypot(row - 20, column - 15) < 12) | (column > 33)
    pixels = np.argwhere(mask)[random.choice(mask.sum(), 60, replace=False)][:, ::-1].astype(float)
    normals = random.normal(size=(60, 2))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    expected = np.array([defined(mask, *one) for one in zip(pixels, normals, strict=True)])
    assert 5 < np.isfinite(expected[:, 1]).sum() < 55
    np.testing.assert_array_equal(np.transpose(measure_thickness(mask, pixels, normals)), expected)
