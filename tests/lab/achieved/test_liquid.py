"""Liquid in simulated vessels: how much they hold, and what leaves them."""

import numpy as np
import pytest
from inhand_lab.achieved.liquid import emptied_ml, true_inside
from inhand_lab.objects.mug import MUG_BOTTOM, MUG_HEIGHT, MUG_RADIUS, MUG_WALL
from inhand_lab.world.simulation import simulate

RADIUS, DEPTH = MUG_RADIUS - MUG_WALL, MUG_HEIGHT - MUG_BOTTOM


def tilted(degrees: float, towards: tuple[float, float] = (0.0, 1.0)) -> np.ndarray:
    """Up, in the frame of a vessel that is tilted towards its x, y."""
    angle = np.radians(degrees)
    return np.array([*(-np.sin(angle) * np.array(towards)), np.cos(angle)])


def test_the_mug_holds_what_formulas_of_a_cylinder_say() -> None:
    mug = true_inside("mug")
    volume_ml = np.pi * RADIUS**2 * DEPTH * 1e6
    assert mug.held_ml(tilted(0.0)) == pytest.approx(volume_ml, rel=0.01)
    to_edge = float(np.degrees(np.arctan(DEPTH / (2.0 * RADIUS))))
    assert mug.held_ml(tilted(to_edge)) == pytest.approx(volume_ml / 2.0, rel=0.02)
    to_middle = float(np.degrees(np.arctan(DEPTH / RADIUS)))
    hoof_ml = 2.0 / 3.0 * RADIUS**2 * DEPTH * 1e6
    assert mug.held_ml(tilted(to_middle)) == pytest.approx(hoof_ml, rel=0.03)
    assert mug.held_ml(tilted(91.0)) < 1.0


def test_the_jug_pours_over_its_spout_which_lies_further_out_than_its_rim() -> None:
    jug = true_inside("jug")
    assert jug.held_ml(tilted(55.0)) < 0.97 * jug.held_ml(tilted(55.0, (1.0, 0.0)))
    holds = [jug.held_ml(tilted(angle)) for angle in range(0, 100, 10)]
    assert np.all(np.diff(holds) <= 0.0)


def test_a_use_takes_what_the_vessel_no_longer_holds_and_none_if_tilted_less() -> None:
    simulation = simulate("drinkFromMug", 0, 6000)
    axis = simulation.camera_from_object.rotation[:, :, 2]
    cosines = axis @ simulation.camera_from_world.rotation[:, 2]
    deep, shallow = int(np.argmin(cosines)), 0
    held = true_inside("mug").held_ml
    full, least = held(tilted(0.0)), held(tilted(float(np.degrees(np.arccos(cosines[deep])))))
    uses = [slice(shallow, shallow + 1), slice(deep, deep + 1), slice(shallow, shallow + 1)]
    first, second, third = emptied_ml(simulation, uses, usual_ml=20.0, deviation_ml=8.0)
    assert 0.0 <= first <= full - held(tilted(float(np.degrees(np.arccos(cosines[0])))))
    assert second == pytest.approx(held(tilted(0.0)) - least, rel=0.03)
    assert third == 0.0
    assert emptied_ml(simulation, uses[1:2], 20.0, 8.0) == emptied_ml(
        simulation, uses[1:2], 20.0, 8.0
    )
