"""``inhand bench rigs``: what several cameras are worth together."""

import argparse
import math
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import numpy as np
from inhand_lab.benchmarks.parameters import DEFAULT_RIGS
from inhand_lab.benchmarks.rig_accuracy import RigCheck, RigRun, check_rigs
from inhand_lab.workers import usable_cores
from inhand_lab.world.parameters import RIG_CAMERAS
from inhand_runtime.errors import SettingsError
from inhand_tracker.rig.placing import PlaceDeviation
from rich.table import Table

from inhand.progress import progress_bar

DEFAULT_SEEDS = (6000,)
DEFAULT_CAMERAS = 3


def add_rig_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of this subject alone."""
    parser.add_argument(
        "--cameras",
        type=int,
        metavar="N",
        help=f"for rigs and handovers: number of cameras, up to {len(RIG_CAMERAS)} "
        f"(default: {DEFAULT_CAMERAS})",
    )
    parser.add_argument(
        "--interactions",
        nargs="+",
        metavar="I",
        help=f"for rigs: what people do (default: {' '.join(DEFAULT_RIGS.interactions)})",
    )
    parser.add_argument(
        "--standing", action="store_true", help="for rigs: people who stay where they are"
    )
    for unit, what in (("mm", "millimetres"), ("deg", "degrees")):
        parser.add_argument(
            f"--placed-off-{unit}",
            type=float,
            default=0.0,
            metavar="X",
            help=f"for rigs: {what} by which each camera is elsewhere than its calibration says, "
            "root mean square, which that states (default: 0)",
        )


def measure_rigs(arguments: argparse.Namespace) -> tuple[Table, dict[str, Any]]:
    """Track all runs; raises SettingsError for what cannot be simulated."""
    cameras = DEFAULT_CAMERAS if arguments.cameras is None else arguments.cameras
    if not 2 <= cameras <= len(RIG_CAMERAS):
        raise SettingsError(f"--cameras is from 2 to {len(RIG_CAMERAS)}, not {cameras}")
    off_mm, off_deg = arguments.placed_off_mm, arguments.placed_off_deg
    if not all(0.0 <= off < math.inf for off in (off_mm, off_deg)):
        raise SettingsError("--placed-off-mm and --placed-off-deg are 0 or more")
    off = PlaceDeviation(1e-3 * off_mm / math.sqrt(3.0), math.radians(off_deg) / math.sqrt(3.0))
    runs = [
        RigRun(interaction, seed, cameras, roaming=not arguments.standing, placed_off=off)
        for seed in arguments.seeds or DEFAULT_SEEDS
        for interaction in arguments.interactions or DEFAULT_RIGS.interactions
    ]
    with progress_bar("tracking", len(runs)) as advance:
        try:
            checks = check_rigs(runs, usable_cores(), advance)
        except ValueError as error:
            raise SettingsError(str(error)) from None
    return rigs_table(checks), {"recordings": [asdict(check) for check in checks], **_whole(checks)}


def rigs_table(checks: Sequence[RigCheck]) -> Table:
    """Errors of each recording, and of all together."""
    names = list(checks[0].single_m)
    table = Table("", title="vertex error, cm")
    columns = (*names, "best", "mean", "all", "all / best", "all / mean", "no pose", "leap, cm")
    for column in (*columns, "in region", "cost"):
        table.add_column(column, justify="right")
    for check in checks:
        table.add_row(
            f"{check.interaction} {check.seed}",
            *(_cm(error) for error in check.single_m.values()),
            *_errors(check.best_m, check.mean_m, check.fused_m),
            f"{check.without_pose} of {check.frames}",
            f"{100 * check.jump_m:.1f} ({check.killed})",
            f"{100 * check.region_share:.0f} %",
            f"{check.fused_ms / check.single_ms:.2f}",
        )
    whole = _whole(checks)
    table.add_section()
    table.add_row(
        "all",
        *(_cm(float(np.mean([check.single_m[name] for check in checks]))) for name in names),
        *_errors(whole["best_m"], whole["mean_m"], whole["fused_m"]),
        f"{100 * whole['without_pose']:.2f} %",
        f"{100 * whole['jump_m']:.1f}",
        f"{100 * whole['region_share']:.0f} %",
        f"{whole['cost_ratio']:.2f}",
    )
    return table


def _whole(checks: Sequence[RigCheck]) -> dict[str, float]:
    """Means over all recordings, the share of frames without a pose, and the largest leap."""
    best, mean, fused = (
        float(np.mean([getattr(check, name) for check in checks]))
        for name in ("best_m", "mean_m", "fused_m")
    )
    frames = sum(check.frames for check in checks)
    return {
        "best_m": best,
        "mean_m": mean,
        "fused_m": fused,
        "best_ratio": fused / best,
        "mean_ratio": fused / mean,
        "without_pose": sum(check.without_pose for check in checks) / frames,
        "killed_without_pose": sum(check.killed_without_pose for check in checks) / frames,
        "jump_m": max(check.jump_m for check in checks),
        "region_share": float(np.mean([check.region_share for check in checks])),
        "cost_ratio": float(np.median([check.fused_ms / check.single_ms for check in checks])),
    }


def _errors(best: float, mean: float, fused: float) -> tuple[str, ...]:
    return _cm(best), _cm(mean), _cm(fused), f"{fused / best:.2f}", f"{fused / mean:.2f}"


def _cm(metres: float) -> str:
    return f"{100 * metres:.2f}"
