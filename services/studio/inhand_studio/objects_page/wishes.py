"""What a person wants made, as ``inhand object new`` takes it."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from inhand_lab.objects.kinds import option
from inhand_runtime.errors import InhandError

AS_FOUND = "as found"
"""The choice to take what the file says, or what is found on the mesh."""


@dataclass(frozen=True)
class ByMeasures:
    """A kind of thing, and its measures in centimetres by their names."""

    kind: str
    measures_cm: Mapping[str, float]

    def arguments(self) -> list[str]:
        """Return the options of the verb."""
        measures = [f"{option(name)}={value:g}" for name, value in self.measures_cm.items()]
        return [f"--kind={self.kind}", *measures]


@dataclass(frozen=True)
class ByMesh:
    """A mesh file, None before it is uploaded; its unit and upright axis, or ``AS_FOUND``.

    ``longest_cm`` is the length of its longest side where it has no unit; 0 where it has.
    """

    file: Path | None
    unit: str
    longest_cm: float
    up: str

    def arguments(self) -> list[str]:
        """Return the options of the verb; raises InhandError without a file."""
        if self.file is None:
            raise InhandError("upload a mesh file first")
        arguments = [f"--mesh={self.file}"]
        arguments += [] if self.unit == AS_FOUND else [f"--unit={self.unit}"]
        arguments += [f"--size={self.longest_cm:g}"] if self.longest_cm > 0.0 else []
        return arguments + ([] if self.up == AS_FOUND else [f"--up={self.up}"])


@dataclass(frozen=True)
class ByCamera:
    """A recording in which the thing stands by itself on a table; None where there is none."""

    recording: Path | None

    def arguments(self) -> list[str]:
        """Return the options of the verb; raises InhandError without a recording."""
        if self.recording is None:
            raise InhandError("there is no recording: record the thing on a table first")
        return [f"--from={self.recording}"]


@dataclass(frozen=True)
class Wishes:
    """A new object's name, of what it is made, and which symmetry, mirror plane and marked vertices
    it gets, these in centimetres in its axes; without any, those that are proposed."""

    name: str
    way: ByMeasures | ByMesh | ByCamera
    symmetry: str = AS_FOUND
    mirror: str = AS_FOUND
    marks_cm: tuple[tuple[float, float, float], ...] = ()


def object_arguments(wishes: Wishes, dataset: Path) -> list[str]:
    """Return the verb with its arguments; raises InhandError where something is not given yet."""
    if not wishes.name.strip():
        raise InhandError("give the object a name, such as my_mug")
    arguments = ["object", "new", f"--dataset={dataset}", *wishes.way.arguments()]
    arguments += [] if wishes.symmetry == AS_FOUND else [f"--symmetry={wishes.symmetry}"]
    arguments += [] if wishes.mirror == AS_FOUND else [f"--mirror={wishes.mirror}"]
    for mark in wishes.marks_cm:
        arguments += ["--mark", *(f"{one:.3f}" for one in mark)]
    return [*arguments, "--", wishes.name.strip()]
