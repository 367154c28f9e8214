"""Measures a dataset's skeletons: the row of its convention, and how much its people differ.

``python tests/scenes/skeleton_conventions.py DATASET [PARTICIPANT …]`` prints both, in body
heights, of all people or of those that are named; ``body/convention_table`` holds what it printed.
"""

import argparse
from collections.abc import Collection
from pathlib import Path

import numpy as np
from inhand_lab.datasets.dataset import Dataset, load_dataset
from inhand_lab.datasets.followed_people import follow_people
from inhand_lab.datasets.stretches import entry_frames
from inhand_tracker.body.convention_map import measure_bodies, median_measures
from inhand_tracker.body.convention_table import MEASURES
from inhand_tracker.body.parameters import DEFAULT_BODY
from inhand_tracker.body.skeleton import stature_of
from inhand_tracker.wire.conversion import joints_of


def people_measured(dataset: Dataset, participants: Collection[str] = ()) -> dict[str, np.ndarray]:
    """The measures (12,) of each participant, over all their recordings."""
    measures: dict[str, list[np.ndarray]] = {}
    for entry in dataset.entries:
        if participants and entry.participant not in participants:
            continue
        people = [one.person for one in follow_people(entry_frames(dataset, entry))]
        joints = np.array([joints_of(person) for person in people if person is not None])
        measured = measure_bodies(joints, stature_of(joints))
        measures.setdefault(entry.participant, []).append(measured)
    return {
        name: median_measures(np.concatenate(parts), DEFAULT_BODY.least_measured)
        for name, parts in measures.items()
    }


def main() -> None:
    """Print the row of a dataset."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("dataset", type=Path)
    parser.add_argument("participants", nargs="*")
    arguments = parser.parse_args()
    people = people_measured(load_dataset(arguments.dataset), arguments.participants)
    every = np.array(list(people.values()))
    row, spread = np.nanmean(every, axis=0), np.nanstd(every, axis=0)
    print(f"{len(people)} people: {', '.join(people)}")
    for name, value, deviation in zip(MEASURES, row, spread, strict=True):
        print(f"{name:16s} {value:7.4f} ± {deviation:.4f}")
    print(f"({', '.join(f'{value:.4f}' for value in row)})")
    print(f"({', '.join(f'{value:.4f}' for value in spread)})")


if __name__ == "__main__":
    main()
