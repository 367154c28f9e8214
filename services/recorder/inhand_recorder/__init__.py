"""Records what crosses the wire, looks after the files, and reads them.

``open`` reads recordings in Python (docs/reading.md). ``losses`` counts what is missing,
``scanning`` walks files in any state, and on it stand ``inspection`` (what is in a file),
``verification`` (is all of it true) and ``recovery`` (a whole file from a cut or damaged one).
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from inhand_recorder.recording_reader import Recording


def open(paths: Path | str | Iterable[Path | str]) -> Recording:
    """Open a recording to read it: a file, several, or a folder with all recordings in it.

    Files are read as one recording, in the order of reception, and what stands in two of them is
    read once. A file that was cut off or still grows (``.part``) is read as far as it is whole,
    which ``notes`` and the log say. Raises RecordingError for a file that is missing, foreign or
    damaged, and UnknownVersionError.
    """
    # A recorder needs no NumPy.
    from inhand_recorder.recording_files import find_files
    from inhand_recorder.recording_reader import Recording

    return Recording(*find_files(paths))
