"""``inhand import``: make a dataset of real data in one of the known formats."""

import argparse
from pathlib import Path

from inhand_lab.importers.motion import import_motion
from inhand_lab.importers.parameters import DEFAULT_IMPORT
from inhand_lab.importers.utd_mhad import import_utd_mhad
from inhand_lab.importers.ycb_video import import_ycb_video
from rich.console import Console

from inhand.looking import positive_number

FORMATS = {
    "utd-mhad": (import_utd_mhad, "*_skeleton.mat files, or folders of them"),
    "motion": (import_motion, "motion archives (.npz), or folders of them"),
    "ycb-video": (import_ycb_video, "folders that hold data/0000/000001-color.png …"),
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    formats = parser.add_subparsers(dest="format", required=True, metavar="FORMAT")
    for name, (importer, sources) in FORMATS.items():
        one = formats.add_parser(name, help=sources)
        one.add_argument("sources", nargs="+", type=Path, metavar="SRC", help=sources)
        one.add_argument("out", type=Path, metavar="OUT", help="the new dataset's folder")
        one.add_argument(
            "--frame-rate",
            type=positive_number,
            default=DEFAULT_IMPORT.frame_rate,
            metavar="HZ",
            help="keep every k-th frame, to get this rate "
            f"(default: {DEFAULT_IMPORT.frame_rate:g})",
        )
        one.set_defaults(importer=importer)


def run(arguments: argparse.Namespace) -> int:
    """Write the dataset; raises DatasetError or InhandError."""
    dataset = arguments.importer(arguments.sources, arguments.out, arguments.frame_rate)
    Console().print(f"{len(dataset.entries)} recordings in {dataset.folder}")
    return 0
