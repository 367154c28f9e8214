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
    UnitGuess,
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
    mesh = read_file_mesh(arguments.mesh)
    guess = guess_unit(float(mesh.sides.max()), mesh.unit)
    unsaid = _unsaid(mesh, guess, arguments)
    answerable = guess.sizes or "unit" not in unsaid
    if unsaid and not (sys.stdin.isatty() and answerable):
        raise SettingsError(f"{arguments.mesh}: {'; '.join(unsaid.values())}")
    scale = _scale(mesh, guess, arguments, console)
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


def _unsaid(mesh: FileMesh, guess: UnitGuess, arguments: argparse.Namespace) -> dict[str, str]:
    """Return what neither the file nor an option says, each with the options that do."""
    unsaid = {}
    if arguments.unit is None and arguments.size is None and guess.sure is None:
        unsaid["unit"] = which_unit(float(mesh.sides.max()), guess)
    if arguments.up is None and mesh.up is None:
        sides = " × ".join(f"{side:.4g}" for side in mesh.sides)
        unsaid["up"] = (
            f"it is {sides} along x, y, z, and does not say which points up: add --up z or --up y"
        )
    return unsaid


def _scale(
    mesh: FileMesh, guess: UnitGuess, arguments: argparse.Namespace, console: Console
) -> float:
    """Metres of the mesh's unit, which is asked where nothing says it."""
    unit, size = arguments.unit, arguments.size
    if unit is None and size is None:
        unit = guess.sure
        if unit is None:
            sizes = [f"{name} ({length_of(metres)} long)" for name, metres in guess.sizes.items()]
            question = f"{arguments.mesh}: in which unit is it? {', '.join(sizes)}"
            unit = _asked(question, "unit", tuple(guess.sizes), console)
        else:
            told = f"taken to be in {unit}: {length_of(guess.sizes[unit])} long"
            console.print(told, soft_wrap=True)
    return scale_of(float(mesh.sides.max()), unit, None if size is None else M_PER_CM * size)


def _up(mesh: FileMesh, arguments: argparse.Namespace, console: Console) -> str:
    """The axis of the mesh that points up, which is asked where nothing says it."""
    if arguments.up is not None:
        return str(arguments.up)
    if mesh.up is not None:
        console.print(f"taken to be upright along {mesh.up}, as its format has it")
        return mesh.up
    sides = " × ".join(f"{side:.4g}" for side in mesh.sides)
    question = f"{arguments.mesh}: it is {sides} along x, y, z; which of them points up?"
    return _asked(question, "up", UPS, console)


def _asked(question: str, option: str, answers: Sequence[str], console: Console) -> str:
    """Ask until one of the answers is given; raises SettingsError where none can be."""
    console.print(question, soft_wrap=True)
    while True:
        try:
            answer = input(f"{option} ({'/'.join(answers)}): ").strip().lower()
        except EOFError:
            raise SettingsError(f"nothing was answered: add --{option}") from None
        if answer in answers:
            return answer
