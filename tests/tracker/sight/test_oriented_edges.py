import numpy as np
import pytest
from inhand_tracker.sight.oriented_edges import FARTHEST_PIXELS, edge_distances, edge_scores


def step_across(size: int = 60) -> np.ndarray:
    """Dark on the left, bright on the right: an edge whose normal is channel 0's."""
    grey = np.full((size, size), 40, np.uint8)
    grey[:, size // 2 :] = 200
    return grey


def test_distances_count_pixels_from_an_edge() -> None:
    row = edge_distances(step_across())[0, 30]
    edge = int(np.argmin(row))
    assert edge == 29
    np.testing.assert_array_equal(row[edge + 1 : edge + 7], np.arange(6))
    assert (row[:10] == FARTHEST_PIXELS).all()


@pytest.mark.parametrize("turns", [0, 1, 2, 3])
def test_a_step_is_as_far_from_the_pixels_on_either_side(turns: int) -> None:
    near = edge_distances(np.rot90(step_across(), turns).copy()).min(axis=0)
    np.testing.assert_array_equal(near, near[::-1, ::-1])


@pytest.mark.parametrize(("turns", "channel"), [(0, 0), (1, 2)])
def test_an_edge_is_found_in_the_channel_of_its_normal_only(turns: int, channel: int) -> None:
    distances = edge_distances(np.rot90(step_across(), turns).copy())
    others = np.delete(np.arange(4), channel)
    assert distances[channel, 10:50, 10:50].min() == 0
    assert (distances[others, 10:50, 10:50] == FARTHEST_PIXELS).all()


@pytest.mark.parametrize(("falling", "channel"), [(True, 3), (False, 1)])
def test_slanted_edges_have_their_channels(falling: bool, channel: int) -> None:
    row, column = np.indices((60, 60))
    grey = np.where(column - row > 0 if falling else column + row > 60, 200, 40).astype(np.uint8)
    distances = edge_distances(grey)[:, 10:50, 10:50]
    assert distances[channel].min() == 0
    assert (np.delete(distances, channel, axis=0) > 0).all()


def test_an_image_without_edges_says_nothing() -> None:
    distances = edge_distances(np.full((40, 50), 128, np.uint8))
    assert (distances == FARTHEST_PIXELS).all()
    np.testing.assert_allclose(edge_scores(distances)[:, FARTHEST_PIXELS], 0.0, atol=1.0)


def test_near_an_edge_speaks_for_a_boundary_and_far_from_any_against() -> None:
    scores = edge_scores(edge_distances(step_across()))[0]
    assert scores[0] > 1.0
    assert scores[FARTHEST_PIXELS] < -0.5
    assert (np.diff(scores[:4]) < 0.0).all()


def test_where_edges_are_everywhere_they_say_less() -> None:
    stripes = np.where(np.arange(240) // 4 % 2, 200, 40).astype(np.uint8)
    distances = edge_distances(np.tile(stripes, (240, 1)))
    crowded = edge_scores(distances)[0]
    lone = edge_scores(edge_distances(step_across(240)))[0]
    there = np.unique(distances[0, 10:230, 10:230])
    assert np.ptp(crowded[there]) < 0.7 * np.ptp(lone[there])
