"""``inhand simulate``: a labelled dataset of simulated people, or a picture of what they do."""

import argparse
from collections.abc import Sequence
from pathlib import Path

from inhand_lab.datasets.dataset import Dataset, load_dataset
from inhand_lab.datasets.generation import GenerationSettings, generate
from inhand_lab.driven.dataset import DrivenSettings, generate_driven, pairs_for
from inhand_lab.people.person import PEOPLE, USUAL_PEOPLE
from inhand_lab.sensing.cameras import CAMERAS, KINECT
from inhand_lab.workers import working
from inhand_lab.world.interactions import INTERACTIONS
from inhand_lab.world.parameters import CAMERA_PLACINGS, RIG_CAMERAS, ROAMING_VIEWS, USUAL_VIEWS
from inhand_lab.world.roaming import ROAMING_INTERACTIONS
from inhand_lab.world.sheet import write_sheet
from inhand_runtime.errors import SettingsError
from inhand_runtime.wording import counted
from rich.console import Console

from inhand.cluster import add_cluster_option, work_path
from inhand.progress import progress_bar
from inhand.realism import USUAL_DATA, show_realism


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    parser.add_argument("out", type=Path, nargs="?", metavar="OUT", help="the new dataset's folder")
    parser.add_argument(
        "--interactions",
        nargs="+",
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
    parser.add_argument(
        "--views",
        choices=list(CAMERA_PLACINGS),
        default=USUAL_VIEWS,
        help="where cameras stand: before people, anywhere round them, or far before them "
        f"(default: {USUAL_VIEWS})",
    )
    parser.add_argument(
        "--cameras",
        type=int,
        default=1,
        metavar="N",
        help="so many see each performance, 1 to 4 about the person, unlike clocks (default: 1)",
    )
    parser.add_argument(
        "--roaming",
        action="store_true",
        help="people walk about and turn while they use the thing: "
        + ", ".join(ROAMING_INTERACTIONS),
    )
    parser.add_argument(
        "--people",
        choices=PEOPLE,
        default=USUAL_PEOPLE,
        help="who does it: people alike in manner, or such as stand, sit, find things, are "
        f"interrupted and gesture in ways of their own (default: {USUAL_PEOPLE})",
    )
    parser.add_argument(
        "--camera", choices=CAMERAS, default=KINECT.name, help=f"(default: {KINECT.name})"
    )
    parser.add_argument(
        "--bodies",
        type=Path,
        metavar="DATASET",
        help="objects in the hands of this dataset's people, who move and are tracked as recorded",
    )
    add_cluster_option(parser)
    parser.add_argument(
        "--sheet",
        type=Path,
        metavar="FILE",
        help="a picture of what people do (.png or .jpg), instead of or beside a dataset",
    )
    parser.add_argument(
        "--realism", action="store_true", help="compare the sensors with real recordings"
    )
    parser.add_argument(
        "--data",
        type=Path,
        default=USUAL_DATA,
        metavar="FOLDER",
        help=f"where real recordings are for --realism (default: {USUAL_DATA})",
    )
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the realism table")


def run(arguments: argparse.Namespace) -> int:
    """Write what was asked for; raises SettingsError, DatasetError or RecordingError."""
    if arguments.realism:
        if arguments.seed < 0:
            raise SettingsError("the seed is 0 or more")
        return show_realism(arguments.data, arguments.seed, arguments.json)
    chosen = arguments.interactions
    unknown = [name for name in chosen or () if name not in INTERACTIONS]
    if unknown:
        raise SettingsError(f"no interaction {unknown[0]!r}; there are: {', '.join(INTERACTIONS)}")
    if arguments.participants < 1 or arguments.frames < 1 or arguments.seed < 0:
        raise SettingsError("participants and frames are 1 or more, and the seed is 0 or more")
    people = arguments.bodies is None and arguments.out is not None
    told = arguments.views, arguments.people, arguments.cameras, arguments.roaming
    if not people and told != (USUAL_VIEWS, USUAL_PEOPLE, 1, False):
        raise SettingsError(
            "--views, --people, --cameras and --roaming are for a dataset of simulated people: "
            "leave them out"
        )
    _check_rig(arguments)
    if arguments.out is None and arguments.sheet is None:
        raise SettingsError("name the new dataset's folder, or a picture with --sheet")
    if arguments.sheet is not None:
        _write_sheet(arguments, chosen or tuple(INTERACTIONS))
    if arguments.out is not None:
        dataset = _generate_driven(arguments) if arguments.bodies else _generate(arguments)
        Console().print(f"{counted(len(dataset.entries), 'recording')} in {dataset.folder}")
    return 0


def _check_rig(arguments: argparse.Namespace) -> None:
    """Raise SettingsError for a rig that cannot be, or what nobody does while walking about."""
    if not 1 <= arguments.cameras <= len(RIG_CAMERAS):
        raise SettingsError(f"--cameras is 1 to {len(RIG_CAMERAS)}")
    if arguments.cameras > 1 and arguments.frames < 2:
        raise SettingsError("--cameras needs 2 --frames or more: each camera has its own moments")
    if not arguments.roaming:
        return
    if arguments.people != USUAL_PEOPLE:
        raise SettingsError("only usual people walk about: leave out --people or --roaming")
    for name in arguments.interactions or ():
        if name not in ROAMING_INTERACTIONS:
            able = ", ".join(ROAMING_INTERACTIONS)
            raise SettingsError(f"nobody walks about in {name!r}; people do in: {able}")


def _write_sheet(arguments: argparse.Namespace, interactions: Sequence[str]) -> None:
    arguments.sheet.parent.mkdir(parents=True, exist_ok=True)
    with progress_bar("drawing", len(interactions)) as advance:
        write_sheet(arguments.sheet, interactions, arguments.seed, on_progress=advance)
    Console().print(f"{counted(len(interactions), 'interaction')} in {arguments.sheet}")


def _generate(arguments: argparse.Namespace) -> Dataset:
    known = ROAMING_INTERACTIONS if arguments.roaming else tuple(INTERACTIONS)
    interactions = arguments.interactions or known
    far = arguments.roaming and arguments.views == USUAL_VIEWS
    with (
        working(arguments.cluster),
        progress_bar("simulating", len(interactions) * arguments.participants) as advance,
    ):
        return generate(
            work_path(arguments, arguments.out),
            GenerationSettings(
                interactions,
                arguments.participants,
                arguments.seed,
                arguments.frames,
                images=not arguments.no_images,
                camera=CAMERAS[arguments.camera],
                views=ROAMING_VIEWS if far else arguments.views,
                people=arguments.people,
                cameras=arguments.cameras,
                roaming=arguments.roaming,
            ),
            advance,
        )


def _generate_driven(arguments: argparse.Namespace) -> Dataset:
    bodies = load_dataset(arguments.bodies)
    total = len(pairs_for(bodies, arguments.interactions))
    with progress_bar("simulating", total) as advance:
        return generate_driven(
            arguments.out,
            bodies,
            DrivenSettings(
                arguments.interactions,
                arguments.seed,
                images=not arguments.no_images,
                camera=CAMERAS[arguments.camera],
            ),
            advance,
        )
