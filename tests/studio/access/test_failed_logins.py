"""Who fails too often waits."""

from inhand_studio.access.failed_logins import FailedLogins
from inhand_studio.access.parameters import DEFAULT_GATE as GATE


def test_an_address_waits_after_its_failures_until_they_are_old_and_others_do_not() -> None:
    now = [0.0]
    failed = FailedLogins(clock=lambda: now[0])
    for _ in range(GATE.failures_an_address):
        assert failed.wait_s("10.0.0.1") == 0.0
        failed.note("10.0.0.1")
    assert failed.wait_s("10.0.0.1") == GATE.window_s
    assert failed.wait_s("10.0.0.2") == 0.0
    now[0] = GATE.window_s
    assert failed.wait_s("10.0.0.1") == 0.0


def test_addresses_that_one_caller_can_choose_wait_together() -> None:
    failed = FailedLogins(clock=lambda: 0.0)
    for number in range(GATE.failures_an_address):
        failed.note(f"2001:db8::{number:x}")
    assert failed.wait_s("2001:db8::ffff") > 0.0
    assert failed.wait_s("2001:db8:0:1::1") == 0.0
    for _ in range(GATE.failures_an_address):
        failed.note("::ffff:10.0.0.1")
    assert failed.wait_s("10.0.0.1") > 0.0


def test_a_guess_that_is_spread_over_many_addresses_waits_too() -> None:
    failed = FailedLogins(clock=lambda: 0.0)
    for number in range(GATE.failures_in_all):
        failed.note(f"10.0.{number}.1")
    assert failed.wait_s("10.9.9.9") == GATE.window_s
    assert failed.total == GATE.failures_in_all
