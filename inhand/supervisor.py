"""Keeps child processes running, and leaves none behind."""

import logging
import signal
import threading
import time
from types import FrameType

from inhand_runtime.exit_codes import DONE, FAILED, WRONG_USAGE
from inhand_runtime.service_manager import ServiceManager

from inhand.child import STOP_WITHIN_S, Child
from inhand.reloading import Reloading
from inhand.rig_processes import RigProcess

log = logging.getLogger(__name__)

TICK_S = 0.05
UP_WITHIN_S = 20.0


class Supervisor:
    """Runs the processes of a plan until all are done, one starts with wrong settings, or it shall
    end.

    It ends on SIGTERM or SIGINT, and when ``stop`` is set. Processes are stopped stage by stage in
    the given order, so that what is under way reaches the last, and started in reverse: a stage
    begins when the one after it is up, or has had time enough, so that nothing early is missed.
    Where the plan takes over settings, those of which nothing changed go on. A child whose work
    comes round no more is killed, and so started again.
    """

    def __init__(self, plan: Reloading, stop: threading.Event) -> None:
        self._plan = plan
        self._stop = stop
        self._manager = ServiceManager()
        self._signals = 0
        self._stages = [[self._child(one) for one in stage] for stage in plan.stages]
        self._waiting = list(self._stages)
        self._started: list[Child] = []
        self._leaving: list[Child] = []
        self._next_stage_at = time.monotonic()
        self._has_started_all = False

    def run(self) -> int:
        """Exit code 0, 1 when a child had to be killed, or 2 for wrong settings."""
        previous = {
            number: signal.signal(number, self._note) for number in (signal.SIGTERM, signal.SIGINT)
        }
        try:
            code = self._tend()
            return FAILED if not self._end_all() and code == DONE else code
        finally:
            for child in (*self._leaving, *self._children()):
                child.kill()
            for number, handler in previous.items():
                signal.signal(number, handler)

    def _note(self, _number: int, _frame: FrameType | None) -> None:
        self._signals += 1

    def _children(self) -> list[Child]:
        return [child for stage in reversed(self._stages) for child in stage]

    def _tend(self) -> int:
        while not (self._signals or self._stop.is_set()):
            self._take_over()
            self._begin_next_stage()
            for child in self._started:
                if child.tend() == WRONG_USAGE and child.done:
                    log.error("%s has wrong settings (see above): stopping everything", child.name)
                    return WRONG_USAGE
                child.kill_if_it_hangs()
            self._has_started_all |= not self._waiting
            if self._has_started_all:
                self._report()
            if not (self._waiting or self._leaving) and all(one.done for one in self._started):
                return DONE
            time.sleep(TICK_S)
        return DONE

    def _take_over(self) -> None:
        """End what settings that were taken over do not name as it is, and let others wait."""
        if (stages := self._plan.taken()) is None:
            return
        before = {child.name: child for child in self._children()}
        self._stages = [
            [self._child(one, before.get(one.name)) for one in stage] for stage in stages
        ]
        after = self._children()
        for child in before.values():
            if child not in after:
                child.leave()
                self._leaving.append(child)
        self._started = [child for child in self._started if child in after]
        waiting = [[one for one in stage if one not in self._started] for stage in self._stages]
        self._waiting = [stage for stage in waiting if stage]
        self._next_stage_at = time.monotonic()

    def _child(self, process: RigProcess, before: Child | None = None) -> Child:
        """Return the child that runs a process: that of before where nothing of it changed."""
        if before is not None and before.settings == process.settings:
            return before
        return Child(process.name, process.command, process.settings, self._plan.environment)

    def _begin_next_stage(self) -> None:
        """Start a stage when its time has come, and none that is to end still has its name."""
        self._leaving = [child for child in self._leaving if not child.has_left()]
        if not self._waiting or self._leaving:
            return
        if time.monotonic() > self._next_stage_at or all(
            child.done or child.is_up for child in self._started
        ):
            self._started += self._waiting.pop()
            self._next_stage_at = time.monotonic() + UP_WITHIN_S

    def _report(self) -> None:
        """Tell systemd, where it started this process, that all were started, and how many run."""
        children = self._children()
        running = sum(not child.ended() for child in children)
        self._manager.status(f"{running} of {len(children)} processes run")
        self._manager.advanced()

    def _end_all(self) -> bool:
        """Ask all to end; False when one had to be killed. A second signal kills at once."""
        self._manager.stopping()
        signals = self._signals
        all_ended = True
        for stage in (self._leaving, *self._stages):
            for child in stage:
                child.send(signal.SIGTERM)
            end = time.monotonic() + STOP_WITHIN_S
            while not all(child.ended() for child in stage):
                if time.monotonic() > end or self._signals > signals:
                    break
                time.sleep(TICK_S)
            for child in stage:
                if not child.ended():
                    log.error("%s did not end by itself: killed", child.name)
                    child.kill()
                    all_ended = False
        return all_ended
