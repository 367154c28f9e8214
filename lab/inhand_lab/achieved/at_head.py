"""True times at the head: calls, takes of a camera, flute playing, wearing of glasses, reading."""

from __future__ import annotations

import numpy as np
from inhand_tracker.geometry.arrays import Array, Flags

from inhand_lab.achieved.spans import (
    bounds,
    frame_times,
    spans,
    true_mouth,
    world_from_head,
    world_from_object,
)
from inhand_lab.achieved.true_achievement import TrueAchievement
from inhand_lab.objects.flute import EMBOUCHURE, TUBE_RADIUS
from inhand_lab.people.solids import head_radii
from inhand_lab.world.simulation import Simulation

AT_EAR = 0.06
"""Distance of the phone's middle from the head's surface at the ear's height, metres."""
RAISED = 0.16
"""Distance of the camera's middle below that of the head, metres, between waiting and filming."""
AT_LIPS = 0.06
"""Distance of the mouth hole from the lips at which the flute is played, metres."""
ON_NOSE = 0.03
"""Distance of the bridge from the nose at which glasses are on, metres."""


def true_calls(simulation: Simulation) -> list[TrueAchievement]:
    """The times when the phone is at an ear."""
    head = world_from_head(simulation)
    phone = head.inverse().apply(world_from_object(simulation).translation)
    radii = head_radii(simulation.person)
    outside = np.linalg.norm(phone, axis=1) - 1.0 / np.linalg.norm(
        phone / np.linalg.norm(phone, axis=1, keepdims=True) / radii, axis=1
    )
    return _lasting(simulation, "call", outside < AT_EAR)


def true_filming(simulation: Simulation) -> list[TrueAchievement]:
    """The times when the camera is before the face, and where it points: ``azimuth_deg`` to the
    left of the direction in which the rig's camera looks, 0 to 360, and ``elevation_deg``."""
    camera = world_from_object(simulation)
    below = world_from_head(simulation).translation[:, 2] - camera.translation[:, 2]
    ahead = simulation.camera_from_world.inverse().rotation[:, 2]
    pointing = camera.rotation[:, :, 1]
    left = np.arctan2(pointing[:, 1], pointing[:, 0]) - np.arctan2(ahead[1], ahead[0])
    found = []
    for take in spans(simulation, below < RAISED, 0.2):
        start, end = bounds(simulation, take)
        azimuth = np.degrees(np.angle(np.mean(np.exp(1j * left[take])))) % 360.0
        elevation = float(np.degrees(np.arcsin(pointing[take, 2])).mean())
        amounts = {
            "duration_s": end - start,
            "azimuth_deg": float(azimuth),
            "elevation_deg": elevation,
        }
        found.append(TrueAchievement("filming", start, end, amounts))
    return found


def true_playing(simulation: Simulation) -> list[TrueAchievement]:
    """The times when the flute's mouth hole is at the lips."""
    hole = world_from_object(simulation).apply(np.array([0.0, EMBOUCHURE, TUBE_RADIUS]))
    away = np.linalg.norm(hole - true_mouth(simulation), axis=1)
    return _lasting(simulation, "playing", away < AT_LIPS)


def true_wearing(simulation: Simulation) -> list[TrueAchievement]:
    """The times when the glasses are on the nose, and when they came there and left it."""
    body = simulation.person.proportions
    bridge = np.array([0.0, body.head_half_depth + 0.012, 0.12 * body.head_half_height])
    nose = world_from_head(simulation).apply(bridge)
    away = np.linalg.norm(world_from_object(simulation).translation - nose, axis=1)
    worn = _lasting(simulation, "worn", away < ON_NOSE)
    put_on = [TrueAchievement("put_on", one.start_s, one.start_s) for one in worn]
    taken_off = [TrueAchievement("taken_off", one.end_s, one.end_s) for one in worn]
    return sorted([*worn, *put_on, *taken_off], key=lambda one: one.end_s)


def true_reading(simulation: Simulation) -> list[TrueAchievement]:
    """The time from when the glass is over the first line until it goes back.

    It is by the stages: the glass is there at the first ``focus``; ``return`` begins the way back.
    A performance that does not come that far has none.
    """
    times = frame_times(simulation)
    begin = next(stage.start for stage in simulation.stages if stage.name == "focus")
    end = next(stage.start for stage in simulation.stages if stage.name == "return")
    return _lasting(simulation, "reading", (times >= begin) & (times < end))


def _lasting(simulation: Simulation, kind: str, so: Flags | Array) -> list[TrueAchievement]:
    """What lasts while ``so`` (T,) holds, with its durations."""
    found = []
    for span in spans(simulation, np.asarray(so, bool), 0.2):
        start, end = bounds(simulation, span)
        found.append(TrueAchievement(kind, start, end, {"duration_s": end - start}))
    return found
