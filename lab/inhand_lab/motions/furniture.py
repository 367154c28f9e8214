"""Furniture that an interaction needs, in the person's world."""

from __future__ import annotations

from dataclasses import dataclass

WOOD = (146, 108, 70)


@dataclass(frozen=True)
class Box:
    """A solid box: centre and size (3,) in metres, RGB colour."""

    centre: tuple[float, float, float]
    size: tuple[float, float, float]
    colour: tuple[int, int, int]

    def mirrored(self) -> Box:
        """Its reflection in the person's sagittal plane."""
        x, y, z = self.centre
        return Box((-x, y, z), self.size, self.colour)


def side_table(x: float, y: float, height: float, width: float = 0.40) -> tuple[Box, ...]:
    """A small table on one leg, its top 40 cm deep, of that width in metres and at that height."""
    return (
        Box((x, y, height - 0.015), (width, 0.40, 0.03), WOOD),
        Box((x, y, 0.5 * height), (0.06, 0.06, height - 0.06), WOOD),
        Box((x, y, 0.015), (0.30, 0.30, 0.03), WOOD),
    )
