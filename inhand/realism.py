"""Shows the realism table: what real sensors do beside what the simulated ones do."""

import math
import sys
from dataclasses import asdict
from pathlib import Path
from typing import Any

from inhand_lab.realism.parameters import DEFAULT_REALISM
from inhand_lab.realism.posture_angles import AngleSpread
from inhand_lab.realism.posture_comparison import (
    PostureComparison,
    VarietyComparison,
    compare_postures,
    compare_variety,
    posture_table,
    recorded_sources,
    variety_note,
)
from inhand_lab.realism.sensor_comparison import LEFT_OUT, STEPS, SensorComparison, compare_sensors
from inhand_lab.world.random_streams import GENERATOR_VERSION
from inhand_runtime.errors import SettingsError
from inhand_runtime.wording import counted
from rich.console import Console
from rich.table import Table

from inhand.progress import progress_bar
from inhand.results import write_json

USUAL_DATA = Path("../shared/data")
REAL_SET = "utd-mhad"


def show_realism(data: Path, seed: int, json_file: Path | None) -> int:
    """Print the tables of the world of a seed, and write them for machines.

    Return 1 where a judged property is too far off; postures are shown, not judged. Raises
    SettingsError where the real recordings are missing, and DatasetError.
    """
    folder = data / REAL_SET if (data / REAL_SET).is_dir() else data
    if not folder.is_dir():
        raise SettingsError(
            f"there are no real recordings at {folder.resolve()}: "
            f"name the folder that holds {REAL_SET} with --data"
        )
    sources = recorded_sources(data)
    with progress_bar("measuring", STEPS + len(sources)) as advance:
        compared = compare_sensors(folder, seed, advance)
        postures: list[list[PostureComparison]] = []
        varieties: list[VarietyComparison] = []
        for source in sources:
            postures.append(compare_postures(source, seed))
            varieties.append(compare_variety(source, seed))
            advance()
    judged = [one for one in compared if one.judged]
    others = [one for one in compared if not one.judged]
    console = Console()
    console.print(_table(f"world {GENERATOR_VERSION}, seed {seed}", judged))
    if others:
        console.print(_table("too few people to tell: not judged", others))
    for angles, variety in zip(postures, varieties, strict=True):
        console.print(posture_table(angles, seed), variety_note(variety), sep="\n")
    console.print("Knowingly left out:")
    for reason in LEFT_OUT:
        console.print(f"- {reason}")
    if json_file is not None:
        write_json(json_file, {**_result(compared, seed), **_postures(postures, varieties)})
    off = [one for one in judged if not one.within]
    console.print(_verdict(len(judged), len(off), len(others)))
    if off:
        print(
            f"inhand simulate: {len(off)} of {len(judged)} properties are off by more than a "
            f"factor of {DEFAULT_REALISM.within}",
            file=sys.stderr,
        )
    return int(bool(off))


def _verdict(judged: int, off: int, others: int) -> str:
    limits = DEFAULT_REALISM
    return (
        f"{counted(judged, 'property', 'properties')} judged, {judged - off} of them within a "
        f"factor of {limits.within}. {others} more not judged: with eight other people the real "
        f"figure itself might be off by more than that "
        f"({limits.confidence:.0%} interval of the bootstrap)."
    )


def _table(title: str, compared: list[SensorComparison]) -> Table:
    table = Table("property", "of", "real", "from", "to", "simulated", "ratio", title=title)
    for one in compared:
        unit = f", {one.unit}" if one.unit else ""
        numbers = (one.real, one.lowest, one.highest, one.simulated)
        table.add_row(
            f"{one.name}{unit}",
            one.on,
            *(f"{number:.3g}" for number in numbers),
            f"[bold red]{one.ratio:.2f}[/]"
            if one.judged and not one.within
            else f"{one.ratio:.2f}",
        )
    return table


def _result(compared: list[SensorComparison], seed: int) -> dict[str, Any]:
    return {
        "version": GENERATOR_VERSION,
        "seed": seed,
        "within": DEFAULT_REALISM.within,
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
                "judged": one.judged,
            }
            for one in compared
        ],
        "left_out": list(LEFT_OUT),
    }


def _postures(
    postures: list[list[PostureComparison]], varieties: list[VarietyComparison]
) -> dict[str, Any]:
    return {
        "postures": [
            {
                "source": one.source,
                "angle": one.angle,
                "group": one.group,
                "real_deg": _spread(one.real),
                "simulated_deg": _spread(one.simulated),
                "covered": _number(one.covered),
            }
            for angles in postures
            for one in angles
        ],
        "nearest_pose_of_others": [
            {
                "source": one.source,
                "real": _number(one.real),
                "simulated": _number(one.simulated),
            }
            for one in varieties
        ],
    }


def _spread(spread: AngleSpread) -> dict[str, float | None]:
    return {name: _number(value) for name, value in asdict(spread).items()}


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None
