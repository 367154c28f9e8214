"""Gradients of an image to edges of four directions."""

import numpy as np
from inhand_runtime.compiled import njit
from numpy.typing import NDArray

from inhand_tracker.geometry.arrays import Array, Bytes, Singles


@njit(cache=True, nogil=True, fastmath=True)
def mark_edges(
    across: NDArray[np.int16],
    down: NDArray[np.int16],
    least_gradient: float,
    agreement: float,
    edges: Bytes,
) -> None:
    """Set a bit of ``edges`` (H + 2, W + 2), which has a rim of a pixel, for each of four channels
    at edges: where the gradient (``across``, ``down``), (H, W) each, is ``least_gradient`` or more,
    and greatest along its direction.

    An edge counts for every channel that its normal agrees with (``agreement``, a cosine).
    """
    height, width = across.shape
    squares = np.empty((height, width), np.int32)
    for row in range(height):
        for column in range(width):
            gradient_x, gradient_y = np.int32(across[row, column]), np.int32(down[row, column])
            squares[row, column] = gradient_x * gradient_x + gradient_y * gradient_y
    least_square = np.int32(np.ceil(least_gradient * least_gradient))
    diagonal = np.float32(np.sqrt(0.5))
    for row in range(1, height - 1):
        for column in range(1, width - 1):
            square = squares[row, column]
            if square < least_square:
                continue
            x = np.float32(across[row, column])
            y = np.float32(down[row, column])
            strengths = (abs(x), abs(x + y) * diagonal, abs(y), abs(x - y) * diagonal)
            if strengths[0] >= max(strengths[1], strengths[2], strengths[3]):
                step_row, step_column = 0, 1
            elif strengths[1] >= max(strengths[2], strengths[3]):
                step_row, step_column = 1, 1
            elif strengths[2] >= strengths[3]:
                step_row, step_column = 1, 0
            else:
                step_row, step_column = 1, -1
            # Equal ones are all edges: a sharp step lies between two, and belongs to neither alone.
            if square < squares[row + step_row, column + step_column]:
                continue
            if square < squares[row - step_row, column - step_column]:
                continue
            least = np.float32(agreement) * np.sqrt(np.float32(square))
            for channel in range(4):
                if strengths[channel] >= least:
                    edges[row + 1, column + 1] |= np.uint8(1 << channel)


@njit(cache=True, nogil=True)
def find_distances(edges: Bytes, farthest: int, distances: Bytes) -> None:
    """Fill ``distances`` (4, H, W) with the steps to the next edge of each channel, ``farthest`` at
    the most, by the bits of ``edges`` (H + 2, W + 2), which are used up.

    Edges of all channels grow at once: to the four neighbours and to all eight in turns, so that
    they grow as octagons.
    """
    height, width = distances.shape[1:]
    grown = np.zeros_like(edges)
    distances[:] = 0
    for step in range(farthest):
        for row in range(height):
            here = edges[row + 1]
            for channel in range(4):
                line = distances[channel, row]
                for column in range(width):
                    line[column] += np.uint8(1) - ((here[column + 1] >> channel) & np.uint8(1))
        for row in range(height):
            above, here, below, out = edges[row], edges[row + 1], edges[row + 2], grown[row + 1]
            if step % 2 == 0:
                for column in range(width):
                    out[column + 1] = (
                        here[column]
                        | here[column + 1]
                        | here[column + 2]
                        | above[column + 1]
                        | below[column + 1]
                    )
            else:
                for column in range(width):
                    out[column + 1] = (
                        here[column]
                        | here[column + 1]
                        | here[column + 2]
                        | above[column]
                        | above[column + 1]
                        | above[column + 2]
                        | below[column]
                        | below[column + 1]
                        | below[column + 2]
                    )
        edges, grown = grown, edges


@njit(cache=True, nogil=True)
def score_distances(
    distances: Bytes, lines: tuple[int, int], matched_share: float, near: Array, scores: Singles
) -> None:
    """Fill ``scores`` (4, N) with log p(distance | a boundary is here) / p(distance | anywhere) of
    each distance to the next edge, by how often it is in ``distances`` (4, H, W).

    ``near`` (N,) is the probability of each distance at a boundary that shows an edge, as a
    ``matched_share`` do. Of ``lines``, the channel of normals down and a number, one line in that
    number is looked at, across the channel's edges, as others would fall in with them, or miss
    them: columns of that channel, else rows.
    """
    down, every = lines
    channels, height, width = distances.shape
    counts = np.empty(len(near))
    for channel in range(channels):
        rows, columns = (1, every) if channel == down else (every, 1)
        counts[:] = 1.0
        for row in range(0, height, rows):
            for column in range(0, width, columns):
                counts[distances[channel, row, column]] += 1.0
        counts /= counts.sum()
        for distance in range(len(near)):
            here = (1.0 - matched_share) + matched_share * near[distance] / counts[distance]
            scores[channel, distance] = np.log(here)
