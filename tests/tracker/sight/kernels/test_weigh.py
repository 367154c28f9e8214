import kernel_arrays as arrays
import numpy as np
import pytest
from inhand_tracker.sight.depth_table import depth_table
from inhand_tracker.sight.kernels.weigh import OUTLINE_PIXELS, WeighSettings, weigh
from inhand_tracker.sight.parameters import DEFAULT_SIGHT

ALL = (True, True, True, True)


def settings(wanted: tuple[bool, ...] = ALL) -> WeighSettings:
    table = depth_table(0.8, 0.05, DEFAULT_SIGHT)
    numbers = np.array([0.5, 1.0 / 12.0, 0.6, 2.5, 0.3, 3.0], np.float32)
    return WeighSettings(np.array(wanted), table, arrays.SENSOR, *numbers)


def weighed(wanted: tuple[bool, ...] = ALL, depth: float = 0.5) -> np.ndarray:
    translations, orientations = (one.astype(np.float32) for one in arrays.poses())
    scores = np.full((len(translations), 5), np.nan, np.float32)
    weigh(
        translations,
        orientations,
        arrays.outlines(),
        arrays.pixels(depth),
        settings(wanted),
        scores,
    )
    return scores


class Definition:
    """What ``weigh`` finds of one pose, in plain NumPy."""

    def __init__(self, pose: tuple[np.ndarray, np.ndarray], depth: float) -> None:
        self.outlines, self.pixels = arrays.outlines(), arrays.pixels(depth)
        self.pose, self.settings = pose, settings()
        self.view = arrays.nearest(self.outlines.directions, pose)
        self.noise = arrays.SENSOR.noise_m + arrays.SENSOR.noise_per_m * pose[0][2] ** 2
        size = self.outlines.sizes[self.view] * arrays.LENS[0] / pose[0][2]
        self.scale = size * self.settings.scale_per_pixel

    def visible(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        where = arrays.project(points)
        measured = arrays.look_up(self.pixels.depth, where)
        margin = arrays.SENSOR.covered_m + 2.0 * self.noise
        covered = (measured > 0.0) & (measured < points[2] - margin)
        return where, arrays.is_inside(where) & (points[2] > 0.05) & ~covered

    def outline(self) -> tuple[float, float, int]:
        outlines, pixels = self.outlines, self.pixels
        _, points = arrays.place(self.pose, outlines.points[self.view])
        turned, _ = arrays.place(self.pose, outlines.normals[self.view])
        normals = arrays.project_normals(turned, points)
        where, visible = self.visible(points)
        channel = arrays.channels(normals)
        distances = arrays.look_up(np.moveaxis(pixels.edges, 0, 2), where).astype(int)
        edges = pixels.edge_scores[channel, distances[np.arange(len(channel)), channel]]
        edges = edges * np.where(arrays.look_up(pixels.limbs, where) > 0.0, 0.5, 1.0)
        region = np.zeros(len(channel))
        for offset in OUTLINE_PIXELS:
            step = offset * np.clip(self.scale, 0.6, 2.5)
            within = arrays.look_up(pixels.colour_scores[..., 0], where - step * normals)
            beside = arrays.look_up(pixels.colour_scores[..., 1], where + step * normals)
            pixel_m = points[2] / arrays.LENS[0]
            region += within * (step * pixel_m < outlines.inside[self.view])
            region += beside * (step * pixel_m < outlines.outside[self.view])
        share = outlines.lengths[self.view] / len(channel)
        return edges[visible].sum() * share, region[visible].sum() * share, int(visible.sum())

    def surface(self) -> tuple[float, float, int]:
        _, points = arrays.place(self.pose, self.outlines.surface_points[self.view])
        where, visible = self.visible(points)
        colours = arrays.look_up(self.pixels.colour_scores, where)
        interior = (colours[:, 0] - colours[:, 1])[visible].sum() * np.clip(self.scale, 0.3, 3.0)
        measured = arrays.look_up(self.pixels.depth, where)
        column = np.clip((measured - points[2]) * 8.0 / self.noise + 64.0, 0.0, 127.0).astype(int)
        scores = self.settings.depth_scores[int(self.pose[0][2] * 8.0), column]
        count = len(measured)
        return interior / count, scores[measured > 0.0].sum() / count, int(visible.sum())

    def scores(self) -> np.ndarray:
        edges, region, on_outline = self.outline()
        interior, depth, on_surface = self.surface()
        asked = self.outlines.points.shape[2] + self.outlines.surface_points.shape[2]
        return np.array([edges, region, interior, depth, (on_outline + on_surface) / asked])


@pytest.mark.parametrize("depth", [0.5, 0.4])
def test_scores_are_those_of_the_definition(depth: float) -> None:
    poses = zip(*arrays.poses(), strict=True)
    expected = np.array([Definition(pose, depth).scores() for pose in poses])
    assert 0.0 < np.mean(expected[:, 4]) < 1.0
    np.testing.assert_allclose(weighed(depth=depth), expected, atol=2e-4)


@pytest.mark.parametrize("term", range(4))
def test_a_term_alone_is_the_same_and_the_others_are_zero(term: int) -> None:
    alone = weighed(tuple(index == term for index in range(4)))
    np.testing.assert_allclose(alone[:, term], weighed()[:, term], atol=1e-6)
    np.testing.assert_array_equal(np.delete(alone[:, :4], term, axis=1), 0.0)
