"""Draws errors over time as a picture on which a click chooses a frame.

Nothing of viser's plots says where they are pressed. This one writes the frame into the slider that
stands in the same folder, as if somebody had typed it.
"""

from collections.abc import Sequence

import numpy as np
from inhand_tracker.geometry.arrays import Array, Indices

from inhand_studio.review_page.errors import Estimate
from inhand_studio.review_page.parameters import ReviewParameters

HEIGHT_PX = 110

_PRESS = (
    "const box=this.getBoundingClientRect();"
    "const share=Math.min(Math.max((event.clientX-box.left)/box.width,0),1);"
    "let near=this,slider=null;"
    "while(near&&!(slider=near.querySelector('.mantine-Slider-root')))near=near.parentElement;"
    "const input=slider.parentElement.querySelector('.mantine-NumberInput-input');"
    "Object.getOwnPropertyDescriptor(HTMLInputElement.prototype,'value')"
    ".set.call(input,String(Math.round(share*LAST)));"
    "input.dispatchEvent(new Event('input',{bubbles:true}));"
)


def plot_html(estimates: Sequence[Estimate], frames: int, parameters: ReviewParameters) -> str:
    """Draw the errors of estimates of one object, of so many frames; nothing without any."""
    curves = [(one, one.errors) for one in estimates if one.errors is not None]
    whole = [errors[np.isfinite(errors)] for _, errors in curves]
    if not any(map(len, whole)):
        return ""
    share = parameters.plot_share
    top = max(float(np.quantile(errors, share)) for errors in whole if len(errors))
    top = max(1.2 * top, parameters.least_height_m)
    drawn = "".join(_curve(errors, top, _hex(one), parameters) for one, errors in curves)
    press = _PRESS.replace("LAST", str(max(frames - 1, 0)))
    return (
        '<div style="padding: 0.2em 0.7em; font-size: 0.75em">'
        f"<div>Vertex error, up to {100.0 * top:.1f} cm; press into it to see the frame</div>"
        f'<svg data-plot="errors" viewBox="0 0 {parameters.columns} 100" width="100%" '
        f'height="{HEIGHT_PX}" preserveAspectRatio="none" style="background: #222; '
        'cursor: crosshair; display: block; touch-action: none" '
        f'onpointerdown="{press}" onpointermove="if(event.buttons){{{press}}}">{drawn}</svg></div>'
    )


def marker_html(frame: int, frames: int) -> str:
    """Draw where a frame is in the plot above."""
    percent = 100.0 * frame / max(frames - 1, 1)
    return (
        '<div style="padding: 0 0.7em; height: 0; pointer-events: none">'
        f'<div style="position: relative; height: {HEIGHT_PX}px; top: -{HEIGHT_PX}px">'
        f'<div style="position: absolute; left: {percent:.2f}%; width: 1px; height: 100%; '
        'background: #fff"></div></div></div>'
    )


def worst_frame(estimates: Sequence[Estimate]) -> int | None:
    """Return the frame with the greatest error of any estimate; None where there is none."""
    curves = [one.errors for one in estimates if one.errors is not None]
    if not curves or not np.isfinite(curves).any():
        return None
    return int(np.nanargmax(np.nanmax(np.where(np.isfinite(curves), curves, -1.0), axis=0)))


def _curve(errors: Array, top: float, colour: str, parameters: ReviewParameters) -> str:
    """Draw the greatest error of the frames of each column, in pieces where there is none."""
    frames = np.flatnonzero(np.isfinite(errors))
    columns = frames * parameters.columns // max(len(errors), 1)
    highest = np.full(parameters.columns, -1.0)
    np.maximum.at(highest, columns, errors[frames])
    given = np.flatnonzero(highest >= 0.0)
    # Where frames are fewer than columns, neighbours are so many columns apart.
    apart = max(parameters.columns / max(len(errors), 1), 1.0) + 1.0
    pieces = np.split(given, np.flatnonzero(np.diff(given) > apart) + 1)
    return "".join(
        '<polyline fill="none" vector-effect="non-scaling-stroke" stroke-width="1.5" '
        f'stroke="{colour}" points="{_points(piece, highest, top)}"/>'
        for piece in pieces
    )


def _points(columns: Indices, highest: Array, top: float) -> str:
    heights = 100.0 - 100.0 * np.minimum(highest[columns] / top, 1.0)
    if len(columns) == 1:  # a line of one point is not seen
        return f"{columns[0]},{heights[0]:.1f} {columns[0] + 1},{heights[0]:.1f}"
    return " ".join(f"{x},{y:.1f}" for x, y in zip(columns, heights, strict=True))


def _hex(estimate: Estimate) -> str:
    return "#{:02x}{:02x}{:02x}".format(*estimate.colour)
