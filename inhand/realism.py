"""The realism table: what real sensors do beside what the simulated ones do."""

import math
import sys
from pathlib import Path
from typing import Any

from inhand_lab.realism import LEFT_OUT, STAGES, WITHIN, Comparison, compare
from inhand_lab.world import VERSION
from inhand_runtime.errors import SettingsError
from rich.console import Console
from rich.table import Table

from inhand.progress import progress_bar
from inhand.results import write_json

USUAL_DATA = Path("../shared/data")
REAL_SET = "utd-mhad"


def show_realism(data: Path, json_file: Path | None) -> int:
    """Print the table, and write it for machines; 1 where a property is too far off.

    Raises SettingsError where the real recordings are missing, and DatasetError.
    """
    folder = data / REAL_SET if (data / REAL_SET).is_dir() else data
    if not folder.is_dir():
        raise SettingsError(
            f"there are no real recordings at {folder.resolve()}: "
            f"name the folder that holds {REAL_SET} with --data"
        )
    with progress_bar("measuring", STAGES) as advance:
        compared = compare(folder, advance)
    console = Console()
    console.print(_table(compared))
    console.print("Knowingly left out:")
    for reason in LEFT_OUT:
        console.print(f"- {reason}")
    if json_file is not None:
        write_json(json_file, _result(compared))
    off = [one for one in compared if not one.within]
    if off:
        print(
            f"inhand simulate: {len(off)} of {len(compared)} properties are off by more than a "
            f"factor of {WITHIN}",
            file=sys.stderr,
        )
    return int(bool(off))


def _table(compared: list[Comparison]) -> Table:
    table = Table("property", "of", "real", "simulated", "ratio", title=f"world {VERSION}")
    for one in compared:
        unit = f", {one.unit}" if one.unit else ""
        ratio = f"{one.ratio:.2f}" if one.within else f"[bold red]{one.ratio:.2f}[/]"
        table.add_row(f"{one.name}{unit}", one.on, f"{one.real:.3g}", f"{one.simulated:.3g}", ratio)
    return table


def _result(compared: list[Comparison]) -> dict[str, Any]:
    return {
        "version": VERSION,
        "within": WITHIN,
        "properties": [
            {
                "property": one.name,
                "unit": one.unit,
                "of": one.on,
                "real": one.real,
                "simulated": one.simulated if math.isfinite(one.simulated) else None,
                "ratio": one.ratio if math.isfinite(one.ratio) else None,
            }
            for one in compared
        ],
        "left_out": list(LEFT_OUT),
    }
