"""What of a trial is in no recording."""

import numpy as np
from inhand_lab.chaos.account import Unrecorded, unrecorded
from inhand_lab.chaos.trials import Span, Trial
from inhand_lab.chaos.watch import Arrivals, Recovery

CAPTURED = 99.0 + 0.1 * np.arange(50)
CAME = Arrivals(CAPTURED, CAPTURED + 0.01, CAPTURED)
TRIAL = Trial(
    "kill-recorder", Span(100.0, 100.0, 112.0), Recovery(0, 0, 0), CAME, 0, [], [], 0.0, 0
)


def test_where_all_is_recorded_nothing_is_missing() -> None:
    assert unrecorded(TRIAL, CAPTURED) == Unrecorded(0, 0.0)


def test_what_is_missing_from_before_the_fault_is_told_in_seconds() -> None:
    missing = (CAPTURED > 99.55) & (CAPTURED < 101.0)
    found = unrecorded(TRIAL, CAPTURED[~missing])
    assert found.skeletons == int(missing.sum())
    assert np.isclose(found.before_s, 100.0 - 99.6)


def test_what_is_missing_from_after_the_fault_is_none_that_was_there() -> None:
    found = unrecorded(TRIAL, CAPTURED[CAPTURED < 100.05])
    assert found == Unrecorded(39, 0.0)
