"""What readings of a process say of its growth."""

import numpy as np
import pytest
from inhand_lab.chaos.parameters import DEFAULT_CHAOS
from inhand_lab.chaos.soak import grown, life_of

SECONDS = np.arange(0.0, 1800.0, 2.0)


def _rows(mb: np.ndarray, handles: np.ndarray | float, threads: float = 20.0) -> np.ndarray:
    columns = [SECONDS, mb, handles, threads]
    return np.stack(np.broadcast_arrays(*columns), axis=1).astype(float)


def test_a_process_that_only_grows_at_its_begin_is_flat() -> None:
    life = life_of("tracker", _rows(np.minimum(100.0 + SECONDS, 180.0), 22.0))
    assert life.minutes == pytest.approx(30.0, abs=0.1)
    assert [course.per_hour for course in life.courses.values()] == pytest.approx([0.0] * 3)
    assert grown(life) == []


def test_steady_growth_is_told_with_its_slope() -> None:
    life = life_of("recorder", _rows(50.0 + SECONDS / 10.0, 20.0 + SECONDS // 60.0))
    assert life.courses["MB"].per_hour == pytest.approx(360.0)
    assert life.courses["handles"].per_hour == pytest.approx(60.0, rel=0.01)
    assert life.courses["threads"].gained == 0.0
    first, second = grown(life)
    assert first.startswith("the recorder has gained 117 MB")
    assert second == "the recorder has gained 19 handles"


def test_a_pool_that_comes_and_goes_is_no_growth() -> None:
    handles = 20.0 + DEFAULT_CHAOS.most_gained * (SECONDS // 2.0 % 2.0)
    assert grown(life_of("capture", _rows(np.full_like(SECONDS, 90.0), handles))) == []
