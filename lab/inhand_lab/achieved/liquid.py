"""Liquid in simulated vessels, at rest at every moment.

A vessel's inside is the turned outline from which its mesh is made, drawn out to a spout where it
has one; the mesh has 40 flat sides, which hold 0.4 % less. What is in it is level; when the vessel
tilts, what would stand above the lowest way out has left.

How much is in a vessel is this: before its first use it is filled such that what reaches the lip at
that use's deepest tilt is all but one usual amount, a random number of a stream of its own
(``fill``). The first use so takes a usual amount, about which nothing in the picture tells; each
later one takes what the vessel can no longer hold at its deepest tilt, and none if it is tilted
less than before. Nobody refills.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.objects.jug import JUG_INSIDE, with_spout
from inhand_lab.objects.mug import MUG_BOTTOM, MUG_HEIGHT, MUG_RADIUS, MUG_WALL
from inhand_lab.world.random_streams import random_stream
from inhand_lab.world.simulation import Simulation

ML_PER_M3 = 1e6
RINGS, AROUND, LAYERS = 24, 96, 96
"""Number of pieces of an inside along its radius, around it and along its height."""

Drawn = Callable[[Array], Array]


@dataclass(frozen=True)
class TrueInside:
    """Pieces of a vessel's inside: their middles (N, 3) and volumes (N,), and its wall (A, K, 3)
    from its narrowest place up to the lip, for A directions; metres in the object's frame."""

    middles: Array
    volumes: Array
    wall: Array

    def held_ml(self, up: Array) -> float:
        """What it can hold when ``up`` (3,) of its own frame is up, millilitres."""
        lip = float(np.min(np.max(self.wall @ up, axis=1)))
        return float(self.volumes[self.middles @ up <= lip].sum()) * ML_PER_M3


@cache
def true_inside(name: str) -> TrueInside:
    """The inside of the mug or the jug; raises KeyError for what is no vessel."""
    return {"mug": _mug_inside, "jug": _jug_inside}[name]()


def emptied_ml(
    simulation: Simulation, uses: Sequence[slice], usual_ml: float, deviation_ml: float
) -> list[float]:
    """What left the vessel in each use, runs of frames in order of time, millilitres.

    The first use's amount has a log-normal distribution of that mean and deviation.
    """
    inside = true_inside(simulation.object_model.name)
    ups = (
        simulation.camera_from_object.rotation.transpose(0, 2, 1)
        @ (simulation.camera_from_world.rotation[:, 2])
    )
    random = random_stream(
        simulation.seed,
        simulation.participant,
        simulation.interaction,
        "fill",
        simulation.performance,
    )
    spread = np.sqrt(np.log1p((deviation_ml / usual_ml) ** 2))
    first = float(np.exp(np.log(usual_ml) - 0.5 * spread**2 + spread * random.normal()))
    full = inside.held_ml(np.array([0.0, 0.0, 1.0]))
    holds = [min(inside.held_ml(up) for up in ups[use]) for use in uses]
    content = min(holds[0] + first, full) if holds else full
    amounts = []
    for hold in holds:
        amounts.append(max(content - hold, 0.0))
        content = min(content, hold)
    return amounts


def _turned_inside(outline: Sequence[tuple[float, float]], drawn: Drawn) -> TrueInside:
    """The inside of an outline of radii and heights, metres, and how its points are drawn out."""
    radii, heights = np.array(sorted(outline, key=lambda point: point[1])).T
    shares = (np.arange(RINGS) + 0.5) / RINGS
    angles = (np.arange(AROUND) + 0.5) * 2.0 * np.pi / AROUND
    step = float(np.ptp(heights)) / LAYERS
    z = heights[0] + step * (np.arange(LAYERS) + 0.5)
    share, angle, height = (grid.ravel() for grid in np.meshgrid(shares, angles, z, indexing="ij"))
    reach = np.interp(height, heights, radii)
    radius = share * reach
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle), height], axis=1)
    volumes = radius * (reach / RINGS) * (2.0 * np.pi / AROUND) * step
    tiny = 1e-5
    sides = [(drawn(points + tiny * axis) - drawn(points)) / tiny for axis in np.eye(3)]
    stretched = np.abs(np.linalg.det(np.stack(sides, axis=1)))
    above = np.linspace(heights[int(np.argmin(radii[1:])) + 1], heights[-1], 40)
    wall = np.interp(above, heights, radii)
    around = np.arange(2 * AROUND) * np.pi / AROUND
    ring = np.stack([np.cos(around), np.sin(around)], axis=1)
    sheet = np.concatenate(
        [ring[:, None] * wall[:, None], np.broadcast_to(above[:, None], (2 * AROUND, 40, 1))],
        axis=2,
    )
    lined = drawn(sheet.reshape(-1, 3)).reshape(sheet.shape)
    return TrueInside(drawn(points), volumes * stretched, lined)


def _mug_inside() -> TrueInside:
    radius, half = MUG_RADIUS - MUG_WALL, MUG_HEIGHT / 2.0
    return _turned_inside([(radius, -half + MUG_BOTTOM), (radius, half)], lambda points: points)


def _jug_inside() -> TrueInside:
    return _turned_inside(JUG_INSIDE, with_spout)
