"""Times a frame of ``fusion`` by its stages: named functions of the tracker are timed from outside.

The tracker knows nothing of it: while a measurement lasts, each function of ``STAGES`` is replaced
by one that takes the time and calls it. A stage's time is without that of the stages within it.
"""

import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np
from inhand_tracker.body.reader import BodyReader
from inhand_tracker.body.window import BodyWindow
from inhand_tracker.methods.fusion import belief, tracker
from inhand_tracker.methods.fusion.belief import BodyExpectation
from inhand_tracker.methods.fusion.posterior import ImagePosterior
from inhand_tracker.methods.fusion.search import ImageSearch
from inhand_tracker.methods.registry import DEFAULT_METHOD, METHODS, new_tracker
from inhand_tracker.model.model_file import load_model

from inhand_lab.benchmarks.learned_objects import LearnedObjects
from inhand_lab.datasets.observations import observe
from inhand_lab.datasets.recorded_frames import load_frames

BODY, PRIOR, PREPARE, SEARCH, REFINE, REST = (
    "body",
    "prior",
    "prepare",
    "search",
    "refine",
    "rest",
)

STAGES: Mapping[str, tuple[tuple[Any, str], ...]] = {
    BODY: ((BodyReader, "read"), (BodyWindow, "add"), (belief, "find_anchors")),
    PRIOR: ((BodyExpectation, "expect"), (tracker, "carry_over")),
    PREPARE: ((ImageSearch, "_open"),),
    SEARCH: ((ImageSearch, "look"),),
    REFINE: ((ImagePosterior, "modes"), (ImagePosterior, "weigh")),
    REST: ((ImageSearch, "_learn_colours"),),
}
"""The functions of each stage, each with what holds it; all else of a step is the rest."""


@dataclass(frozen=True)
class StageCosts:
    """Median microseconds of processor time of each stage of a frame, and of the whole frame."""

    stages_us: dict[str, float]
    whole_us: float


class StageClock:
    """Books processor time to the stage that runs: the innermost of those that were entered."""

    def __init__(self) -> None:
        self.nanoseconds = dict.fromkeys(STAGES, 0)
        self._entered: list[str] = []
        self._since = 0

    @contextmanager
    def running(self, stage: str) -> Iterator[None]:
        """Book the time of a block to a stage."""
        self._book()
        self._entered.append(stage)
        try:
            yield
        finally:
            self._book()
            self._entered.pop()

    def timed(self, stage: str, function: Callable[..., Any]) -> Callable[..., Any]:
        """Return a function that does the same as another and books its time to a stage."""

        def timed(*given: Any, **named: Any) -> Any:
            with self.running(stage):
                return function(*given, **named)

        return timed

    def _book(self) -> None:
        now = time.process_time_ns()
        if self._entered:
            self.nanoseconds[self._entered[-1]] += now - self._since
        self._since = now


def measure_stages(learned: LearnedObjects, first_frames: int, *, images: bool) -> StageCosts:
    """Time the frames of the stranger's recording, but for the first ones, with one object."""
    stranger, method = learned.stranger, METHODS[DEFAULT_METHOD]
    followed = new_tracker(
        load_model(learned.models[0]), DEFAULT_METHOD, left_handed=stranger.handedness == "left"
    )
    frames = load_frames(learned.recording, stranger.object)
    needs = method.needs(method.usual_terms) if images else ()
    booked: list[dict[str, int]] = []
    for seen in observe(learned.recording, frames, needs):
        followed.convention = seen.convention
        with stages_timed() as clock, clock.running(REST):
            followed.step(seen.joints, seen.time_ns, seen.image)
        booked.append(clock.nanoseconds)
    table = np.array([list(one.values()) for one in booked[first_frames:]]) / 1e3
    medians = np.median(table, axis=0)
    return StageCosts(
        dict(zip(STAGES, medians.tolist(), strict=True)), float(np.median(table.sum(axis=1)))
    )


@contextmanager
def stages_timed() -> Iterator[StageClock]:
    """Book what the functions of ``STAGES`` take, until the block ends."""
    clock, usual = StageClock(), []
    try:
        for stage, functions in STAGES.items():
            for holder, name in functions:
                function = getattr(holder, name)
                setattr(holder, name, clock.timed(stage, function))
                usual.append((holder, name, function))
        yield clock
    finally:
        for holder, name, function in usual:
            setattr(holder, name, function)
