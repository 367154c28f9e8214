"""The unit of a mesh file, guessed from how large it would be, and which of its axes points up."""

from dataclasses import dataclass

import numpy as np
from inhand_runtime.errors import SettingsError
from inhand_tracker.geometry.arrays import Array

from inhand_lab.new_objects.parameters import DEFAULT_MESH, MeshParameters
from inhand_lab.training.parameters import DEFAULT_TRAINING

UNITS = {"mm": 0.001, "cm": 0.01, "m": 1.0, "inch": 0.0254}
"""Metres of each unit."""
UPS = ("z", "y", "x", "-z", "-y", "-x")
"""Axes of a mesh that may point up."""


@dataclass(frozen=True)
class UnitGuess:
    """The units in which a length makes an object of a size that people hold.

    ``sizes`` has the length in metres by those units, which may be none; ``sure`` is the only one
    that can be, None where several can, none can, or the format says another.
    """

    sizes: dict[str, float]
    sure: str | None


def guess_unit(
    length: float, declared: str | None, parameters: MeshParameters = DEFAULT_MESH
) -> UnitGuess:
    """Guess the unit of a mesh whose longest side is a number; ``declared`` is its format's."""
    sizes = {
        unit: length * metres
        for unit, metres in UNITS.items()
        if parameters.smallest_m <= length * metres <= parameters.largest_m
    }
    if declared is not None:
        return UnitGuess(sizes, declared if declared in sizes else None)
    return UnitGuess(sizes, next(iter(sizes)) if len(sizes) == 1 else None)


def scale_of(length: float, unit: str | None, size_m: float | None) -> float:
    """Metres of a mesh's unit, by its name or by the size of its longest side.

    Raises SettingsError for a unit by which it is no thing that people hold.
    """
    scale = size_m / length if unit is None and size_m is not None else UNITS[unit or "m"]
    size = scale * length
    least, largest = DEFAULT_TRAINING.smallest_m, DEFAULT_TRAINING.largest_m
    if least <= size <= largest:
        return scale
    asked = f"--unit {unit}" if unit is not None else f"--size {100.0 * size:g}"
    raise SettingsError(
        f"by {asked} it is {length_of(size)} long, and what a hand holds is {length_of(least)} to "
        f"{length_of(largest)}: {_other_units(length)}--size CM says how long its longest side is"
    )


def which_unit(length: float, guess: UnitGuess) -> str:
    """Say what must be said of a mesh's unit, and by which options."""
    options = ", ".join(f"--unit {unit} makes it {length_of(m)}" for unit, m in guess.sizes.items())
    fits = options or "by no unit is it a thing that a hand holds"
    return (
        f"its longest side is {length:g}, and of which unit is not clear: {fits}; or say "
        "--size CM, how long that side is"
    )


def upright(up: str) -> Array:
    """The rotation (3, 3) that turns an axis of a mesh to z, by the shorter way about x or y."""
    axis = np.zeros(3)
    axis["xyz".index(up[-1])] = -1.0 if up.startswith("-") else 1.0
    x, y, z = axis
    if z:
        return np.diag([1.0, z, z])
    if y:
        return np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -y], [0.0, y, 0.0]])
    return np.array([[0.0, 0.0, -x], [0.0, 1.0, 0.0], [x, 0.0, 0.0]])


def length_of(metres: float) -> str:
    """Write a length in the unit in which people would say it."""
    if metres >= 1000.0:
        return f"{metres / 1000.0:,.3g} km"
    if metres >= 1.0:
        return f"{metres:.3g} m"
    return f"{metres * 100.0:.3g} cm" if metres >= 0.01 else f"{metres * 1000.0:.2g} mm"


def _other_units(length: float) -> str:
    sizes = guess_unit(length, None).sizes
    return "".join(f"--unit {unit} makes it {length_of(m)}, " for unit, m in sizes.items())
