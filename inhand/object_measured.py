"""A new object that a camera has measured: the one thing that stands on a table in a recording."""

import argparse

from inhand_lab.new_objects.measuring import MeasuredThing, measure_thing
from inhand_lab.new_objects.proposal import Proposal, propose
from inhand_lab.new_objects.recorded_depth import read_still_depth
from inhand_runtime.errors import SettingsError
from inhand_runtime.wording import counted
from rich.console import Console

from inhand.object_choices import chosen_by_hand


def propose_measured(arguments: argparse.Namespace, console: Console) -> Proposal:
    """Make an object of what stands on the table in ``--from``.

    Raises SettingsError, RecordingError or MeasuringError.
    """
    if not arguments.recording.is_file():
        raise SettingsError(f"{arguments.recording} is no file: name a recording (.mcap)")
    depth, intrinsics = read_still_depth(arguments.recording)
    thing = measure_thing(depth, intrinsics)
    console.print(_described(thing), soft_wrap=True)
    model = thing.model
    marks = model.marked_vertices
    return propose(arguments.name, model.vertices, model.faces, marks, chosen_by_hand(arguments))


def _described(thing: MeasuredThing) -> str:
    measures = ", ".join(f"{name} {value:g} cm" for name, value in thing.measures_cm.items())
    return (
        f"a {thing.kind} fits: {measures}; {counted(thing.points, 'point')} of it lie "
        f"{thing.residual_mm:.1f} mm from its surface on average, and {thing.off_share:.0%} off "
        f"it; {thing.overlap:.0%} of its outline is the same"
    )
