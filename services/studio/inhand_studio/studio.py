"""What all pages of a studio have at hand."""

from dataclasses import dataclass
from pathlib import Path

from inhand_runtime.daemon import Daemon


@dataclass(frozen=True)
class Studio:
    """The ``dataset`` that pages show and write, and the ``daemon`` whose rig they look at: None
    where a recording is looked at without a rig. ``recording`` is the one to begin with, if any."""

    dataset: Path
    daemon: Daemon | None = None
    recording: Path | None = None
