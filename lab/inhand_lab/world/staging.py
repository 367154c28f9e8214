"""When a rig's performances are shown: by the wall clock, so that several processes agree.

Performance N begins N lengths after the start. Whoever reads the clock knows which one is on, and
where in it, without asking another process.
"""

from __future__ import annotations

import contextlib
import itertools
import os
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from inhand_lab.world.rigs import RigView


@dataclass(frozen=True)
class Staging:
    """The first performance begins at ``start_ns`` (since the epoch), and each takes ``length_ns``.

    Without ``loop`` there is one alone. A further one is prepared ``ahead_ns`` before it begins,
    but not before the one that is on is shown, and ``apart_ns`` later if time is left.
    ``own_clock`` says that stamps are by the camera's clock, and not by the host's.
    """

    start_ns: int
    length_ns: int
    ahead_ns: int
    apart_ns: int = 0
    loop: bool = True
    own_clock: bool = False

    def performance_at(self, time_ns: int) -> int:
        """Number of the performance that is on at a time, 0 before the first."""
        return max(0, (time_ns - self.start_ns) // self.length_ns) if self.loop else 0

    def begin_ns(self, performance: int) -> int:
        """When a performance begins, nanoseconds since the epoch."""
        return self.start_ns + performance * self.length_ns

    def prepared_ns(self, performance: int, shown_ns: int) -> int:
        """When the one after a performance, first shown at a time, is prepared."""
        next_ns = self.begin_ns(performance + 1)
        first_ns = max(shown_ns, next_ns - self.ahead_ns)
        return first_ns + min(self.apart_ns, (next_ns - first_ns) // 2)


@dataclass(frozen=True)
class StagedFrame:
    """A frame of a view that is taken at ``due_ns``, when its clock says ``stamp_ns``."""

    view: RigView
    frame: int
    due_ns: int
    stamp_ns: int


def staged_frames(
    staging: Staging, perform: Callable[[int], RigView], first: tuple[int, RigView]
) -> Iterator[StagedFrame]:
    """Yield the frames of one performance after another that are still to be taken.

    ``perform`` simulates a performance, and ``first`` is one that is there already, with its
    number. Lost frames and those whose time is past are left out. Where somebody sets the clock,
    it goes on with the performance that is on then.
    """
    number, view = first
    with ThreadPoolExecutor(1, "simulator", _give_way) as executor:
        while True:
            current = staging.performance_at(time.time_ns())
            if number < current or number > current + 1:
                number, view = current, perform(current)
            following: Future[RigView] | None = None
            prepared_ns = staging.prepared_ns(number, time.time_ns())
            for frame in _frames_of(staging, number, view):
                if frame.due_ns - time.time_ns() > 2 * staging.length_ns and number:
                    break
                if staging.loop and following is None and frame.due_ns >= prepared_ns:
                    following = executor.submit(perform, number + 1)
                yield frame
            if not staging.loop:
                return
            number += 1
            view = following.result() if following else perform(number)


def _give_way() -> None:
    """Let this thread compute when nobody else wants to: no real camera takes the processor from
    whoever watches it."""
    thread = threading.get_native_id()
    # On other systems than Linux threads have no priority of their own.
    with contextlib.suppress(OSError):
        os.setpriority(os.PRIO_PROCESS, thread, os.getpriority(os.PRIO_PROCESS, thread) + 10)


def _frames_of(staging: Staging, number: int, view: RigView) -> Iterator[StagedFrame]:
    begin_ns = staging.begin_ns(number)
    due = np.rint(1e9 * view.times_s()).astype(np.int64)
    stamps = view.stamps_ns() if staging.own_clock else due
    for frame in itertools.compress(range(len(due)), ~view.dropped):
        due_ns = begin_ns + int(due[frame])
        if due_ns >= time.time_ns():
            yield StagedFrame(view, frame, due_ns, begin_ns + int(stamps[frame]))
