"""Furniture that an interaction needs, in the person's world."""

from __future__ import annotations

from dataclasses import dataclass

WOOD = (146, 108, 70)


@dataclass(frozen=True)
class Cuboid:
    """A solid box: centre and size (3,) in metres, RGB colour."""

    centre: tuple[float, float, float]
    size: tuple[float, float, float]
    colour: tuple[int, int, int]

    def mirrored(self) -> Cuboid:
        """Its reflection in the person's sagittal plane."""
        x, y, z = self.centre
        return Cuboid((-x, y, z), self.size, self.colour)


Furniture = tuple[Cuboid, ...]


def side_table(x: float, y: float, height: float, width: float = 0.40) -> Furniture:
    """A small table on one leg, its top 40 cm deep, of that width in metres and at that height."""
    return (
        Cuboid((x, y, height - 0.015), (width, 0.40, 0.03), WOOD),
        Cuboid((x, y, 0.5 * height), (0.06, 0.06, height - 0.06), WOOD),
        Cuboid((x, y, 0.015), (0.30, 0.30, 0.03), WOOD),
    )
