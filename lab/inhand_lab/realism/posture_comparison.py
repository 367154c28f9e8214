"""Compares how real people stand and move their limbs with how simulated ones do.

``python -m inhand_lab.realism.posture_comparison DATASET…`` does so with bodies of any datasets.
Each source is compared with simulated people who do what fits its actions, as a Kinect sees them.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from inhand_lab.datasets.dataset import Dataset, DatasetError, load_dataset
from inhand_lab.datasets.labelled_sequence import labelled_sequence
from inhand_lab.driven.dataset import FITTING
from inhand_lab.importers import utd_mhad
from inhand_lab.importers.motion_archive import read_motion
from inhand_lab.realism.parameters import DEFAULT_REALISM
from inhand_lab.realism.posture_angles import (
    POSTURE_ANGLES,
    AngleSpread,
    ObservedPostures,
    share_within,
    spread_of,
)
from inhand_lab.realism.repeatability import body_pose_sequence, distance_to_others
from inhand_lab.world.interactions import INTERACTIONS
from inhand_lab.world.simulation import simulate

GOLF_SWINGS = "golf_*.npz"
"""Motion archives that simulated people have the like of."""


@dataclass(frozen=True)
class PostureSource:
    """Recordings of one source of real skeletons, whose interactions are named as ours that fit."""

    name: str
    recordings: tuple[ObservedPostures, ...]

    def interactions(self) -> list[str]:
        """Return what is done in it, each once."""
        return sorted({one.interaction for one in self.recordings})


@dataclass(frozen=True)
class PostureComparison:
    """An angle as it is spread in a real source and in simulated people, and the share of the real
    frames that lie where simulated ones usually do."""

    source: str
    angle: str
    group: str
    real: AngleSpread
    simulated: AngleSpread
    covered: float


@dataclass(frozen=True)
class VarietyComparison:
    """Median distance, in statures over all joints, from a body pose to the nearest one of five
    others who do the same: how alike people are, really and simulated."""

    source: str
    real: float
    simulated: float


def recorded_sources(data: Path) -> list[PostureSource]:
    """Read the real sources of a folder that are there: UTD-MHAD and swings of motion archives.

    Raises DatasetError for a file that cannot be read.
    """
    folder = data / "utd-mhad" if (data / "utd-mhad").is_dir() else data
    trials = [
        utd_mhad.read_trial(file) for file in sorted(folder.glob(f"*{utd_mhad.SKELETON_SUFFIX}"))
    ]
    motions = [read_motion(file) for file in sorted((data / "motion").glob(GOLF_SWINGS))]
    sources = (
        _source(
            "UTD-MHAD, Kinect",
            [(t.participant, t.interaction, t.joints_in_camera, "right") for t in trials],
        ),
        _source(
            "golf swings, markers",
            [(m.participant, m.interaction, m.joints, m.handedness) for m in motions],
        ),
    )
    return [one for one in sources if one.recordings]


def dataset_source(dataset: Dataset) -> PostureSource:
    """Read the bodies of a dataset; raises DatasetError where no simulated action fits them."""
    read = [(entry, labelled_sequence(dataset, entry)) for entry in dataset.entries]
    source = _source(
        dataset.folder.name,
        [(e.participant, e.interaction, one.joints, e.handedness) for e, one in read],
    )
    if not source.recordings:
        raise DatasetError(
            f"{dataset.folder}: no simulated interaction fits what people do in it: name "
            f"interactions in dataset.toml as one of {', '.join(INTERACTIONS)}"
        )
    return source


def compare_postures(source: PostureSource, seed: int) -> list[PostureComparison]:
    """Compare every angle of a source with simulated people of a seed who do the same."""
    simulated = _simulated(tuple(source.interactions()), seed)
    compared = []
    for angle in POSTURE_ANGLES:
        ours = spread_of(angle, simulated)
        compared.append(
            PostureComparison(
                source.name,
                angle.name,
                angle.group,
                spread_of(angle, source.recordings),
                ours,
                share_within(angle, source.recordings, ours),
            )
        )
    return compared


def compare_variety(source: PostureSource, seed: int) -> VarietyComparison:
    """Compare how alike people of a source are with how alike simulated ones are."""
    simulated = _simulated(tuple(source.interactions()), seed)
    return VarietyComparison(source.name, _variety(source.recordings), _variety(simulated))


def posture_table(compared: Sequence[PostureComparison], seed: int) -> Table:
    """Lay out the comparisons of one source."""
    limits = DEFAULT_REALISM
    table = Table(
        *("angle", "real", "people", "simulated", "people", "covered"),
        title=f"{compared[0].source}, and seed {seed}: median, {limits.usual_share:.0%} of frames "
        "and how people's medians differ, degrees; real frames where simulated ones usually are",
    )
    for before, one in zip((None, *compared), compared, strict=False):
        if before is None or before.group != one.group:
            table.add_section()
            table.add_row(f"[bold]{one.group}[/]")
        share = "-" if np.isnan(one.covered) else f"{one.covered:.0%}"
        wrong = one.covered < limits.least_covered
        table.add_row(
            one.angle,
            *_cells(one.real),
            *_cells(one.simulated),
            f"[bold red]{share}[/]" if wrong else share,
        )
    return table


def variety_note(variety: VarietyComparison) -> str:
    """Say in one sentence how alike people are."""
    if np.isnan(variety.real):
        return f"{variety.source}: one person, or none seen whole, who cannot differ from others"
    return (
        f"{variety.source}: the nearest pose of five others is {variety.real:.3f} statures away, "
        f"of simulated people {variety.simulated:.3f}"
    )


def _cells(spread: AngleSpread) -> tuple[str, str]:
    if np.isnan(spread.median):
        return "-", "-"
    people = "-" if np.isnan(spread.between_people) else f"± {spread.between_people:.0f}"
    return f"{spread.median:.0f} ({spread.lowest:.0f} to {spread.highest:.0f})", people


def _source(name: str, read: Sequence[tuple[str, str, np.ndarray, str]]) -> PostureSource:
    """Make a source of recordings: who, what, joints (T, 20, 3), and by which hand."""
    recordings = [
        ObservedPostures.of(who, FITTING.get(what, what), joints, hand)
        for who, what, joints, hand in read
    ]
    return PostureSource(name, tuple(one for one in recordings if one.interaction in INTERACTIONS))


# Two comparisons of one source ask for the same people.
@lru_cache(maxsize=4)
def _simulated(interactions: tuple[str, ...], seed: int) -> tuple[ObservedPostures, ...]:
    done = [
        simulate(interaction, number, seed)
        for interaction in interactions
        for number in range(DEFAULT_REALISM.participants)
    ]
    return tuple(
        ObservedPostures.of(
            str(one.participant), one.interaction, one.joints_in_camera, one.person.handedness
        )
        for one in done
    )


def _variety(recordings: Sequence[ObservedPostures]) -> float:
    """Mean over interactions of the distance to others; NaN where nobody else does the same."""
    distances = []
    for interaction in sorted({one.interaction for one in recordings}):
        sequences = [
            body_pose_sequence(one.participant, 1.0, "right", one.joints)
            for one in recordings
            if one.interaction == interaction
        ]
        sequences = [one for one in sequences if len(one.bodies)]
        if len({one.participant for one in sequences}) > 1:
            distances.append(distance_to_others(sequences))
    return float(np.mean(distances)) if distances else np.nan


def main() -> None:
    """Compare the bodies of datasets with simulated ones."""
    parser = argparse.ArgumentParser(
        prog="python -m inhand_lab.realism.posture_comparison", description=__doc__
    )
    parser.add_argument("datasets", nargs="+", type=Path, metavar="DATASET")
    parser.add_argument("--seed", type=int, default=0, help="the simulated world (default: 0)")
    arguments = parser.parse_args()
    console = Console()
    for folder in arguments.datasets:
        source = dataset_source(load_dataset(folder))
        console.print(posture_table(compare_postures(source, arguments.seed), arguments.seed))
        console.print(variety_note(compare_variety(source, arguments.seed)))


if __name__ == "__main__":
    main()
