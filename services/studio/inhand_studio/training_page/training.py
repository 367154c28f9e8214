"""One training: learn from recordings, then measure by leaving each participant out."""

import json
import re
import threading
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from inhand_lab.datasets.dataset import DatasetEntry
from inhand_runtime.errors import InhandError
from inhand_runtime.exit_codes import DONE
from inhand_tracker.methods.registry import DEFAULT_METHOD

from inhand_studio.training_page.lessons import Lesson, dataset_of
from inhand_studio.verb import Verb

_PROGRESS = re.compile(r"progress: (.+) (\d+)/(\d+)")
POLL_S = 0.1


@dataclass(frozen=True)
class Progress:
    """How far a training is. ``steps`` are done and in all, by stage, of the verb that runs.

    ``error`` is the measured one (None before), by ``inhand evaluate``'s names; ``failure`` is why
    it came to nothing; ``model`` is written as soon as it is learned.
    """

    title: str
    doing: str
    steps: Mapping[str, tuple[int, int]] = field(default_factory=dict)
    model: Path | None = None
    error: Mapping[str, Any] | None = None
    failure: str | None = None
    running: bool = True


class Trainings:
    """Runs one training at a time, each step of it in a process of its own; thread-safe."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._verb: Verb | None = None
        self._cancelled = False
        self.progress: Progress | None = None

    def start(self, dataset: Path, lesson: Lesson, entries: Sequence[DatasetEntry]) -> None:
        """Begin to learn; raises InhandError where another training runs."""
        with self._lock:
            if self.progress is not None and self.progress.running:
                raise InhandError(f"{self.progress.title} is being trained: cancel it first")
            self._cancelled = False
            self.progress = Progress(lesson.title, "begins")
        work = threading.Thread(
            target=self._run, args=(dataset, lesson, tuple(entries)), name="training", daemon=True
        )
        work.start()

    def cancel(self) -> None:
        """End what runs; a model that was learned already stays."""
        with self._lock:
            self._cancelled = True
            verb = self._verb
        if verb is not None:
            verb.end()

    def _run(self, dataset: Path, lesson: Lesson, entries: tuple[DatasetEntry, ...]) -> None:
        failure = None
        try:
            self._learn_and_measure(dataset, lesson, entries)
        except (InhandError, OSError) as error:
            failure = "cancelled" if self._cancelled else str(error)
        self._note(running=False, failure=failure, doing="ended")

    def _learn_and_measure(
        self, dataset: Path, lesson: Lesson, entries: tuple[DatasetEntry, ...]
    ) -> None:
        model = dataset / "models" / f"{lesson.object_name}.model"
        model.parent.mkdir(exist_ok=True)
        with dataset_of(dataset, entries) as folder, TemporaryDirectory() as results:
            self._do("learns", ["train", str(folder), "-o", str(model)])
            self._note(model=model)
            measured = Path(results) / "measured.json"
            self._do(
                "measures, leaving each participant out",
                ["evaluate", str(folder), f"--methods={DEFAULT_METHOD}", f"--json={measured}"],
            )
            self._note(error=json.loads(measured.read_text())["methods"][DEFAULT_METHOD])

    def _do(self, doing: str, arguments: list[str]) -> None:
        """Run a verb to its end; raises InhandError with what it said where it failed."""
        with self._lock:
            if self._cancelled:
                raise InhandError("cancelled")
            self._verb = Verb([*arguments, "--progress-lines"])
        self._note(doing=doing, steps={})
        while not self._verb.ended(POLL_S):
            self._note(steps=_steps(self._verb.lines))
        if self._verb.code != DONE:
            said = [line for line in self._verb.lines if not _PROGRESS.fullmatch(line)]
            raise InhandError(said[-1] if said else f"it ended with {self._verb.code}")

    def _note(self, **changes: Any) -> None:
        with self._lock:
            if self.progress is not None:
                self.progress = replace(self.progress, **changes)


def _steps(lines: Sequence[str]) -> dict[str, tuple[int, int]]:
    found = (_PROGRESS.fullmatch(line) for line in lines)
    return {one[1]: (int(one[2]), int(one[3])) for one in found if one is not None}
