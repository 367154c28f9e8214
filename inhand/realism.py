"""The realism table: what real sensors do beside what the simulated ones do."""

import math
import sys
from pathlib import Path
from typing import Any

from inhand_lab.realism.comparison import CONFIDENCE, LEFT_OUT, STAGES, WITHIN, Comparison, compare
from inhand_lab.world.random_streams import GENERATOR_VERSION
from inhand_runtime.errors import SettingsError
from rich.console import Console
from rich.table import Table

from inhand.progress import progress_bar
from inhand.results import write_json

USUAL_DATA = Path("../shared/data")
REAL_SET = "utd-mhad"


def show_realism(data: Path, seed: int, json_file: Path | None) -> int:
    """Print the table of the world of a seed, and write it for machines; 1 where a property that
    can be told is too far off.

    Raises SettingsError where the real recordings are missing, and DatasetError.
    """
    folder = data / REAL_SET if (data / REAL_SET).is_dir() else data
    if not folder.is_dir():
        raise SettingsError(
            f"there are no real recordings at {folder.resolve()}: "
            f"name the folder that holds {REAL_SET} with --data"
        )
    with progress_bar("measuring", STAGES) as advance:
        compared = compare(folder, seed, advance)
    told = [one for one in compared if one.told]
    untold = [one for one in compared if not one.told]
    console = Console()
    console.print(_table(f"world {GENERATOR_VERSION}, seed {seed}", told))
    if untold:
        console.print(_table("too few people to tell: not judged", untold))
    console.print("Knowingly left out:")
    for reason in LEFT_OUT:
        console.print(f"- {reason}")
    if json_file is not None:
        write_json(json_file, _result(compared, seed))
    off = [one for one in told if not one.within]
    console.print(
        f"{len(told)} properties judged, {len(told) - len(off)} of them within a factor of "
        f"{WITHIN}. {len(untold)} more are not judged: with eight other people the real figure "
        f"itself might be off by more than that ({CONFIDENCE:.0%} interval of the bootstrap)."
    )
    if off:
        print(
            f"inhand simulate: {len(off)} of {len(told)} properties are off by more than a "
            f"factor of {WITHIN}",
            file=sys.stderr,
        )
    return int(bool(off))


def _table(title: str, compared: list[Comparison]) -> Table:
    table = Table("property", "of", "real", "from", "to", "simulated", "ratio", title=title)
    for one in compared:
        unit = f", {one.unit}" if one.unit else ""
        numbers = (one.real, one.lowest, one.highest, one.simulated)
        table.add_row(
            f"{one.name}{unit}",
            one.on,
            *(f"{number:.3g}" for number in numbers),
            f"[bold red]{one.ratio:.2f}[/]" if one.told and not one.within else f"{one.ratio:.2f}",
        )
    return table


def _result(compared: list[Comparison], seed: int) -> dict[str, Any]:
    return {
        "version": GENERATOR_VERSION,
        "seed": seed,
        "within": WITHIN,
        "properties": [
            {
                "property": one.name,
                "unit": one.unit,
                "of": one.on,
                "real": _number(one.real),
                "lowest": _number(one.lowest),
                "highest": _number(one.highest),
                "simulated": _number(one.simulated),
                "ratio": _number(one.ratio),
                "judged": one.told,
            }
            for one in compared
        ],
        "left_out": list(LEFT_OUT),
    }


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None
