"""A new object from a mesh file: what the file does not say is asked, or must be an option."""

import argparse
import sys
from collections.abc import Sequence

from inhand_lab.importers.shapes import extreme_points
from inhand_lab.new_objects.mesh_reading import FileMesh, read_file_mesh, reduce_mesh
from inhand_lab.new_objects.proposal import Proposal, centred, propose
from inhand_lab.new_objects.units import (
    UNITS,
    UPS,
    guess_unit,
    length_of,
    scale_of,
    upright,
    which_unit,
)
from inhand_runtime.errors import SettingsError
from rich.console import Console

from inhand.looking import positive_number
from inhand.object_choices import M_PER_CM, chosen_by_hand


def add_mesh_options(parser: argparse.ArgumentParser) -> None:
    """Add the options that are for a mesh file."""
    parser.add_argument(
        "--unit", choices=tuple(UNITS), help="with --mesh: the unit of its coordinates"
    )
    parser.add_argument(
        "--size",
        type=positive_number,
        metavar="CM",
        help="with --mesh: the length of its longest side, where its unit is none",
    )
    parser.add_argument(
        "--up",
        choices=UPS,
        help="with --mesh: which of its axes points up as it stands (write --up=-y for -y); it is "
        "turned so that z does",
    )


def propose_mesh(arguments: argparse.Namespace, console: Console) -> Proposal:
    """Make an object of ``--mesh``, of all its parts; raises SettingsError or InhandError."""
    if arguments.unit is not None and arguments.size is not None:
        raise SettingsError("--unit and --size both say how large it is: leave one out")
    path = arguments.mesh
    mesh = read_file_mesh(path)
    scale = _scale(mesh, arguments, console)
    turn = upright(_up(mesh, arguments, console))
    reduced = reduce_mesh(centred(scale * mesh.vertices @ turn.T), mesh.faces)
    if len(reduced.faces) < len(mesh.faces):
        console.print(
            f"reduced from {len(mesh.faces):,} faces to {len(reduced.faces):,}, which lie "
            f"{1000.0 * reduced.deviation_m:.2f} mm from them on average",
            soft_wrap=True,
        )
    vertices = centred(reduced.vertices)
    marks = extreme_points(vertices)
    return propose(arguments.name, vertices, reduced.faces, marks, chosen_by_hand(arguments))


def _scale(mesh: FileMesh, arguments: argparse.Namespace, console: Console) -> float:
    """Metres of the mesh's unit."""
    length = float(mesh.sides.max())
    unit, size = arguments.unit, arguments.size
    if unit is None and size is None:
        guess = guess_unit(length, mesh.unit)
        unit = guess.sure
        if unit is not None:
            console.print(f"taken to be in {unit}: {length_of(guess.sizes[unit])} long")
        elif guess.sizes and sys.stdin.isatty():
            units = [f"{name} ({length_of(metres)} long)" for name, metres in guess.sizes.items()]
            console.print(
                f"{arguments.mesh}: in which unit is it? {', '.join(units)}", soft_wrap=True
            )
            unit = _asked("unit", tuple(guess.sizes))
        else:
            raise SettingsError(f"{arguments.mesh}: {which_unit(length, guess)}")
    return scale_of(length, unit, None if size is None else M_PER_CM * size)


def _up(mesh: FileMesh, arguments: argparse.Namespace, console: Console) -> str:
    """The axis of the mesh that points up."""
    if arguments.up is not None:
        return str(arguments.up)
    if mesh.up is not None:
        console.print(f"taken to be upright along {mesh.up}, as its format has it")
        return mesh.up
    sides = " × ".join(f"{side:.4g}" for side in mesh.sides)
    where = f"{arguments.mesh}: it is {sides} along x, y, z, and does not say which points up"
    if not sys.stdin.isatty():
        raise SettingsError(f"{where}: add --up z or --up y")
    console.print(f"{where}: {', '.join(UPS)}?", soft_wrap=True)
    return _asked("up", UPS)


def _asked(what: str, answers: Sequence[str]) -> str:
    """Ask until one of the answers is given; raises SettingsError where none can be."""
    while True:
        try:
            answer = input(f"{what} ({'/'.join(answers)}): ").strip().lower()
        except EOFError:
            raise SettingsError(f"nothing was answered: add --{what}") from None
        if answer in answers:
            return answer
