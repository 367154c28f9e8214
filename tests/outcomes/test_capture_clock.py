"""Time goes on from when the last capture came, however late it is looked at."""

from inhand_outcomes.capture_clock import CaptureClock
from inhand_outcomes.days import NS_PER_S


def test_what_waits_to_be_looked_at_makes_no_time_pass() -> None:
    clock = CaptureClock()
    clock.hear(1_700_000_000 * NS_PER_S, 50.0)
    assert clock.now_ns(50.5) == 1_700_000_000 * NS_PER_S + NS_PER_S // 2
    clock.hear(1_700_000_001 * NS_PER_S, 51.0)  # looked at minutes later
    assert clock.now_ns(51.0) == 1_700_000_001 * NS_PER_S
