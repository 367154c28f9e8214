"""``python -m inhand_studio.review_page.track_recording``: one tracker over one recording.

It is a process of its own, so that a page can end it. It prints how many frames of how many are
done, and writes the poses into a file of NumPy's.
"""

import argparse
import sys
from pathlib import Path

import numpy as np
from inhand_lab.datasets.observations import observe
from inhand_lab.datasets.recorded_frames import load_frames
from inhand_lab.datasets.tracks import empty_track
from inhand_runtime.errors import InhandError
from inhand_runtime.exit_codes import DONE, FAILED
from inhand_runtime.recording.message_index import open_index
from inhand_schemas.topics import LABEL
from inhand_tracker.methods.registry import METHODS, new_tracker
from inhand_tracker.model.model_file import load_model

REPORTED_FRAMES = 10


def track_recording(chosen: argparse.Namespace) -> None:
    """Track, and write the poses; raises InhandError."""
    model = load_model(chosen.model)
    method = METHODS[chosen.method]
    with open_index(chosen.recording) as index:
        labelled = index.counts(LABEL.stream).get(model.shape.name, 0) > 0
    frames = load_frames(
        chosen.recording, model.shape.name if labelled else None, chosen.camera or None
    )
    tracker = new_tracker(model, chosen.method, left_handed=chosen.left_handed)
    track = empty_track(len(frames))
    needs = method.needs(method.usual_terms)
    for number, seen in enumerate(observe(chosen.recording, frames, needs)):
        track.put(number, seen.show(tracker))
        if number % REPORTED_FRAMES == 0:
            print(number, len(frames), flush=True)
    with chosen.output.open("wb") as file:
        np.savez(
            file,
            object=np.array(model.shape.name),
            times_ns=np.array([frame.time_ns for frame in frames], np.int64),
            translations=track.translations,
            rotations=track.rotations,
        )


def main() -> int:
    """Track as the command line says; returns the exit code, after one line about what failed."""
    parser = argparse.ArgumentParser()
    parser.add_argument("recording", type=Path)
    parser.add_argument("model", type=Path)
    parser.add_argument("method", choices=tuple(METHODS))
    parser.add_argument("output", type=Path)
    parser.add_argument("--camera", default="")
    parser.add_argument("--left-handed", action="store_true")
    try:
        track_recording(parser.parse_args())
    except InhandError as error:
        print(error, file=sys.stderr)
        return FAILED
    return DONE


if __name__ == "__main__":
    sys.exit(main())
