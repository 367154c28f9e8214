"""A year of a busy home takes less than a gigabyte."""

from pathlib import Path

import pytest
from busy_home import kept_bytes

GIGABYTE = 1e9
DAYS = 365


@pytest.mark.long
def test_a_year_of_a_busy_home_takes_less_than_a_gigabyte(tmp_path: Path) -> None:
    assert kept_bytes(tmp_path, 1) * DAYS < GIGABYTE
