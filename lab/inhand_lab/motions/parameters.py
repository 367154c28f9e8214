"""What differs from performance to performance of varied people.

Where no source is named, a number is assumed; tests/lab/world/test_world_physics.py holds that
bodies and things keep their laws with these.
"""

from __future__ import annotations

from dataclasses import dataclass

Range = tuple[float, float]
"""Least and largest value of a uniform distribution."""


@dataclass(frozen=True)
class PerformanceVariety:
    """How performances differ, also those of one person."""

    places: float = 1.4
    """Factor on the spread of where furniture and things stand."""
    heights: float = 1.4
    """Factor on the spread of the heights of tables."""
    interruptions: float = 1.0
    """Mean number of times that somebody stops in a movement in a performance."""
    undone: float = 0.4
    """Share of these in which what was begun is then undone and begun again."""
    interrupted_after_s: Range = (0.25, 0.6)
    """Time after which a movement is interrupted, seconds."""
    stop_s: Range = (0.2, 1.2)
    """Time for which somebody stops, seconds."""
    slowing_s: float = 0.25
    """Time that stopping and going on again take each, seconds."""
    unfinished: float = 0.12
    """Share of performances in which a thing is taken, hardly used and put back."""
    given_up_after: Range = (0.35, 0.5)
    """Share of the time after which somebody gives up, if nothing swift has begun until then."""
    seated: float = 0.3
    """Share of what can be done on a stool that is done on one."""
    seat_drop: float = 0.12
    """Height by which hips and tables are lower for who sits, in statures: that of a bar stool."""
    feet_ahead: float = 0.12
    """Distance of a sitting person's feet ahead of the hips, in statures."""
    gestures: float = 1.0
    """Mean number of gestures of an idle hand while the other uses a thing, in a performance."""
    between_gestures_s: Range = (0.5, 6.0)
    """Time for which it hangs before each, seconds."""
    gesture_s: Range = (0.8, 3.0)
    """Time for which a gesture lasts, seconds."""
    gesture_way_s: float = 0.8
    """Time that a hand takes to a gesture and back, seconds."""


DEFAULT_VARIETY = PerformanceVariety()
"""How all performances of varied people differ."""
