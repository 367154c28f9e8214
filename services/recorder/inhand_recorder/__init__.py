"""Records what crosses the wire, looks after the files, and reads them.

``open`` reads recordings in Python (docs/reading.md). ``losses`` counts what is missing,
``scanning`` walks files in any state, and on it stand ``inspection`` (what is in a file),
``verification`` (is all of it true) and ``recovery`` (a whole file from a cut or damaged one).
"""

from inhand_recorder.recorded import Recorded, RecordedImages
from inhand_recorder.recording_reader import Recording, open
from inhand_recorder.recording_series import Series

__all__ = ["Recorded", "RecordedImages", "Recording", "Series", "open"]
