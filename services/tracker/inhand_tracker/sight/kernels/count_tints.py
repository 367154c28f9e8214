"""Which colours are apart from a person, and how red or blue they are: one pass over a picture."""

from inhand_runtime.compiled import njit

from inhand_tracker.geometry.arrays import Array, Bytes, Singles


@njit(cache=True, nogil=True)
def count_tints(
    colour: Bytes,
    depth: Singles,
    person: tuple[float, float],
    step: int,
    measured: tuple[int, int],
    logs: Array,
    widest: float,
    sums: Array,
) -> int:
    """Add samples of a picture (H, W, 3) to ``sums`` (C, C, 3) by their log(red / green) and
    log(blue / green), in cells up to ``widest`` either way: how many, their brightness, and half
    their log(red / blue). Returns how many were added.

    A sample is four pixels together, one in ``step`` each way, of levels within the ``measured``
    ones; ``logs`` (1021,) are those of four levels' sum. With a ``depth`` (h, w) of the same view
    in metres, only what is measured farther from the ``person`` than their reach counts: their
    distance and reach in metres. A depth of no size is none.
    """
    height, width, _ = colour.shape
    deep, broad = depth.shape
    cells = len(sums)
    scale = 0.5 * cells / widest
    lowest, highest = 4 * measured[0], 4 * measured[1]
    added = 0
    for row in range(0, height - 1, step):
        for column in range(0, width - 1, step):
            if depth.size > 0:
                metres = depth[row * deep // height, column * broad // width]
                if metres <= 0.0 or abs(metres - person[0]) <= person[1]:
                    continue
            red = green = blue = 0
            for y in range(row, row + 2):
                for x in range(column, column + 2):
                    red += int(colour[y, x, 0])
                    green += int(colour[y, x, 1])
                    blue += int(colour[y, x, 2])
            if min(red, green, blue) < lowest or max(red, green, blue) > highest:
                continue
            across = min(max(logs[red] - logs[green], -widest), widest)
            along = min(max(logs[blue] - logs[green], -widest), widest)
            first = min(int((across + widest) * scale), cells - 1)
            second = min(int((along + widest) * scale), cells - 1)
            sums[first, second, 0] += 1.0
            sums[first, second, 1] += (red + green + blue) / 12.0
            sums[first, second, 2] += 0.5 * (across - along)
            added += 1
    return added
