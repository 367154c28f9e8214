"""``inhand import``: make a dataset of real data in one of the known formats."""

import argparse
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from inhand_lab.datasets.dataset import Dataset
from inhand_lab.importers.bop import import_bop
from inhand_lab.importers.motion import import_motion
from inhand_lab.importers.parameters import DEFAULT_IMPORT
from inhand_lab.importers.utd_mhad import import_utd_mhad
from inhand_lab.importers.ycb_video import import_ycb_video
from inhand_runtime.wording import counted
from rich.console import Console

from inhand.looking import positive_number

WITHOUT_PEOPLE = (
    "nobody is in these recordings: they serve for meshes, and for images with true poses; "
    "`inhand train` and `inhand evaluate` need skeletons beside the labels"
)


@dataclass(frozen=True)
class ImportFormat:
    """A format: what imports it, what its sources are, and what should be known afterwards."""

    importer: Callable[[Sequence[Path], Path, float], Dataset]
    sources: str
    note: str = ""


FORMATS = {
    "utd-mhad": ImportFormat(import_utd_mhad, "*_skeleton.mat files, or folders of them"),
    "motion": ImportFormat(import_motion, "motion archives (.npz), or folders of them"),
    "ycb-video": ImportFormat(
        import_ycb_video, "folders that hold data/0000/000001-color.png …", WITHOUT_PEOPLE
    ),
    "bop": ImportFormat(
        import_bop, "BOP data sets, their splits (test) or scenes (test/000001)", WITHOUT_PEOPLE
    ),
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    formats = parser.add_subparsers(dest="format", required=True, metavar="FORMAT")
    for name, known in FORMATS.items():
        one = formats.add_parser(name, help=known.sources)
        one.add_argument("sources", nargs="+", type=Path, metavar="SRC", help=known.sources)
        one.add_argument("out", type=Path, metavar="OUT", help="the new dataset's folder")
        one.add_argument(
            "--frame-rate",
            type=positive_number,
            default=DEFAULT_IMPORT.frame_rate,
            metavar="HZ",
            help="keep every k-th frame, to get this rate "
            f"(default: {DEFAULT_IMPORT.frame_rate:g})",
        )


def run(arguments: argparse.Namespace) -> int:
    """Write the dataset; raises DatasetError or InhandError."""
    known = FORMATS[arguments.format]
    dataset = known.importer(arguments.sources, arguments.out, arguments.frame_rate)
    console = Console()
    console.print(f"{counted(len(dataset.entries), 'recording')} in {dataset.folder}")
    if known.note:
        console.print(known.note)
    return 0
