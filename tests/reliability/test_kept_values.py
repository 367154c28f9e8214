"""A camera's info reaches everybody, in whatever order a rig's processes start."""

import pytest
from random_starts import LATE_S, TOGETHER, run_trials


@pytest.mark.long
def test_no_start_in_random_order_misses_the_info() -> None:
    assert max(run_trials(TOGETHER, seed=1)) < LATE_S
