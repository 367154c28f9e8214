"""The texts of the review page as HTML."""

from collections.abc import Sequence
from datetime import datetime
from html import escape

import numpy as np
from inhand_schemas.messages import ObjectPose
from inhand_tracker.geometry.arrays import Indices

from inhand_studio.review_page.errors import Estimate
from inhand_studio.scene_parts import Colour


def frame_text(frame: int, times_ns: Indices) -> str:
    """Say which frame is shown, and when it was taken."""
    seconds = (int(times_ns[frame]) - int(times_ns[0])) / 1e9
    taken = datetime.fromtimestamp(int(times_ns[frame]) / 1e9).strftime("%Y-%m-%d %H:%M:%S")
    minutes, rest = divmod(seconds, 60.0)
    return f"Frame {frame} of {len(times_ns)}, {int(minutes)}:{rest:05.2f}, taken {taken}"


def pose_text(pose: ObjectPose) -> str:
    """Say of a recorded pose how sure the tracker was."""
    person = "" if pose.person is None else f" of person {pose.person}"
    return f"{pose.object}{person}: {pose.state}, confidence {pose.confidence:.2f}"


def legend_html(estimates: Sequence[Estimate], frame: int, truth: Colour | None) -> str:
    """Write which colour is what, and how far each is from the truth in a frame and over all."""
    rows = [] if truth is None else [_row(truth, "true, by the recording's labels", "", "")]
    for one in estimates:
        here = None if one.errors is None else one.errors[frame]
        error = "" if here is None or not np.isfinite(here) else f"{100.0 * here:.1f} cm"
        rows.append(_row(one.colour, one.name, error, one.summary()))
    style = "padding: 0.3em 0.7em; font-size: 0.8em; line-height: 1.4"
    return f'<div style="{style}">{"".join(rows)}</div>' if rows else ""


def _row(colour: Colour, name: str, error: str, summary: str) -> str:
    swatch = f'<span style="color: rgb{colour}">&#9632;</span>'
    here = f" <b>{escape(error)}</b>" if error else ""
    more = f"<div>{escape(summary)}</div>" if summary else ""
    return f"<div>{swatch} {escape(name)}{here}{more}</div>"
