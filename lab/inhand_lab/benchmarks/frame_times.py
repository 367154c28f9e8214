"""Times frames of ``fusion`` with whatever checkout's code is on the path: a program by itself.

``python -P frame_times.py RECORDING OBJECT HANDEDNESS MODEL MODEL`` prints, as JSON, the
milliseconds of processor time of each frame in each case. It imports only what every build has, by
each of the names under which builds have it, and runs on one core and in one thread.
"""

import importlib
import json
import os
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

CASES = {
    "with an image": ((0,), True),
    "without an image": ((0,), False),
    "two objects, both there, with an image": ((0, 0), True),
    "two objects, one not there, with an image": ((0, 1), True),
}
"""Which of the models are tracked in each case, and whether in images. Only the first one's object
is in them: of two that are both there, both are it, each tracked by itself."""
PIXELS = ("colour", "depth")
ONE_THREAD = ("NUMBA_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")

LOAD_FRAMES = ("inhand_lab.datasets.recorded_frames:load_frames", "inhand_lab.dataset:load_frames")
OBSERVE = ("inhand_lab.datasets.observations:observe", "inhand_lab.observations:observe")
LOAD_MODEL = ("inhand_tracker:load_model", "inhand_tracker.model_file:load_model")
NEW_TRACKER = ("inhand_tracker:new_tracker", "inhand_tracker.trackers:new_tracker")


def main(arguments: Sequence[str]) -> None:
    """Time every case, and print the result."""
    recording, object_name, handedness, *files = arguments
    _take_one_core()
    load_model, new_tracker = _first_of(LOAD_MODEL), _first_of(NEW_TRACKER)
    models = [load_model(Path(file)) for file in files]
    frames = _first_of(LOAD_FRAMES)(Path(recording), object_name)
    times = {}
    for case, (objects, images) in CASES.items():
        trackers = [
            new_tracker(models[number], "fusion", left_handed=handedness == "left", seed=seed)
            for seed, number in enumerate(objects)
        ]
        seen = _first_of(OBSERVE)(Path(recording), frames, PIXELS if images else ())
        times[case] = [_step_ms(trackers, one) for one in seen]
    tracker = importlib.import_module("inhand_tracker")
    print(json.dumps({"package": tracker.__file__, "ms": times}))


def _step_ms(trackers: Sequence[Any], seen: Any) -> float:
    """Milliseconds of processor time in which trackers see a frame, which is decoded already.

    Checkouts of before there were conventions have frames that name none.
    """
    for tracker in trackers:
        tracker.convention = getattr(seen, "convention", None)
    began = time.process_time_ns()
    for tracker in trackers:
        tracker.step(seen.joints, seen.time_ns, seen.image)
    return (time.process_time_ns() - began) / 1e6


def _take_one_core() -> None:
    """Run on one core, with one thread: libraries look at the environment when they are loaded."""
    os.environ.update(dict.fromkeys(ONE_THREAD, "1"))
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    importlib.import_module("cv2").setNumThreads(1)


def _first_of(names: Sequence[str]) -> Any:
    """Import the first of ``module:attribute`` names that this build has."""
    for name in names:
        module, _, attribute = name.partition(":")
        try:
            return getattr(importlib.import_module(module), attribute)
        except (ModuleNotFoundError, AttributeError):
            continue
    raise ImportError(f"this build has none of {', '.join(names)}")


if __name__ == "__main__":
    main(sys.argv[1:])
