"""Lets a site run for long with a fault every minute, and says whether any of its processes grows.

Memory, handles and threads of each process are read all the time. A process that faults end is
another one afterwards, so what counts of each service is the longest life that a process of it had.
"""

import itertools
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass

import numpy as np
import psutil
from inhand_tracker.geometry.arrays import Array

from inhand_lab.chaos.faults import FAULTS
from inhand_lab.chaos.parameters import DEFAULT_CHAOS, ChaosParameters
from inhand_lab.chaos.rig import ChaosRig
from inhand_lab.chaos.trials import Trial, inflict

MEASURES = ("MB", "handles", "threads")


@dataclass(frozen=True)
class Course:
    """How a measure went in the settled part of a life: its last value, its slope an hour, and by
    how much its median at the end is above that at the begin."""

    last: float
    per_hour: float
    gained: float


@dataclass(frozen=True)
class Life:
    """The longest life of a process of a service, in minutes, with the course of each measure."""

    name: str
    minutes: float
    courses: dict[str, Course]


class Meter:
    """Reads what the processes of a rig take, from a thread of its own."""

    def __init__(self, rig: ChaosRig) -> None:
        self._rig = rig
        self._rows: dict[tuple[str, int], list[tuple[float, ...]]] = {}
        self._ends = threading.Event()

    @contextmanager
    def reading(self) -> Iterator[None]:
        """Read until the block ends."""
        thread = threading.Thread(target=self._read, name="meter")
        thread.start()
        try:
            yield
        finally:
            self._ends.set()
            thread.join()

    def lives(self) -> list[Life]:
        """The longest life of each service's processes, once the block has ended."""
        longest: dict[str, Array] = {}
        for (name, _), rows in self._rows.items():
            life = np.array(rows)
            if name not in longest or len(life) > len(longest[name]):
                longest[name] = life
        return [life_of(name, rows) for name, rows in sorted(longest.items())]

    def _read(self) -> None:
        while not self._ends.wait(DEFAULT_CHAOS.reading_s):
            for name, process in self._rig.all_processes().items():
                with suppress(psutil.NoSuchProcess), process.oneshot():
                    row = (
                        time.monotonic(),
                        process.memory_info().rss / 1e6,
                        process.num_fds(),
                        process.num_threads(),
                    )
                    self._rows.setdefault((name, process.pid), []).append(row)
            self._drop_recordings()

    def _drop_recordings(self) -> None:
        """Delete all recordings but the newest: the disk of a soak is not the point."""
        files = sorted(self._rig.recordings.glob("*.mcap*"), key=lambda path: path.stat().st_mtime)
        for path in files[: -DEFAULT_CHAOS.recordings_kept]:
            path.unlink()


def life_of(name: str, rows: Array, parameters: ChaosParameters = DEFAULT_CHAOS) -> Life:
    """Say how a life went by its readings (N, 4): seconds, MB, handles and threads."""
    settled = rows[int(len(rows) * parameters.unsettled_share) :]
    window = max(1, min(parameters.window_readings, len(settled) // 2))
    courses = {}
    for column, measure in enumerate(MEASURES, start=1):
        values = settled[:, column]
        slope = np.polyfit(settled[:, 0], values, 1)[0] if len(settled) > 1 else 0.0
        gained = np.median(values[-window:]) - np.median(values[:window])
        courses[measure] = Course(float(values[-1]), 3600.0 * float(slope), float(gained))
    return Life(name, float(rows[-1, 0] - rows[0, 0]) / 60.0, courses)


def soak(
    rig: ChaosRig,
    minutes: int,
    faults: Sequence[str],
    look: Callable[[], list[str]],
    on_minute: Callable[[], None],
) -> tuple[list[Trial], list[Life]]:
    """Inflict a fault each minute, one after the other and from the first again; ``look`` says what
    `inhand status` calls wrong. Raises InhandError where a fault has ended somebody for good."""
    meter, trials, begin = Meter(rig), [], time.monotonic()
    with meter.reading():
        for number, name in enumerate(itertools.islice(itertools.cycle(faults), minutes)):
            trials.append(inflict(name, FAULTS[name], rig, look))
            next_at = begin + (number + 1) * DEFAULT_CHAOS.soak_every_s
            time.sleep(max(0.0, next_at - time.monotonic()))
            on_minute()
    return trials, meter.lives()


def grown(life: Life, parameters: ChaosParameters = DEFAULT_CHAOS) -> list[str]:
    """What a process has gained that it should not, a line each."""
    gained = float(parameters.most_gained)
    most = {"MB": parameters.most_grown_mb, "handles": gained, "threads": gained}
    return [
        f"the {life.name} has gained {life.courses[measure].gained:.0f} {measure}"
        for measure in MEASURES
        if life.courses[measure].gained > most[measure]
    ]
