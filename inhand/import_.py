"""``inhand import``: make a dataset of real data in one of the known formats."""

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from inhand_lab.datasets.dataset import Dataset
from inhand_lab.importers.azure_kinect import import_azure_kinect
from inhand_lab.importers.bop import import_bop
from inhand_lab.importers.coco import CAMERA_COORDINATES, import_coco
from inhand_lab.importers.coordinates import AXES, UNITS, Coordinates
from inhand_lab.importers.motion import import_motion
from inhand_lab.importers.ntu import import_ntu
from inhand_lab.importers.parameters import DEFAULT_IMPORT
from inhand_lab.importers.utd_mhad import import_utd_mhad
from inhand_lab.importers.ycb_video import import_ycb_video
from inhand_lab.importers.zed import SAMPLE_COORDINATES, import_zed
from inhand_runtime.wording import counted
from rich.console import Console

from inhand.looking import positive_number

WITHOUT_PEOPLE = (
    "nobody is in these recordings: they serve for meshes, and for images with true poses; "
    "`inhand train` and `inhand evaluate` need skeletons beside the labels"
)


@dataclass(frozen=True)
class ImportFormat:
    """A format: what imports it, what its sources are, and what should be known afterwards.

    ``coordinates`` are the usual ones of a format whose files do not name theirs.
    """

    importer: Callable[..., Dataset]
    sources: str
    note: str = ""
    coordinates: Coordinates | None = None


FORMATS = {
    "utd-mhad": ImportFormat(import_utd_mhad, "*_skeleton.mat files, or folders of them"),
    "motion": ImportFormat(import_motion, "motion archives (.npz), or folders of them"),
    "ycb-video": ImportFormat(
        import_ycb_video, "folders that hold data/0000/000001-color.png …", WITHOUT_PEOPLE
    ),
    "bop": ImportFormat(
        import_bop, "BOP data sets, their splits (test) or scenes (test/000001)", WITHOUT_PEOPLE
    ),
    "azure-kinect": ImportFormat(
        import_azure_kinect, "JSON files of Microsoft's offline_processor, or folders of them"
    ),
    "zed": ImportFormat(
        import_zed,
        "JSON files of the ZED SDK's body export (BODY_34), or folders of them",
        coordinates=SAMPLE_COORDINATES,
    ),
    "ntu": ImportFormat(import_ntu, "*.skeleton files of NTU RGB+D, or folders of them"),
    "coco": ImportFormat(
        import_coco,
        "NPZ or JSON files of COCO's key points in 3-D and times, or folders of them",
        coordinates=CAMERA_COORDINATES,
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
            help=f"leave out frames, to get this rate (default: {DEFAULT_IMPORT.frame_rate:g})",
        )
        if known.coordinates is not None:
            _add_coordinates(one, known.coordinates)


def _add_coordinates(parser: argparse.ArgumentParser, usual: Coordinates) -> None:
    parser.add_argument(
        "--coordinate-system",
        choices=AXES,
        default=usual.system,
        help=f"what the files are written in, at the camera (default: {usual.system})",
    )
    parser.add_argument(
        "--unit",
        choices=UNITS,
        default=usual.unit,
        help=f"unit of length of the files (default: {usual.unit})",
    )


def run(arguments: argparse.Namespace) -> int:
    """Write the dataset; raises DatasetError or InhandError."""
    known = FORMATS[arguments.format]
    options = [arguments.sources, arguments.out, arguments.frame_rate]
    if known.coordinates is not None:
        options.append(Coordinates(arguments.coordinate_system, arguments.unit))
    dataset = known.importer(*options)
    console = Console()
    console.print(f"{counted(len(dataset.entries), 'recording')} in {dataset.folder}")
    if known.note:
        console.print(known.note)
    return 0
