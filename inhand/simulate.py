"""``inhand simulate``: make a labelled dataset of simulated people."""

import argparse
from pathlib import Path

from inhand_lab.generation import generate
from inhand_lab.world import INTERACTIONS
from inhand_runtime.errors import SettingsError
from rich.console import Console

from inhand.progress import progress_bar


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    parser.add_argument("out", type=Path, metavar="OUT", help="the new dataset's folder")
    parser.add_argument(
        "--interactions",
        nargs="+",
        default=INTERACTIONS,
        metavar="I",
        help=f"what is done (default: all): {', '.join(INTERACTIONS)}",
    )
    parser.add_argument("--participants", type=int, default=6, metavar="N", help="(default: 6)")
    parser.add_argument("--seed", type=int, default=0, metavar="S", help="(default: 0)")
    parser.add_argument(
        "--frames", type=int, default=360, metavar="N", help="a recording's, at 30 Hz (360)"
    )
    parser.add_argument(
        "--no-images", action="store_true", help="skeletons and labels only: small and quick"
    )


def run(arguments: argparse.Namespace) -> int:
    """Write the dataset; raises SettingsError or DatasetError."""
    unknown = [name for name in arguments.interactions if name not in INTERACTIONS]
    if unknown:
        raise SettingsError(f"no interaction {unknown[0]!r}; there are: {', '.join(INTERACTIONS)}")
    if arguments.participants < 1 or arguments.frames < 1 or arguments.seed < 0:
        raise SettingsError("participants and frames are 1 or more, and the seed is 0 or more")
    total = len(arguments.interactions) * arguments.participants
    with progress_bar("simulating", total) as advance:
        dataset = generate(
            arguments.out,
            arguments.interactions,
            arguments.participants,
            arguments.seed,
            arguments.frames,
            images=not arguments.no_images,
            on_progress=advance,
        )
    Console().print(f"{len(dataset.entries)} recordings in {dataset.folder}")
    return 0
