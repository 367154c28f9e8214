"""A table of what a new object is."""

import numpy as np
from inhand_lab.new_objects.description import axis_name, describe_symmetry
from inhand_lab.new_objects.proposal import Proposal
from rich.table import Table


def summarise(proposal: Proposal) -> Table:
    """Size, faces, marks, mirror plane and symmetries, in the units of the options."""
    shape = proposal.shape
    table = Table("object", shape.name)
    sides = " × ".join(f"{100.0 * side:.1f}" for side in np.ptp(shape.vertices, axis=0))
    table.add_row("size along x, y, z, cm", sides)
    table.add_row("faces", f"{len(shape.faces):,}")
    table.add_row("marked vertices, cm", "\n".join(map(_centimetres, shape.marked_vertices)))
    table.add_row("plane of symmetry", _mirror(proposal))
    table.add_row(
        "looks the same", "\n".join(map(describe_symmetry, shape.symmetries)) or "never when turned"
    )
    return table


def _mirror(proposal: Proposal) -> str:
    away = f"its mirror image misses it by {1000.0 * proposal.mirror_miss_m:.1f} mm"
    normal = f"normal {axis_name(proposal.shape.mirror_normal)}"
    if proposal.mirrored:
        return f"{normal}; {away}"
    return f"none is found, {normal} is taken; {away}: left-handed use is learned less well"


def _centimetres(point: np.ndarray) -> str:
    return " ".join(f"{value + 0.0:.1f}" for value in (100.0 * point).round(1))
