"""Compares what a frame of ``fusion`` costs here with what it costs in another checkout's code.

Both measure the same recording with the same models, in turns: this code, that code, this code, …
Every turn is a process of its own (``frame_times``), on one core and in one thread.
"""

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from inhand_runtime.errors import InhandError, SettingsError

from inhand_lab.benchmarks import frame_times
from inhand_lab.benchmarks.learned_objects import (
    LearnedObjects,
    learn_objects,
    preparation_steps,
)
from inhand_lab.benchmarks.parameters import DEFAULT_COMPARISON, ComparisonParameters

PREPARING, MEASURING = "simulating and learning", "measuring in turns"

Times = Mapping[str, Sequence[float]]
"""Milliseconds of each frame, by case."""


@dataclass(frozen=True)
class CaseComparison:
    """Median milliseconds of processor time that a frame takes, in each turn.

    ``here_ms`` and ``there_ms`` are this code's and the other's; turn by turn they were measured
    one after the other.
    """

    case: str
    here_ms: tuple[float, ...]
    there_ms: tuple[float, ...]

    @property
    def ratios(self) -> tuple[float, ...]:
        """How many times longer the other code takes, in each turn."""
        return tuple(there / here for here, there in zip(self.here_ms, self.there_ms, strict=True))


def comparison_steps(parameters: ComparisonParameters = DEFAULT_COMPARISON) -> dict[str, int]:
    """Return the stages of a comparison, each with the number of its steps."""
    preparing = preparation_steps(parameters.interactions, parameters.people)
    return {PREPARING: preparing, MEASURING: 2 * parameters.turns}


def compare_checkout(
    checkout: Path,
    on_step: Callable[[str], None],
    parameters: ComparisonParameters = DEFAULT_COMPARISON,
) -> list[CaseComparison]:
    """Measure every case in turns; ``on_step`` gets the stage of every step.

    Raises SettingsError for a folder that is no checkout, and InhandError where it cannot be
    measured.
    """
    packages = packages_of(checkout)
    here: list[Times] = []
    there: list[Times] = []
    with tempfile.TemporaryDirectory(prefix="inhand-bench-") as name:
        learned = learn_objects(
            Path(name), parameters.interactions, parameters.people, lambda: on_step(PREPARING)
        )
        for _ in range(parameters.turns):
            here.append(_measure_here(learned))
            on_step(MEASURING)
            there.append(_measure_there(checkout, packages, learned))
            on_step(MEASURING)
    return [
        CaseComparison(case, *(_medians(turns, case, parameters) for turns in (here, there)))
        for case in frame_times.CASES
    ]


def packages_of(checkout: Path) -> list[Path]:
    """Return the folders of a checkout's packages; raises SettingsError where there are none."""
    found = sorted(
        {
            package.parents[1].resolve()
            for pattern in ("*/inhand_*/__init__.py", "services/*/inhand_*/__init__.py")
            for package in checkout.glob(pattern)
        }
    )
    if not any((folder / "inhand_tracker").is_dir() for folder in found):
        raise SettingsError(
            f"{checkout} is no checkout of this project: name the folder in which services, "
            "schemas and lab are (git worktree add FOLDER COMMIT makes one)"
        )
    return found


def _measure_here(learned: LearnedObjects) -> Times:
    _, times = _measured([sys.executable], dict(os.environ), learned, "this code")
    return times


def _measure_there(checkout: Path, packages: Sequence[Path], learned: LearnedObjects) -> Times:
    own = checkout.resolve() / ".venv/bin/python"
    python = str(own) if own.exists() else sys.executable
    # Before what is installed, so that it is surely this checkout's code that runs.
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(map(str, packages))}
    package, times = _measured([python], environment, learned, str(checkout))
    if not any(Path(package).resolve().is_relative_to(folder) for folder in packages):
        raise InhandError(f"{python} took the tracker of {package}, not that of {checkout}")
    return times


def _measured(
    python: Sequence[str], environment: Mapping[str, str], learned: LearnedObjects, whose: str
) -> tuple[str, Times]:
    """Return the place of the code that was measured, and the times; raises InhandError."""
    stranger = learned.stranger
    program = [*python, "-P", str(Path(frame_times.__file__))]
    what = [str(learned.recording), str(stranger.object), stranger.handedness]
    done = subprocess.run(
        [*program, *what, *map(str, learned.models)],
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode != 0:
        lines = done.stderr.strip().splitlines() or [f"ended with {done.returncode}"]
        raise InhandError(
            f"{whose} cannot be measured: {lines[-1]} (it needs the libraries of its time, in its "
            ".venv or here, and to read today's models and recordings)"
        )
    result = json.loads(done.stdout.splitlines()[-1])
    return result["package"], result["ms"]


def _medians(
    turns: Sequence[Times], case: str, parameters: ComparisonParameters
) -> tuple[float, ...]:
    return tuple(float(np.median(times[case][parameters.first_frames :])) for times in turns)
