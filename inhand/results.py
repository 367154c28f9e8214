"""Results for machines."""

import json
from pathlib import Path
from typing import Any

from inhand_runtime.errors import InhandError


def write_json(path: Path, value: Any) -> None:
    """Write a verb's result for machines; raises InhandError."""
    try:
        path.write_text(json.dumps(value, indent=2) + "\n", encoding="utf-8")
    except OSError as error:
        raise InhandError(f"cannot write {path}: {error.strerror}; choose another file") from None
