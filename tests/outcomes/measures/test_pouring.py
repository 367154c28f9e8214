"""Pours from a jug that is tilted towards its spout, or aside."""

import numpy as np
import pytest
from cups import MUG
from inhand_outcomes.achievement import Achievement
from inhand_outcomes.measures.pouring import pour_volumes, pouring
from inhand_outcomes.measures.vessels import inside_of
from inhand_outcomes.thing import Thing
from scipy.spatial.transform import Rotation
from standing_person import frame_times, going, track_of, turns

JUG = Thing("jug", "pouring", MUG.vertices, MUG.faces, {"spout": np.array([0.0, 0.044, 0.1])})


def poured(
    tilts: list[tuple[float, float]], aside_deg: float = 0.0, speed_m_s: float = 0.0
) -> list[Achievement]:
    """What is found in tilts (time, degrees) towards the spout, turned aside from it, carried."""
    times = frame_times(10.0)
    tilted = turns("x", -going(times, *tilts))
    turned = tilted * Rotation.from_euler("z", aside_deg, degrees=True)
    places = np.array([0.0, 0.4, 1.1]) + np.outer(times, [speed_m_s, 0.0, 0.0])
    return pour_volumes(pouring(track_of(times, places, turned), JUG), [])


def test_a_pour_has_its_angle_duration_and_volume() -> None:
    first = [(1.0, 0.0), (2.0, 44.0), (3.0, 44.0), (4.0, 0.0)]
    found = poured([*first, (5.0, 0.0), (6.0, 55.0), (7.5, 55.0), (8.5, 0.0)])
    assert [one.kind for one in found] == ["pour", "pour"]
    assert all(one.probability > 0.9 for one in found)
    angles, durations = (
        [one.amounts[name].value for one in found] for name in ("angle_deg", "duration_s")
    )
    assert angles == pytest.approx([44.0, 55.0], abs=1.5)
    # It is tilted by more than 22 degrees for its stay and half, or three fifths, of both ways.
    assert durations == pytest.approx([2.0, 2.7], abs=0.2)
    inside = inside_of(JUG)
    assert inside is not None
    left = [inside.holds(np.radians(angle)) for angle in (44.0, 55.0)]
    assert found[0].amounts["volume_ml"].value == 20.0
    assert found[1].amounts["volume_ml"].value == pytest.approx(left[0] - left[1], rel=0.15)


def test_a_jug_that_is_carried_aslant_or_tilted_aside_or_swung_pours_nothing() -> None:
    assert poured([(1.0, 0.0), (2.0, 18.0), (8.0, 18.0), (9.0, 0.0)]) == []
    assert poured([(1.0, 0.0), (2.0, 50.0), (8.0, 50.0), (9.0, 0.0)], aside_deg=90.0) == []
    assert poured([(1.0, 0.0), (2.0, 50.0), (8.0, 50.0), (9.0, 0.0)], speed_m_s=0.8) == []
