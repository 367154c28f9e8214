"""From a mesh to an object of a dataset: its marks, mirror plane and symmetries are proposed.

What is asked for takes the place of what is found on the mesh.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from inhand_runtime.errors import SettingsError
from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.shape.shape import ObjectShape, Symmetry

from inhand_lab.new_objects.parameters import DEFAULT_PROPOSAL, ProposalParameters
from inhand_lab.new_objects.symmetry import (
    AXES,
    SelfComparison,
    find_mirror,
    find_symmetries,
    reflection,
)

FEWEST_MARKS = 3
"""Number of marks that are chosen by hand at the least: fewer do not show every turn."""


@dataclass(frozen=True)
class Choices:
    """What is chosen by hand instead of being proposed; None where nothing is.

    ``marks`` (M, 3) are in metres in the object's frame, ``mirror_normal`` is a unit normal (3,).
    """

    marks: Array | None = None
    mirror_normal: Array | None = None
    symmetries: tuple[Symmetry, ...] | None = None


@dataclass(frozen=True)
class Proposal:
    """An object of a dataset, and how well its mirror plane holds.

    ``mirror_miss_m`` is the distance in metres by which the mirror image misses the surface, and
    ``mirrored`` whether that is near enough.
    """

    shape: ObjectShape
    mirror_miss_m: float
    mirrored: bool


def propose(
    name: str,
    vertices: Array,
    faces: Indices,
    marks: Array,
    choices: Choices | None = None,
    parameters: ProposalParameters = DEFAULT_PROPOSAL,
) -> Proposal:
    """Propose an object of a mesh in metres, vertices (V, 3) and faces (F, 3).

    ``marks`` (M, 3) are marked unless others are chosen. A mirror plane goes through the origin:
    a mesh whose own plane does not is moved along its normal, with marks and symmetries. Raises
    SettingsError for a chosen mark that is far from the mesh.
    """
    choices = choices or Choices()
    compared = SelfComparison(vertices, faces, parameters)
    plane = _mirror_plane(compared, choices.mirror_normal)
    shift = _shift_to_plane(compared, plane) if plane.holds else np.zeros(3)
    symmetries = choices.symmetries
    if symmetries is None:
        symmetries = tuple(_moved(one, shift) for one in find_symmetries(compared))
    if choices.marks is not None:
        marks = _on_surface(compared, choices.marks - shift)
    return Proposal(
        ObjectShape(name, vertices + shift, faces, marks + shift, plane.normal, symmetries),
        compared.miss(reflection(plane.normal), plane.point),
        plane.holds,
    )


def centred(vertices: Array) -> Array:
    """Vertices (V, 3), moved so that the middle of the box around them is the origin."""
    return vertices - (vertices.min(axis=0) + vertices.max(axis=0)) / 2.0


@dataclass(frozen=True)
class _Plane:
    """A plane by its normal (3,) and a point (3,) of it, and whether it mirrors the mesh."""

    normal: Array
    point: Array
    holds: bool


def _mirror_plane(compared: SelfComparison, chosen: Array | None) -> _Plane:
    """The plane that was chosen, or that is found; the one across x where none is."""
    if chosen is None:
        found = find_mirror(compared)
        return _Plane(AXES[0], np.zeros(3), False) if found is None else _Plane(*found, True)
    for centre in compared.centres:
        if compared.bears(reflection(chosen), centre):
            return _Plane(chosen, centre, True)
    return _Plane(chosen, np.zeros(3), False)


def _shift_to_plane(compared: SelfComparison, plane: _Plane) -> Array:
    """The shift (3,) that brings a plane to the origin.

    A plane that is nearer than what is compared stays, so that a mesh at its place keeps it.
    """
    away = float(plane.point @ plane.normal)
    return np.zeros(3) if abs(away) < compared.parameters.tolerance_m else -away * plane.normal


def _moved(symmetry: Symmetry, shift: Array) -> Symmetry:
    x, y, z = ((np.array(symmetry.centre) + shift).round(6) + 0.0).tolist()
    return Symmetry(symmetry.axis, (x, y, z), symmetry.order)


def _on_surface(compared: SelfComparison, marks: Array) -> Array:
    nearest = compared.surface.nearest(marks)
    away = np.linalg.norm(nearest - marks, axis=1)
    farthest = int(away.argmax())
    if away[farthest] > compared.parameters.farthest_mark_m:
        raise SettingsError(
            f"--mark {_written(marks[farthest])} lies {100.0 * away[farthest]:.1f} cm from the "
            f"mesh, which reaches from {_written(compared.vertices.min(axis=0))} to "
            f"{_written(compared.vertices.max(axis=0))} cm: mark a point of it"
        )
    return nearest


def _written(metres: Sequence[float] | Array) -> str:
    return " ".join(f"{100.0 * value:.1f}" for value in metres)
