"""``inhand object``: make a new object of a dataset, from a mesh file, or from a few measures."""

import argparse
from pathlib import Path

from inhand_lab.new_objects.object_folder import new_folder, write_object
from inhand_lab.new_objects.picture import require_picture, write_picture
from inhand_lab.new_objects.proposal import Proposal, propose
from inhand_lab.objects.kinds import KINDS, MEASURES, build_kind, option
from inhand_runtime.errors import SettingsError
from inhand_runtime.exit_codes import DONE
from rich.console import Console

from inhand.looking import positive_number
from inhand.object_choices import add_choices, chosen_by_hand
from inhand.object_mesh import add_mesh_options, propose_mesh
from inhand.object_summary import summarise

OWN_OPTIONS = {"mesh": ("unit", "size", "up"), "kind": MEASURES}
"""Options that only one way of making an object takes, by the option that chooses the way."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    actions = parser.add_subparsers(dest="action", required=True, metavar="ACTION")
    text = "make objects/NAME/ of a dataset, with marked vertices, symmetries and a picture"
    new = actions.add_parser(
        "new",
        help=text,
        description=text,
        epilog="kinds and their measures: "
        + "; ".join(
            f"{kind}: {' '.join(map(option, one.measures))}" for kind, one in KINDS.items()
        ),
    )
    new.add_argument("name", metavar="NAME", help="the object's name, such as my_mug")
    new.add_argument(
        "--dataset",
        dest="folder",
        type=Path,
        required=True,
        metavar="FOLDER",
        help="the dataset that it becomes part of, which need not be there yet",
    )
    new.add_argument("--mesh", type=Path, metavar="FILE", help="make it of a mesh file")
    add_mesh_options(new)
    new.add_argument(
        "--kind",
        choices=KINDS,
        metavar="KIND",
        help=f"make it by measures in centimetres: one of {', '.join(KINDS)}",
    )
    for measure in MEASURES:
        new.add_argument(
            option(measure), type=positive_number, metavar="CM", help=_meaning(measure)
        )
    add_choices(new)
    new.add_argument(
        "--picture",
        type=Path,
        metavar="FILE",
        help="where its picture beside a hand goes (default: picture.png in its folder)",
    )


def run(arguments: argparse.Namespace) -> int:
    """Make the object; raises SettingsError or InhandError."""
    folder = new_folder(arguments.folder, arguments.name)
    picture = arguments.picture or folder / "picture.png"
    require_picture(picture)
    console = Console()
    proposal = _proposed(arguments, console)
    write_object(proposal.shape, folder)
    write_picture(proposal.shape, picture)
    console.print(summarise(proposal))
    console.print(
        f"saved {folder}; {picture} shows it: look at its size, axes and marks",
        soft_wrap=True,
    )
    return DONE


def _proposed(arguments: argparse.Namespace, console: Console) -> Proposal:
    way = _way(arguments)
    for name, own in OWN_OPTIONS.items():
        given = [one for one in own if getattr(arguments, one) is not None]
        if given and name != way:
            raise SettingsError(f"{option(given[0])} is for --{name}, and this is by --{way}")
    return propose_mesh(arguments, console) if way == "mesh" else _propose_kind(arguments)


def _way(arguments: argparse.Namespace) -> str:
    """Return the name of the option that says of what it is made; raises SettingsError."""
    ways = [name for name in OWN_OPTIONS if getattr(arguments, name) is not None]
    if len(ways) == 1:
        return ways[0]
    if ways:
        raise SettingsError(f"--{ways[0]} and --{ways[1]} both say what it is: leave one out")
    raise SettingsError(f"say what it is: --mesh FILE, or --kind, one of {', '.join(KINDS)}")


def _propose_kind(arguments: argparse.Namespace) -> Proposal:
    given = {name: getattr(arguments, name) for name in MEASURES}
    measures = {name: value for name, value in given.items() if value is not None}
    model = build_kind(arguments.name, arguments.kind, measures)
    return propose(
        model.name, model.vertices, model.faces, model.marked_vertices, chosen_by_hand(arguments)
    )


def _meaning(measure: str) -> str:
    kinds = [
        f"{one.measures[measure].meaning} of a {kind}"
        for kind, one in KINDS.items()
        if measure in one.measures
    ]
    return "; ".join(kinds)
