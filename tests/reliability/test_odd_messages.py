"""No message, malformed or valid and extreme, ends, hangs or bloats a running rig."""

from pathlib import Path

import pytest
from odd_messages import fuzz


@pytest.mark.long
def test_a_rig_lives_through_malformed_and_extreme_messages(tmp_path: Path) -> None:
    seen = fuzz(tmp_path, 4000, seed=3)
    assert seen["alive"]
    assert seen["pose_after_s"] < 5.0
    assert max(seen["grown_mb"]) < 50.0
