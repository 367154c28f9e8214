"""A drawing of the whole recording: its keyframes, and where labels come to be."""

from itertools import pairwise

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_studio.labelling_page.editing import Keyframes

WIDTH, HEIGHT, BASE = 1000, 60, 44
"""Units of the drawing, which is stretched to the panel's width, and the line it stands on."""


def strip(keyframes: Keyframes, frames: int, frame: int, doubts: Array | None = None) -> str:
    """Return an SVG of a recording of so many frames.

    Orange lines are keyframes with poses, grey ones say that the object is absent; blue is what is
    interpolated between; purple is the doubt (T,), as a share of the greatest; the white line is
    the frame that is shown.
    """
    last = max(frames - 1, 1)
    parts = [f'<rect x="0" y="{BASE}" width="{WIDTH}" height="10" fill="#444"/>']
    for one, next_one in pairwise(keyframes):
        if (one.pose is None) != (next_one.pose is None):
            continue
        colour = "#3caafa" if one.pose is not None else "#999"
        start, end = (WIDTH * each.frame / last for each in (one, next_one))
        parts.append(
            f'<rect x="{start:.1f}" y="{BASE}" width="{end - start:.1f}" height="10" '
            f'fill="{colour}"/>'
        )
    if doubts is not None and np.isfinite(doubts).any():
        parts.append(_curve(doubts, last))
    for one in keyframes:
        colour = "#fa7828" if one.pose is not None else "#bbb"
        parts.append(_line(WIDTH * one.frame / last, BASE - 8, HEIGHT - 2, colour, 6))
    parts.append(_line(WIDTH * frame / last, 0, HEIGHT, "#fff", 4))
    return (
        f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" width="100%" height="44" '
        f'preserveAspectRatio="none" style="background:#222">{"".join(parts)}</svg>'
    )


def _line(x: float, top: float, bottom: float, colour: str, width: int) -> str:
    return (
        f'<line x1="{x:.1f}" x2="{x:.1f}" y1="{top}" y2="{bottom}" stroke="{colour}" '
        f'stroke-width="{width}"/>'
    )


def _curve(doubts: Array, last: int) -> str:
    """Draw the greatest doubt of each of the columns there is room for."""
    frames = np.flatnonzero(np.isfinite(doubts))
    columns = (WIDTH * frames // last).astype(int)
    highest = np.zeros(WIDTH + 1)
    np.maximum.at(highest, columns, doubts[frames])
    top = max(float(highest.max()), 1e-9)
    points = " ".join(
        f"{column},{BASE - BASE * highest[column] / top:.1f}" for column in np.unique(columns)
    )
    return f'<polyline points="{points}" fill="none" stroke="#b070ff" stroke-width="3"/>'
