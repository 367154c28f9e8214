"""Inflicts faults on a rig, one after the other, and says what each cost."""

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from inhand_schemas.topics import POSE, SKELETONS

from inhand_lab.chaos.faults import Fault
from inhand_lab.chaos.parameters import DEFAULT_CHAOS
from inhand_lab.chaos.rig import ChaosRig
from inhand_lab.chaos.watch import Arrivals, Recovery, recovery_of


@dataclass(frozen=True)
class Span:
    """When a fault's cause began and ended, and until when the rig was watched, in seconds since
    the epoch."""

    begin: float
    end: float
    until: float


@dataclass(frozen=True)
class Trial:
    """What a fault did: how ``poses`` came back, the ``skeletons`` that came, for how many of them
    no pose came, what `inhand status` called wrong meanwhile, which processes ended of it that
    should not, by how much memory the others grew at the most, in MB, and how many messages were
    counted as malformed."""

    name: str
    span: Span
    poses: Recovery
    skeletons: Arrivals
    without_pose: int
    told: list[str]
    died: list[str]
    grown_mb: float
    malformed: int


def inflict(name: str, fault: Fault, rig: ChaosRig, look: Callable[[], list[str]]) -> Trial:
    """Inflict a fault and watch the rig; ``look`` says what `inhand status` calls wrong.

    Raises InhandError where a former fault has ended the victim for good.
    """
    time.sleep(DEFAULT_CHAOS.well_s)
    before, resident_mb, malformed = rig.processes(), rig.resident_mb(), rig.watch.malformed()
    begin = time.time()
    with fault.inflict(rig):
        end = time.time()
        told = look()
        time.sleep(max(begin + fault.lasts_s - time.time(), 0.0))
    if fault.lasts_s > 0.0:
        end = time.time()
    time.sleep(max(end + DEFAULT_CHAOS.watched_s - time.time(), 0.0))
    span = Span(begin, end, time.time())
    skeletons = rig.watch.of(SKELETONS).between(span.begin, span.until - 1.0)
    posed = rig.watch.of(POSE)
    return Trial(
        name,
        span,
        recovery_of(posed, span.begin, span.end, span.until),
        skeletons,
        int((~np.isin(skeletons.stamps, posed.stamps)).sum()),
        told,
        [
            service
            for service, process in before.items()
            if service != fault.victim and not process.is_running()
        ],
        max((now - resident_mb.get(pid, now) for pid, now in rig.resident_mb().items()), default=0),
        max(rig.watch.malformed() - malformed, 0),
    )
