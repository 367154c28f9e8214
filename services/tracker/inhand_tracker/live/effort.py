"""How much of its usual work a tracker does in a step, so that steps fit into the camera's period.

There is no clock here: who times the steps says how long each took.
"""

from dataclasses import dataclass, replace
from statistics import median

from inhand_tracker.live.parameters import DEFAULT_EFFORT, EffortParameters


@dataclass(frozen=True)
class Effort:
    """``share`` of the usual work, up to 1, and the ``loads`` of the steps that were done with it.

    The load of a step is its time in periods of the camera.
    """

    share: float = 1.0
    loads: tuple[float, ...] = ()


def after_step(
    effort: Effort,
    step_s: float,
    period_s: float,
    parameters: EffortParameters = DEFAULT_EFFORT,
) -> Effort:
    """The effort of the next step, after one that took ``step_s`` of the camera's ``period_s``."""
    loads = (*effort.loads, step_s / period_s)
    load = median(loads)
    late = len(loads) >= parameters.late_steps and load > 1.0
    if len(loads) < parameters.steps and not late:
        return replace(effort, loads=loads)
    if parameters.least_load <= load <= parameters.most_load:
        return Effort(effort.share)
    whole_load = load / effort.share
    if whole_load <= parameters.aim_load:
        return Effort()
    return Effort(max(parameters.aim_load / whole_load, parameters.least))
