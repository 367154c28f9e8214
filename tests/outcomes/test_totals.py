"""What adds up over a day, and what does not."""

import pytest
from inhand_outcomes.outcome import adds_up


@pytest.mark.parametrize(
    ("amount", "sums"),
    [
        ("volume_ml", True),
        ("duration_s", True),
        ("area_m2", True),
        ("stroke_count", True),
        ("speed_m_s", False),
        ("rate_per_s", False),
        ("turn_deg_s", False),
        ("angle_deg", False),
    ],
)
def test_amounts_add_up_and_speeds_and_rates_do_not(amount: str, sums: bool) -> None:
    assert adds_up(amount) is sums
