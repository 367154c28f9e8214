"""Where the real recordings lie that some tests read, beside the checkout."""

from pathlib import Path

import pytest

DATA = Path(__file__).resolve().parents[3] / "shared" / "data"

needs_real_data = pytest.mark.skipif(
    not DATA.is_dir(), reason="the real recordings (../shared/data) are not on this machine"
)
