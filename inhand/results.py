"""Results for machines, and tables for people."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from inhand_runtime.errors import InhandError
from rich.table import Table


def write_json(path: Path, value: Any) -> None:
    """Write a verb's result for machines; raises InhandError."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(value, indent=2) + "\n", encoding="utf-8")
    except OSError as error:
        raise InhandError(f"cannot write {path}: {error.strerror}; choose another file") from None


def listing(texts: Sequence[str], numbers: Sequence[str], title: str | None = None) -> Table:
    """Make a table of which nothing is cut where the terminal is narrow: texts take more lines."""
    table = Table(title=title, title_justify="left")
    for name in texts:
        table.add_column(name, overflow="fold")
    for name in numbers:
        table.add_column(name, justify="right", no_wrap=True)
    return table
