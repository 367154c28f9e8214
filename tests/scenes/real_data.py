"""Where the real recordings lie that some tests read, beside the checkout."""

from pathlib import Path

DATA = Path(__file__).resolve().parents[3] / "shared" / "data"
