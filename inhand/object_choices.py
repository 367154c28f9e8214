"""The options by which what is proposed of a new object is chosen by hand."""

import argparse

import numpy as np
from inhand_lab.new_objects.proposal import FEWEST_MARKS, Choices
from inhand_runtime.errors import SettingsError
from inhand_runtime.wording import counted
from inhand_tracker.shape.shape import Symmetry

NONE = "none"
AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
M_PER_CM = 0.01


def add_choices(parser: argparse.ArgumentParser) -> None:
    """Add the options."""
    parser.add_argument(
        "--mark",
        nargs=3,
        type=float,
        action="append",
        metavar=("X", "Y", "Z"),
        help="a marked vertex in centimetres in the object's axes, moved to its surface, instead "
        "of those that are proposed; three or more",
    )
    parser.add_argument(
        "--symmetry",
        action="append",
        type=_symmetry,
        metavar="AXIS[:N]",
        help="it looks the same turned about x, y or z through its middle by any angle (z), or by "
        "an Nth of a whole turn (z:2), instead of what is found on it; may be repeated; none: it "
        "never does",
    )
    parser.add_argument(
        "--mirror",
        choices=tuple(AXES),
        help="the normal of its plane of symmetry, instead of the one that is found",
    )


def chosen_by_hand(arguments: argparse.Namespace) -> Choices:
    """Return what the options choose; raises SettingsError."""
    marks = arguments.mark
    if marks is not None and len(marks) < FEWEST_MARKS:
        raise SettingsError(f"--mark names {counted(len(marks), 'point')}: mark three or more")
    symmetries = arguments.symmetry
    if symmetries is not None and None in symmetries and len(symmetries) > 1:
        raise SettingsError("--symmetry none stands alone: leave the others out, or none")
    return Choices(
        None if marks is None else M_PER_CM * np.array(marks),
        None if arguments.mirror is None else np.array(AXES[arguments.mirror]),
        None if symmetries is None else tuple(one for one in symmetries if one is not None),
    )


def _symmetry(text: str) -> Symmetry | None:
    """Read an axis with its order; None for none. Raises ArgumentTypeError."""
    if text == NONE:
        return None
    axis, colon, order = text.partition(":")
    if axis not in AXES or (colon and not (order.isdecimal() and int(order) > 1)):
        raise argparse.ArgumentTypeError(
            f"{text!r} is no symmetry: write x, y or z, or say z:2 for half turns, or none"
        )
    return Symmetry(AXES[axis], order=int(order) if colon else 0)
