"""``inhand bench handovers``: whether people who hand something over keep their numbers, and where
a prior has a real thing that passes on."""

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np
from inhand_lab.benchmarks.handover_ids import HandoverIds, check_handovers
from inhand_lab.benchmarks.real_handover import RealHandover, check_real_handover
from inhand_lab.workers import usable_cores
from inhand_lab.world.parameters import RIG_CAMERAS
from inhand_runtime.errors import SettingsError
from rich.table import Table

from inhand.looking import positive_count
from inhand.progress import progress_bar
from inhand.results import listing

DEFAULT_SEEDS = (6100,)
DEFAULT_CAMERAS = 3
DEFAULT_TRIALS = 20


def add_handover_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of this subject alone."""
    parser.add_argument(
        "--trials",
        type=positive_count,
        metavar="N",
        help="for handovers: so many seeds, one after the other, from each of --seeds "
        f"(default: {DEFAULT_TRIALS})",
    )


def measure_handovers(arguments: argparse.Namespace) -> tuple[Table, dict[str, Any]]:
    """Check all handovers, or the real one; raises SettingsError for what cannot be simulated, and
    DatasetError for a recording of another kind."""
    if arguments.real:
        return _measure_real(arguments)
    cameras = DEFAULT_CAMERAS if arguments.cameras is None else arguments.cameras
    if not 1 <= cameras <= len(RIG_CAMERAS):
        raise SettingsError(f"--cameras is from 1 to {len(RIG_CAMERAS)}, not {cameras}")
    trials = range(arguments.trials or DEFAULT_TRIALS)
    seeds = [first + trial for first in arguments.seeds or DEFAULT_SEEDS for trial in trials]
    with progress_bar("handing over", len(seeds)) as advance:
        checks = check_handovers(seeds, cameras, usable_cores(), advance)
    return handovers_table(checks), {"handovers": [{**asdict(c), "right": c.right} for c in checks]}


def _measure_real(arguments: argparse.Namespace) -> tuple[Table, dict[str, Any]]:
    if len(arguments.real) > 1 or arguments.trials or arguments.seeds:
        raise SettingsError("--real takes one recording in place of --trials and --seeds")
    check = check_real_handover(arguments.real[0])
    return real_handover_table(check), asdict(check)


def real_handover_table(check: RealHandover) -> Table:
    """Where the prior has the thing while one person alone holds it, and who has it."""
    table = listing(
        ("held by",),
        ("frames", "off\ncm", "at most\ncm", "following\ncm", "said: ±\ncm", "in the 90 %\nregion"),
        "a baton by the prior of a mug in simulated handovers",
    )
    for one in check.people:
        metres = (one.mean_m, one.largest_m, one.following_m, one.deviation_m)
        table.add_row(
            one.person,
            str(one.frames),
            *(f"{100 * value:.1f}" for value in metres),
            f"{100 * one.region_share:.0f} %",
        )
    table.caption = (
        f"whose prior is nearer has it in {check.right_holder} of {check.held_frames} frames; it "
        f"passes at {check.passes_s:.2f} s by the forces, at {check.passes_by_prior_s:.2f} s by "
        "the prior"
    )
    return table


def handovers_table(checks: Sequence[HandoverIds]) -> Table:
    """The numbers of giver and taker in each handover, and how many are right."""
    table = listing(
        ("seed", "giver", "taker", "right", "alone"),
        ("unseen", "third", "off\ncm", "at most\ncm"),
        "numbers of two people who hand over a mug and pass each other",
    )
    for check in checks:
        table.add_row(
            str(check.seed),
            *(_told(numbers) for numbers in check.numbers),
            "yes" if check.right else "NO",
            ", ".join(map(str, check.camera_numbers.values())),
            str(check.unseen),
            str(check.with_a_third),
            f"{100 * check.mean_m:.1f}",
            f"{100 * check.largest_m:.1f}",
        )
    right = sum(check.right for check in checks)
    table.caption = (
        f"right in {right} of {len(checks)}, of {sum(check.frames for check in checks):,} frames; "
        f"joints {100 * np.mean([check.mean_m for check in checks]):.1f} cm off; alone: how many "
        f"numbers each camera gives to both ({', '.join(checks[0].camera_numbers)})"
    )
    return table


def _told(numbers: Mapping[int, int]) -> str:
    """The number of somebody; of several, each with its frames."""
    if len(numbers) == 1:
        return str(next(iter(numbers)))
    return ", ".join(f"{number} ({frames})" for number, frames in sorted(numbers.items())) or "-"
