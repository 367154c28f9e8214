"""``inhand object``: make a new object of a dataset, from a mesh file, a few measures, or depth."""

import argparse
from pathlib import Path

from inhand_lab.new_objects.object_folder import new_folder, write_object
from inhand_lab.new_objects.picture import draw_object, require_picture, write_picture
from inhand_lab.new_objects.proposal import Proposal, propose
from inhand_lab.objects.kinds import KINDS, MEASURES, build_kind, option
from inhand_runtime.errors import SettingsError
from inhand_runtime.exit_codes import DONE
from rich.console import Console

from inhand.looking import positive_number
from inhand.object_choices import add_choices, chosen_by_hand
from inhand.object_measured import propose_measured
from inhand.object_mesh import add_mesh_options, propose_mesh
from inhand.object_summary import summarise

OWN_OPTIONS = {"mesh": ("unit", "size", "up"), "kind": MEASURES, "recording": ()}
"""Options that only one way of making an object takes, by the argument that chooses the way."""
WAYS = {"mesh": "--mesh", "kind": "--kind", "recording": "--from"}
"""The options by which these are given."""


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
    _add_common(new)
    new.add_argument("--mesh", type=Path, metavar="FILE", help="make it of a mesh file")
    add_mesh_options(new)
    new.add_argument(
        "--from",
        dest="recording",
        type=Path,
        metavar="RECORDING",
        help="measure what stands by itself on a table, in a recording's first frames of depth",
    )
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


def _add_common(new: argparse.ArgumentParser) -> None:
    """Add where the object and its picture go."""
    new.add_argument("name", metavar="NAME", help="the object's name, such as my_mug")
    new.add_argument(
        "--dataset",
        dest="folder",
        type=Path,
        required=True,
        metavar="FOLDER",
        help="the dataset that it becomes part of, which need not be there yet",
    )
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
    drawn = draw_object(proposal.shape)
    write_object(proposal.shape, folder)
    write_picture(drawn, picture)
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
            raise SettingsError(
                f"{option(given[0])} is for {WAYS[name]}, and this is by {WAYS[way]}"
            )
    if way == "recording":
        return propose_measured(arguments, console)
    return propose_mesh(arguments, console) if way == "mesh" else _propose_kind(arguments)


def _way(arguments: argparse.Namespace) -> str:
    """Return the name of the option that says of what it is made; raises SettingsError."""
    ways = [name for name in OWN_OPTIONS if getattr(arguments, name) is not None]
    if len(ways) == 1:
        return ways[0]
    if ways:
        first, second = (WAYS[way] for way in ways[:2])
        raise SettingsError(f"{first} and {second} both say what it is: leave one out")
    raise SettingsError(
        f"say what it is: --mesh FILE, --from RECORDING, or --kind, one of {', '.join(KINDS)}"
    )


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
