"""Exports of small recordings, as the verb makes them."""

from collections.abc import Callable
from pathlib import Path

import inhand_recorder
from inhand_recorder.conversion import Selection, chosen_keys

from inhand.exports.request import ExportRequest


def export(
    exporter: Callable[[ExportRequest, Path], dict[str, int]],
    recordings: Path | list[Path],
    output: Path,
    selection: Selection | None = None,
    **more: str | Path,
) -> dict[str, int]:
    """Export what is selected, and return the numbers of what was written."""
    chosen = selection or Selection()
    with inhand_recorder.open(recordings) as recording:
        keys = tuple(chosen_keys(recording, chosen))
        return exporter(ExportRequest(recording, keys, chosen, **more), output)
