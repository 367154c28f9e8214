"""The report of an evaluation as Markdown: tables, definitions of what is measured, pictures."""

from collections.abc import Mapping, Sequence
from typing import Any

from inhand_runtime.wording import counted

from inhand_lab.report.grid import Grid
from inhand_lab.report.tables import MEASURES, error_grid, interaction_grid, shown_grids

FIGURES = {
    "spread": "How much the object's pose varies among frames of like body pose; where that is "
    "little, particles are drawn anew (the paper's figure 4). Roots of the mean squares.",
    "rotation": "How far the object turns until the next frame relative to the steadiest part of "
    "each limb (figure 5).",
    "translation": "How far it moves until the next frame, and how far it is away (figure 6).",
    "frames": "The true object in green, the tracked one in red, the skeleton as it was given; "
    "time and vertex error above (figure 13).",
}

DEFINITIONS = """\
## What is measured

- **Vertex error**: mean distance of corresponding marked vertices. A participant's error is the
  mean over frames, recordings and seeds; a cell the mean and standard deviation over participants
  (recordings, where there is one participant); the last rows are means over interactions, ours and
  those of Darby, Li and Costen 2014 (15 interactions by six people), absolute and as ratios to
  gd-stable-proximate.
- **Rotation, translation**: the angle, and the distance of the origins. Of an object with
  symmetries the least angle over its equal poses, and the distance of the symmetries' centres.
- **Within 5 cm 5°**: the share of frames in which both are below that.
- **ADD(-S) area**: the area under the curve of the share of frames against a threshold on ADD from
  0 to 10 cm. ADD is the mean distance of corresponding surface points; ADD-S, for objects with
  symmetries, that to the nearest surface point.
- **Lost**: the share of frames in which the track is lost: from when the vertex error exceeds
  20 cm, or no pose is given, until it is below 10 cm again. **Recovery** is the mean time that
  takes, and what is not found again counts until the end of the recording.
- **After body**: mean time from when the body is right again until the track is not lost. The body
  is wrong while no pelvis is seen or, in a simulated world, a joint above the knees is more than
  20 cm from its true place.
- A frame without a pose counts with the last one given. Before the first it counts as lost and
  neither as within 5 cm 5° nor to the area.
"""


def report_grids(result: Mapping[str, Any]) -> list[Grid]:
    """Return all tables: a terminal's, each measure by interaction, and other terms' errors."""
    return [
        *shown_grids(result),
        *(interaction_grid(measure, result["methods"]) for measure in MEASURES),
        *(error_grid(methods, f", {name}") for name, methods in result["compared"].items()),
    ]


def markdown(result: Mapping[str, Any], pictures: Mapping[str, Sequence[str]]) -> str:
    """Return the report; ``pictures`` are the names of each interaction's files."""
    lines = [
        "# Evaluation",
        "",
        f"{counted(result['frames'], 'frame')} tracked in {result['seconds']:.0f} s; terms of "
        f"the likelihood: {result['terms']}.",
        "",
        *(f"Note: {note}.\n" for note in result["notes"]),
        *(grid.for_markdown() for grid in report_grids(result)),
        DEFINITIONS,
        "## Figures",
        "",
        *(f"- **{name}**: {text}" for name, text in FIGURES.items()),
    ]
    for interaction, files in pictures.items():
        lines += ["", f"### {interaction}", "", *(f"![{file}]({file})" for file in files)]
    return "\n".join(lines) + "\n"
